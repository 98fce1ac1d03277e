#include "report/preview_canvas.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

#include "gravure/formats/png_writer.hpp"
#include "text_output.hpp"

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

std::function<double(std::int64_t, std::int64_t)> shares_of_rows(std::vector<double> shares, std::int64_t width) {
  return [shares = std::move(shares), width](std::int64_t column, std::int64_t row) {
    return shares[static_cast<std::size_t>(row * width + column)];
  };
}

void Canvas::put(std::span<std::byte> row, std::int64_t x, const Colour& colour) {
  for (std::size_t k = 0; k < 3; ++k) {
    row[static_cast<std::size_t>(3 * x) + k] = static_cast<std::byte>(colour.samples[k]);
  }
}

void Canvas::draw_row(const Drawn& drawn, std::int64_t y, std::span<std::byte> row) {
  const PicturePart& part = drawn.part;
  const std::int64_t value_row = y * part.values.height / part.size.height;
  std::int64_t shown = -1;
  Colour colour = Colour::paper();
  for (std::int64_t x = 0; x < part.size.width; ++x) {
    const std::int64_t column = x * part.values.width / part.size.width;
    if (column != shown) {
      colour = Colour::of(part.share(column, value_row), drawn.ramp);
      shown = column;
    }
    put(row, x, colour);
  }
}

void Canvas::draw_seam(const Drawn& drawn, std::int64_t y, std::span<std::byte> row) {
  constexpr std::int64_t kDash = 8;
  const report::Extent& size = drawn.part.size;
  if (*drawn.seam_across && y == size.height / 2) {
    for (std::int64_t x = 0; x < size.width; ++x) {
      if (x / kDash % 2 == 0) {
        put(row, x, Colour::seam());
      }
    }
  } else if (!*drawn.seam_across && y / kDash % 2 == 0) {
    put(row, size.width / 2, Colour::seam());
  }
}

Result<void> Canvas::write(const std::string& path) const {
  GRAVURE_TRY(TextOutput output, TextOutput::create(path));
  const PngRows rows = [this](std::int64_t y, std::span<std::byte> row) -> Result<void> {
    GRAVURE_CHECK(check_not_stopped());
    for (std::int64_t x = 0; x < size_.width; ++x) {
      put(row, x, Colour::paper());
    }
    for (const Drawn& drawn : parts_) {
      if (const std::int64_t within = y - drawn.part.top; within >= 0 && within < drawn.part.size.height) {
        draw_row(drawn, within, row);
        if (drawn.seam_across) {
          draw_seam(drawn, within, row);
        }
      }
    }
    return {};
  };
  const PngBytes bytes = [&output](std::span<const std::byte> piece) {
    output.text().append(reinterpret_cast<const char*>(piece.data()), piece.size());
    return output.flush(false);
  };
  const Result<void> written = write_png({size_.width, size_.height, 3, {}}, rows, bytes);
  if (!written && output.flush(true)) {  // not for the disk, which is told below
    return written.error();
  }
  std::vector<TextOutput> files;
  files.push_back(std::move(output));
  return commit_together(std::move(files));
}

}  // namespace gravure::cli
