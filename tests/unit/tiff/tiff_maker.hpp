#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/image_source.hpp"

namespace gravure::test {

/// TIFF's numbers for the codecs tested.
inline constexpr std::uint16_t kNone = 1;
inline constexpr std::uint16_t kG3 = 3;
inline constexpr std::uint16_t kG4 = 4;
inline constexpr std::uint16_t kLzw = 5;
inline constexpr std::uint16_t kDeflate = 8;
inline constexpr std::uint16_t kOldDeflate = 32946;
inline constexpr std::uint16_t kPackBits = 32773;
inline constexpr std::uint16_t kZstd = 50000;

/// Packed rows, MSB first; bits beyond the width are 0.
struct Bits {
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::vector<std::byte> bytes;

  std::int64_t row_size() const { return (width + 7) / 8; }
  bool operator==(const Bits&) const = default;
};

/// Long runs, short runs and noise, so that every codec has something to do.
Bits pattern(std::int64_t width, std::int64_t height, std::uint32_t seed = 1);
/// Clears the bits beyond the width, which readers leave undefined.
Bits without_padding(Bits bits);

/// What to write with libtiff itself, tag by tag.
struct TiffSpec {
  std::uint16_t compression = kNone;
  std::uint16_t photometric = 1;  // MinIsBlack
  std::uint16_t fill_order = 1;   // MSB first
  std::uint16_t orientation = 1;
  std::uint32_t group3_options = 0;
  std::uint32_t rows_per_block = 16;
  std::uint32_t tile_width = 0;  // 0: strips
  bool strips_swapped = false;   // 0 2 1 3 5 4 6 8 7 ... in the file
  std::string mode = "w";        // "w8" BigTIFF, "wb" big endian
  double x_dots = 0;             // 0: no resolution
  double y_dots = 0;
  std::uint16_t unit = 2;  // inch
};

/// "none", "lzw", ...
std::string codec_name(std::uint16_t compression);
/// Writes the pages; dies on failure (a test's own bug).
void write_tiff(const std::string& path, const std::vector<Bits>& pages, const TiffSpec& spec);

/// A classic little-endian TIFF put together by hand, directory first: what no library would write.
struct RawTag {
  std::uint16_t tag;
  std::uint16_t type;  // 3 short, 4 long
  std::uint32_t count;
  std::uint32_t value;
};
/// `next` is the offset of the following directory. The directory begins at byte 8; the data follow it at
/// raw_data_offset(tags.size()).
std::string raw_tiff(const std::vector<RawTag>& tags, const std::string& data, std::uint32_t next = 0);
std::uint32_t raw_data_offset(std::size_t tag_count);
/// The tags of a bilevel page in one uncompressed strip that begins at `offset`.
std::vector<RawTag> bilevel_tags(std::uint32_t width, std::uint32_t height, std::uint32_t offset, std::uint32_t bytes);

/// Reads all rows in one call.
Result<Bits> read_all(ImageSource& source);

}  // namespace gravure::test
