#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"
#include "gravure/formats/image_kind.hpp"
#include "gravure/formats/tiff.hpp"

namespace gravure::oiio {

/// Limits of what goes through OpenImageIO, checked before it sees the file.
inline constexpr std::int64_t kMaxRowBytes = std::int64_t{64} << 20;
inline constexpr std::int64_t kMaxBlockBytes = std::int64_t{64} << 20;  ///< a row of tiles
inline constexpr std::int64_t kMaxStripBytes = std::int64_t{16} << 20;  ///< a strip that is decoded in one go
inline constexpr std::int64_t kLibraryBytes = std::int64_t{1} << 20;    ///< an open file: handles, codec state
inline constexpr std::int64_t kMaxPngSide = 1'000'000;                  ///< libpng's own
inline constexpr std::int64_t kMaxExrWidth = std::int64_t{1} << 18;     ///< OpenEXR decodes up to 256 rows at once

/// What the file itself says of one page, read and checked by our own small parsers: some of the libraries behind
/// OpenImageIO allocate what a header claims before they look whether the file can hold it, some print.
struct HeaderFacts {
  std::int64_t width = 0;
  std::int64_t height = 0;
  int bits = 0;                     ///< a sample, as stored: 1, 8, 16 or 32
  std::int64_t rows_per_block = 1;  ///< strip or tile height
  bool tiled = false;
  bool stored_in_strips = false;  ///< small ones (TIFF): each is decoded whole
  bool random_access = true;
  std::int64_t decoder_bytes = 0;  ///< OpenImageIO and the library behind it hold so much at most
  bool three_channels = false;     ///< bilevel BMP: OpenImageIO makes R = G = B of it
  std::optional<double> x_dots_per_mm;
  std::optional<double> y_dots_per_mm;
};

/// A file read from its start, never further than it reaches.
class HeaderFile {
 public:
  explicit HeaderFile(const std::string& path);
  const std::string& path() const { return path_; }
  std::int64_t size() const { return size_; }
  /// `count` bytes at `offset`; shorter where the file ends.
  std::string bytes(std::int64_t offset, std::int64_t count);

 private:
  std::string path_;
  std::ifstream file_;
  std::int64_t size_ = 0;
};

/// Unsigned number of bytes[at .. at + count), 0 beyond the end.
std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t count);
std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t count);

Error bad_file(const std::string& path, const std::string& what);
/// bad_file: "... ; save it as grey or 1 bit".
Error not_one_channel(const std::string& path, const std::string& what);
/// Width and height of 1 or more, a row of `bits` samples within kMaxRowBytes.
Result<void> check_size(const std::string& path, std::int64_t width, std::int64_t height, int bits);

Result<HeaderFacts> read_png_header(const std::string& path);
Result<HeaderFacts> read_bmp_header(const std::string& path);
/// Checks every part; the facts of a page come from OpenImageIO afterwards.
Result<void> check_exr_header(const std::string& path);
Result<HeaderFacts> read_tiff_header(const BilevelTiffOpener& tiff, const std::string& path, std::int64_t page);

}  // namespace gravure::oiio
