#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "gravure/core/error.hpp"
#include "gravure/core/image_source.hpp"

namespace gravure {

/// Limits that hold for every TIFF page, checked before anything of its size is allocated.
inline constexpr std::int64_t kMaxTiffRowBytes = std::int64_t{64} << 20;    ///< one row
inline constexpr std::int64_t kMaxTiffBlockBytes = std::int64_t{64} << 20;  ///< a row of tiles
/// Compressed strips up to this size, stored and decoded, may be kept decoded; larger ones are only streamed.
inline constexpr std::int64_t kMaxTiffStripBytes = std::int64_t{16} << 20;
inline constexpr std::int64_t kMaxTiffPages = 1'000'000;

/// What the directory of one TIFF page says, once it was found to hold together.
struct TiffPageInfo {
  std::int64_t width = 0;   ///< pixels
  std::int64_t height = 0;  ///< rows
  int bits_per_sample = 1;
  int samples_per_pixel = 1;
  bool palette = false;
  bool zero_is_white = false;     ///< PhotometricInterpretation MinIsWhite
  int compression = 1;            ///< TIFF's number; 1: none
  bool lowest_bit_first = false;  ///< FillOrder 2
  bool tiled = false;
  std::int64_t rows_per_block = 1;       ///< strip or tile height
  std::int64_t blocks = 1;               ///< strips or tiles
  std::int64_t largest_block_bytes = 0;  ///< of a strip or tile as stored
  std::int64_t all_block_bytes = 0;      ///< of all of them
  std::optional<double> x_dots_per_mm;   ///< where the page has a resolution with a unit
  std::optional<double> y_dots_per_mm;

  bool bilevel() const { return bits_per_sample == 1 && samples_per_pixel == 1; }
  bool compressed() const { return compression != 1; }
  /// The most libtiff holds to decode one block: the block as stored, the codec's own state, the tables of places.
  std::int64_t codec_bytes() const;
};

/// Does the file begin as a TIFF or BigTIFF does? False too where it cannot be read.
bool is_tiff(const std::string& path);

/// Is this page one sample of one bit a pixel? Fails with bad_file as BilevelTiffOpener::open() does.
Result<bool> is_bilevel_tiff(const std::string& path, std::int64_t page);

class TiffPageOffsets;

/// Opens bilevel TIFF pages: strips or tiles, classic or BigTIFF, any number of pages, every codec of libtiff (none,
/// PackBits, LZW, Deflate, G3, G4, zstd). Bits stay packed all the way.
///
/// What is refused, always with bad_file naming path, page and (while reading) row: files that are missing, are no
/// TIFF, are truncated or damaged (libtiff's warnings while decoding count as damage: it fills what it cannot decode
/// with guesses), an orientation other than top-left, a page without polarity (PhotometricInterpretation), rows or rows
/// of tiles beyond the limits above. Nothing is printed. May be used from several threads at once.
///
/// Where the pages of a file lie is remembered, so that opening all pages of an n-page file costs n steps, not n^2.
class BilevelTiffOpener final : public ImageOpener {
 public:
  BilevelTiffOpener();
  ~BilevelTiffOpener() override;
  BilevelTiffOpener(const BilevelTiffOpener&) = delete;
  BilevelTiffOpener& operator=(const BilevelTiffOpener&) = delete;

  /// Pages of any TIFF, bilevel or not.
  Result<std::int64_t> count_pages(const std::string& path) const override;
  /// Uncompressed strips and tiles are read from their places. Compressed strips of up to kMaxTiffStripBytes are
  /// decoded in any order: whole, or where they leave the cache and the codec streams (PackBits, LZW, fax), row by row
  /// until somebody goes back. Larger ones are read row by row and then upwards only (random_access = false; starting
  /// again from row 0 is allowed). libtiff holds such a strip whole as it is stored: decoder_bytes says how much.
  Result<std::unique_ptr<ImageSource>> open(const std::string& path, std::int64_t page) const override;
  /// The header of any page, bilevel or not, checked: every strip or tile lies inside the file.
  Result<TiffPageInfo> read_page_info(const std::string& path, std::int64_t page) const;

 private:
  std::unique_ptr<TiffPageOffsets> offsets_;
};

}  // namespace gravure
