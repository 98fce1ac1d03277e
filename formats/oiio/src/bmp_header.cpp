#include <cstdlib>

#include "header_facts.hpp"

namespace gravure::oiio {
namespace {

constexpr std::size_t kFileHeader = 14;
constexpr std::uint32_t kBlack = 0x000000;
constexpr std::uint32_t kWhite = 0xFFFFFF;

/// Dots a metre, 0 or less where nobody knows.
std::optional<double> dots_per_mm(std::string_view head, std::size_t at) {
  const auto dots_per_m = static_cast<std::int32_t>(little_endian(head, at, 4));
  return dots_per_m > 0 ? std::optional<double>(dots_per_m / 1000.0) : std::nullopt;
}

/// A bilevel BMP always has a palette; black and white in either order is what bilevel means.
Result<void> check_bilevel_palette(HeaderFile& file, std::int64_t header_bytes) {
  const std::string palette = file.bytes(static_cast<std::int64_t>(kFileHeader) + header_bytes, 8);
  const std::uint32_t zero = little_endian(palette, 0, 3);
  const std::uint32_t one = little_endian(palette, 4, 3);
  if (palette.size() < 8 || !((zero == kBlack && one == kWhite) || (zero == kWhite && one == kBlack))) {
    return not_one_channel(file.path(), "has a palette of other than black and white");
  }
  return {};
}

}  // namespace

Result<HeaderFacts> read_bmp_header(const std::string& path) {
  HeaderFile file(path);
  const std::string head = file.bytes(0, 54);
  const std::int64_t header_bytes = little_endian(head, kFileHeader, 4);
  if (head.size() < 54 || header_bytes < 40 || header_bytes > 124) {
    return bad_file(path,
                    "no BMP header of 40 to 124 bytes: the file is truncated or of an old OS/2 kind; export it again");
  }
  const std::int64_t height = static_cast<std::int32_t>(little_endian(head, 22, 4));
  HeaderFacts facts;
  facts.width = static_cast<std::int32_t>(little_endian(head, 18, 4));
  facts.height = std::abs(height);  // negative: top row first
  facts.bits = static_cast<int>(little_endian(head, 28, 2));
  if (facts.bits != 1 && facts.bits != 8) {
    return facts.bits == 4 ? bad_file(path, "4 bits a pixel: BMP is read with 1 or 8; save it so")
                           : not_one_channel(path, std::to_string(facts.bits) + " bits a pixel (colour)");
  }
  if (const std::uint32_t compression = little_endian(head, 30, 4); compression != 0) {
    return bad_file(path, "is compressed (" + std::to_string(compression) +
                              "), which cannot be read row by row; save it without compression");
  }
  GRAVURE_CHECK(check_size(path, facts.width, facts.height, facts.bits));
  const std::int64_t stride = (facts.width * facts.bits + 31) / 32 * 4;
  const std::int64_t wanted = little_endian(head, 10, 4) + stride * facts.height;  // below 2^58
  if (wanted > file.size()) {
    return bad_file(path, "is " + std::to_string(facts.width) + " x " + std::to_string(facts.height) + " pixels, so " +
                              std::to_string(wanted) + " bytes, but has " + std::to_string(file.size()) +
                              ": the file is truncated; copy it again");
  }
  facts.decoder_bytes = kLibraryBytes + 8 * facts.width;  // a row of three channels, twice
  facts.x_dots_per_mm = dots_per_mm(head, 38);
  facts.y_dots_per_mm = dots_per_mm(head, 42);
  if (facts.bits == 1) {
    GRAVURE_CHECK(check_bilevel_palette(file, header_bytes));
    facts.three_channels = true;
  }
  return facts;
}

}  // namespace gravure::oiio
