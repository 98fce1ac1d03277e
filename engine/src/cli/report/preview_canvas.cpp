#include "report/preview_canvas.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "gravure/formats/png_writer.hpp"

namespace gravure::cli {

struct Canvas::Colour {
  std::array<std::uint8_t, 3> samples;

  /// Between stops, evenly spaced from 0 to 1.
  template <std::size_t N>
  static Colour between(const std::array<Colour, N>& stops, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(N - 1);
    const std::size_t i = std::min(N - 2, static_cast<std::size_t>(at));
    Colour colour = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = stops[i].samples[k];
      const double way = stops[i + 1].samples[k] - low;
      colour.samples[k] = static_cast<std::uint8_t>(std::lround(low + way * (at - static_cast<double>(i))));
    }
    return colour;
  }
  static Colour paper() { return {{255, 255, 255}}; }
  static Colour ground() { return {{236, 236, 232}}; }
  static Colour seam() { return {{212, 53, 43}}; }
  static Colour of(double share, Ramp ramp) {
    static constexpr std::array<Colour, 7> kDepth = {{{{244, 240, 228}},
                                                      {{214, 216, 190}},
                                                      {{150, 190, 172}},
                                                      {{78, 149, 152}},
                                                      {{36, 101, 126}},
                                                      {{20, 56, 92}},
                                                      {{12, 24, 52}}}};
    static constexpr std::array<Colour, 2> kFired = {{{{246, 245, 240}}, {{26, 32, 38}}}};
    if (share < 0) {
      return ground();
    }
    return ramp == Ramp::depth ? between(kDepth, share) : between(kFired, share);
  }
};

Json place_json(const PicturePart& part) {
  return {{"left", 0}, {"top", part.top}, {"width", part.size.width}, {"height", part.size.height}};
}

report::Extent size_in_frame(const report::Extent& values, double aspect, std::int64_t width, std::int64_t most_rows) {
  const double height = static_cast<double>(values.height) / static_cast<double>(values.width) * aspect;
  const double rows = height * static_cast<double>(width);
  const auto pixels = [](double wanted) { return std::max<std::int64_t>(1, std::llround(wanted)); };
  if (rows <= static_cast<double>(most_rows)) {
    return {width, pixels(rows)};
  }
  return {pixels(static_cast<double>(most_rows) / height), most_rows};  // long strips keep their shape and lose width
}

Result<void> check_png_name(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix != ".png") {
    return Error{ErrorCode::bad_argument, "-o " + path + ": pictures are written as PNG: use a name that ends in .png"};
  }
  return {};
}

Canvas::Canvas(const report::Extent& size) : size_(size) {
  pixels_.reserve(static_cast<std::size_t>(3 * size.area()));
  for (std::int64_t i = 0; i < size.area(); ++i) {
    for (const std::uint8_t sample : Colour::paper().samples) {
      pixels_.push_back(static_cast<std::byte>(sample));
    }
  }
}

void Canvas::put(std::int64_t x, std::int64_t y, const Colour& colour) {
  for (std::size_t k = 0; k < 3; ++k) {
    pixels_[static_cast<std::size_t>(3 * (y * size_.width + x)) + k] = static_cast<std::byte>(colour.samples[k]);
  }
}

void Canvas::draw(const PicturePart& part, Ramp ramp) {
  for (std::int64_t y = 0; y < part.size.height; ++y) {
    for (std::int64_t x = 0; x < part.size.width; ++x) {
      const std::int64_t value =
          y * part.values.height / part.size.height * part.values.width + x * part.values.width / part.size.width;
      put(x, part.top + y, Colour::of(part.shares[static_cast<std::size_t>(value)], ramp));
    }
  }
}

void Canvas::draw_seam(const PicturePart& part, bool across) {
  const std::int64_t length = across ? part.size.width : part.size.height;
  for (std::int64_t i = 0; i < length; ++i) {
    if (i / 8 % 2 == 0) {
      across ? put(i, part.top + part.size.height / 2, Colour::seam())
             : put(part.size.width / 2, part.top + i, Colour::seam());
    }
  }
}

Result<std::string> Canvas::png() const {
  return encode_png({size_.width, size_.height, 3, pixels_});
}

}  // namespace gravure::cli
