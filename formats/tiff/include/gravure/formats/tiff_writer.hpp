#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "gravure/core/error.hpp"
#include "gravure/core/file_output.hpp"

namespace gravure {

enum class TiffCompression : std::uint8_t { none, packbits, lzw, deflate, g4, zstd };

/// One page to write, bilevel or of grey levels.
struct BilevelTiffPage {
  int bits = 1;                ///< of a pixel: 1, or 8, where 0 is black; not with G4
  std::int64_t width = 0;      ///< pixels, 1 .. 2^29, with 8 bits 2^26
  std::int64_t height = 0;     ///< rows, 1 .. 2^31 - 1
  bool zero_is_white = false;  ///< bit 0 means white (MinIsWhite)
  /// Deflate is small and quick for every picture; G4 is smaller for line art, but beyond raw size and slow for
  /// dithered pictures.
  TiffCompression compression = TiffCompression::deflate;
  std::optional<double> x_dots_per_mm;  ///< both or none
  std::optional<double> y_dots_per_mm;
};

/// Writes bilevel or grey TIFF row by row; the file appears whole at commit() or not at all. The same rows give the
/// same bytes.
class BilevelTiffWriter {
 public:
  /// Opens a temporary file beside `path` and begins the first page. Files that may pass 3.5 GB (`page_count` pages
  /// like the first, not compressed) become BigTIFF. Fails with out_of_range on sizes, io on the file system.
  static Result<BilevelTiffWriter> create(const std::string& path, const BilevelTiffPage& first_page,
                                          std::int64_t page_count = 1);
  BilevelTiffWriter(BilevelTiffWriter&&) noexcept;
  BilevelTiffWriter& operator=(BilevelTiffWriter&&) noexcept;
  ~BilevelTiffWriter();

  /// Adds packed rows, MSB first, (width + 7) / 8 bytes each; bits beyond the width are written as 0. With 8 bits a
  /// pixel rows are `width` bytes. Fails with
  /// bad_argument when `rows` is no whole number of rows or more than the page has left.
  Result<void> append_rows(std::span<const std::byte> rows);
  /// Ends the page, which must be complete, and begins the next one.
  Result<void> begin_page(const BilevelTiffPage& page);
  /// Ends the last page, which must be complete, and the file: on the disk, but not in its place yet.
  Result<FileOutput> finish();
  /// The same, and puts it in its place.
  Result<void> commit();

 private:
  class State;
  explicit BilevelTiffWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gravure
