#include "chart/chart_picture.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "verb.hpp"

namespace gravure::cli {
namespace {

constexpr std::int64_t kDotsWide = 3;
constexpr std::int64_t kDotsHigh = 5;

/// Five rows of three dots, from the top.
std::string_view glyph(char c) {
  static constexpr std::array<std::string_view, 10> kDigits = {
      "####.##.##.####", ".#.##..#..#.###", "###..#####..###", "###..####..####", "#.##.####..#..#",
      "####..###..####", "####..####.####", "###..#.#..#..#.", "####.#####.####", "####.####..####"};
  if (c >= '0' && c <= '9') {
    return kDigits[static_cast<std::size_t>(c - '0')];
  }
  return c == '+' ? "....#.###.#...." : c == '-' ? "......###......" : "...............";
}

}  // namespace

std::int64_t ChartPicture::text_width(const std::string& text, std::int64_t scale) {
  return static_cast<std::int64_t>(text.size()) * (kDotsWide + 1) * scale - scale;
}

void ChartPicture::write(std::int64_t x, std::int64_t y, const std::string& text, std::int64_t scale,
                         std::int64_t step) {
  for (const char c : text) {
    const std::string_view dots = glyph(c);
    for (std::int64_t dot = 0; dot < kDotsWide * kDotsHigh; ++dot) {
      if (dots[static_cast<std::size_t>(dot)] == '#') {
        fill({x + dot % kDotsWide * scale, y + dot / kDotsWide * scale, scale, scale, step});
      }
    }
    x += (kDotsWide + 1) * scale;
  }
}

BilevelTiffPage ChartPicture::page() const {
  BilevelTiffPage page;
  page.width = width_;
  page.height = height_;
  return page;
}

void ChartPicture::draw(std::int64_t row, std::vector<std::byte>& bits) const {
  for (const ChartBox& box : boxes_) {
    const std::int64_t below = (row - box.y % height_ + 2 * height_) % height_;
    if (below >= box.height || below % box.step != 0) {
      continue;
    }
    for (std::int64_t x = std::max<std::int64_t>(box.x, 0); x < std::min(box.x + box.width, width_); ++x) {
      bits[static_cast<std::size_t>(x / 8)] |= static_cast<std::byte>(0x80U >> (x % 8));
    }
  }
}

Result<void> ChartPicture::append_to(BilevelTiffWriter& writer) const {
  std::vector<std::byte> bits(static_cast<std::size_t>((width_ + 7) / 8));
  for (std::int64_t row = 0; row < height_; ++row) {
    if (cancel_token().cancelled()) {
      return Error{ErrorCode::cancelled, "stopped; nothing was written"};
    }
    std::fill(bits.begin(), bits.end(), std::byte{0});
    draw(row, bits);
    GRAVURE_CHECK(writer.append_rows(bits));
  }
  return {};
}

}  // namespace gravure::cli
