#include "gravure/texture/height_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

namespace gravure::texture {
namespace {

constexpr std::int64_t kMostSamples = std::int64_t{64} << 20;  // 512 MB of coefficients

/// Weights of four B-spline coefficients at a place, and their slopes by the place.
struct Weights {
  std::array<double, 4> value{};
  std::array<double, 4> slope{};
};

/// At `t` of cell `cell` of `cells`. Beyond the ends the natural spline's coefficients go on straight: their weight is
/// given to the two outermost ones.
Weights weights_at(double t, std::int64_t cell, std::int64_t cells) {
  const double r = 1 - t;
  Weights w{{r * r * r / 6, (4 - 6 * t * t + 3 * t * t * t) / 6, (4 - 6 * r * r + 3 * r * r * r) / 6, t * t * t / 6},
            {-r * r / 2, (-4 * t + 3 * t * t) / 2, (4 * r - 3 * r * r) / 2, t * t / 2}};
  for (auto* each : {&w.value, &w.slope}) {
    std::array<double, 4>& of = *each;
    if (cell == 0) {
      of[1] += 2 * of[0];
      of[2] -= of[0];
      of[0] = 0;
    }
    if (cell == cells - 1) {
      of[2] += 2 * of[3];
      of[1] -= of[3];
      of[3] = 0;
    }
  }
  return w;
}

/// Heights to coefficients in place along one line of the grid: c[i-1] + 4 c[i] + c[i+1] = 6 h[i], ends free of
/// curvature. `factors` has room for a line.
void prefilter(double* line, std::int64_t count, std::int64_t stride, std::vector<double>& factors) {
  factors[0] = 0;
  for (std::int64_t i = 1; i + 1 < count; ++i) {
    const double pivot = 4 - factors[static_cast<std::size_t>(i - 1)];
    factors[static_cast<std::size_t>(i)] = 1 / pivot;
    line[i * stride] = (6 * line[i * stride] - line[(i - 1) * stride]) / pivot;
  }
  for (std::int64_t i = count - 2; i > 0; --i) {
    line[i * stride] -= factors[static_cast<std::size_t>(i)] * line[(i + 1) * stride];
  }
}

class HeightField final : public Surface {
 public:
  explicit HeightField(HeightGrid grid) : grid_(std::move(grid)) {
    std::vector<double> factors(static_cast<std::size_t>(std::max(grid_.columns, grid_.rows)));
    double* all = grid_.heights_mm.data();
    for (std::int64_t row = 0; row < grid_.rows; ++row) {
      prefilter(all + row * grid_.columns, grid_.columns, 1, factors);
    }
    for (std::int64_t column = 0; column < grid_.columns; ++column) {
      prefilter(all + column, grid_.rows, grid_.columns, factors);
    }
  }

  Result<void> project(std::span<const Vector2> plane_mm, std::span<SurfacePoint> out) const override {
    const double half_x_mm = static_cast<double>(grid_.columns - 1) * grid_.pitch_x_mm / 2;
    const double half_y_mm = static_cast<double>(grid_.rows - 1) * grid_.pitch_y_mm / 2;
    for (std::size_t i = 0; i < plane_mm.size(); ++i) {
      const double x = plane_mm[i].x();
      const double y = plane_mm[i].y();
      constexpr double kRounding_mm = 1e-9;
      if (!(std::abs(x) <= half_x_mm + kRounding_mm) || !(std::abs(y) <= half_y_mm + kRounding_mm)) {
        return Error{ErrorCode::out_of_range,
                     fmt::format("height field: nothing at x = {} mm, y = {} mm; it goes from {} to {} mm in x and "
                                 "from {} to {} mm in y: take a larger one, or a smaller texture",
                                 x, y, -half_x_mm, half_x_mm, -half_y_mm, half_y_mm)};
      }
      out[i] = at((x + half_x_mm) / grid_.pitch_x_mm, (half_y_mm - y) / grid_.pitch_y_mm, x, y);
    }
    return {};
  }

 private:
  SurfacePoint at(double column, double row, double x_mm, double y_mm) const {
    const auto cell = [](double place, std::int64_t count) {
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place)), 0, count - 2);
    };
    const std::int64_t i = cell(column, grid_.columns);
    const std::int64_t j = cell(row, grid_.rows);
    const Weights across = weights_at(column - static_cast<double>(i), i, grid_.columns - 1);
    const Weights down = weights_at(row - static_cast<double>(j), j, grid_.rows - 1);
    double z = 0;
    double slope_x = 0;
    double slope_y = 0;
    for (std::int64_t r = 0; r < 4; ++r) {
      const double* line =
          grid_.heights_mm.data() + std::clamp<std::int64_t>(j + r - 1, 0, grid_.rows - 1) * grid_.columns;
      double value = 0;
      double slope = 0;
      for (std::int64_t c = 0; c < 4; ++c) {
        const double coefficient = line[std::clamp<std::int64_t>(i + c - 1, 0, grid_.columns - 1)];
        value += across.value[static_cast<std::size_t>(c)] * coefficient;
        slope += across.slope[static_cast<std::size_t>(c)] * coefficient;
      }
      z += down.value[static_cast<std::size_t>(r)] * value;
      slope_x += down.value[static_cast<std::size_t>(r)] * slope;
      slope_y += down.slope[static_cast<std::size_t>(r)] * value;
    }
    return {Vector3(x_mm, y_mm, z),
            Vector3(-slope_x / grid_.pitch_x_mm, slope_y / grid_.pitch_y_mm, 1).normalized()};  // rows go down in y
  }

  HeightGrid grid_;  ///< its heights turned into coefficients
};

/// Samples in host byte order to heights; the place of the first that is not finite, or -1.
template <class Sample>
std::int64_t scale_samples(std::span<const std::byte> bytes, double full, const HeightScale& scale, double* out) {
  const auto count = static_cast<std::int64_t>(bytes.size() / sizeof(Sample));
  for (std::int64_t i = 0; i < count; ++i) {
    Sample sample;
    std::memcpy(&sample, bytes.data() + static_cast<std::size_t>(i) * sizeof(Sample), sizeof(Sample));
    out[i] = scale.low_mm + (scale.high_mm - scale.low_mm) * (static_cast<double>(sample) / full);
    if (!std::isfinite(out[i])) {
      return i;
    }
  }
  return -1;
}

}  // namespace

Result<HeightGrid> read_height_grid(ImageSource& picture, const HeightScale& scale) {
  const ImageInfo& info = picture.info();
  if (info.samples != SampleType::u16 && info.samples != SampleType::f32) {
    return Error{ErrorCode::bad_file, fmt::format("{}: has {} bits a sample; a height field has 16 bits or floats",
                                                  info.path, info.samples == SampleType::bit ? 1 : 8)};
  }
  if (info.width > kMostSamples / std::max<std::int64_t>(1, info.height)) {
    return Error{ErrorCode::out_of_range, fmt::format("{}: {} x {} samples, at most {} are taken", info.path,
                                                      info.width, info.height, kMostSamples)};
  }
  if (!std::isfinite(scale.low_mm) || !std::isfinite(scale.high_mm) || scale.low_mm == scale.high_mm) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("heights from {} to {} mm: must be two different figures", scale.low_mm, scale.high_mm)};
  }
  HeightGrid grid{info.width, info.height, scale.pitch_x_mm, scale.pitch_y_mm, {}};
  grid.heights_mm.resize(static_cast<std::size_t>(info.width * info.height));
  const std::int64_t bytes = row_bytes(info.samples, info.width);
  const std::int64_t band = std::clamp<std::int64_t>((std::int64_t{1} << 22) / bytes, 1, info.height);
  std::vector<std::byte> read(static_cast<std::size_t>(band * bytes));
  for (std::int64_t row = 0; row < info.height; row += band) {
    const std::int64_t now = std::min(band, info.height - row);
    const auto rows = std::span(read).first(static_cast<std::size_t>(now * bytes));
    GRAVURE_CHECK(picture.read_rows(row, now, rows));
    double* out = grid.heights_mm.data() + row * info.width;
    constexpr double kFull = 65535;
    const std::int64_t bad = info.samples == SampleType::u16 ? scale_samples<std::uint16_t>(rows, kFull, scale, out)
                                                             : scale_samples<float>(rows, 1, scale, out);
    if (bad >= 0) {
      return Error{ErrorCode::bad_file, fmt::format("{}: row {}, column {}: a height that is not finite", info.path,
                                                    row + bad / info.width, bad % info.width)};
    }
  }
  return grid;
}

Result<std::unique_ptr<Surface>> height_field_surface(HeightGrid grid) {
  if (grid.columns < 2 || grid.rows < 2 ||
      grid.heights_mm.size() != static_cast<std::size_t>(grid.columns * grid.rows)) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("height field of {} x {} heights: must be 2 x 2 or more", grid.columns, grid.rows)};
  }
  constexpr double kMostPitch_mm = 1e6;
  if (!(grid.pitch_x_mm > 0) || !(grid.pitch_y_mm > 0) || !(grid.pitch_x_mm < kMostPitch_mm) ||
      !(grid.pitch_y_mm < kMostPitch_mm)) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("height field: pixels of {} x {} mm: must be above 0 and below {}", grid.pitch_x_mm,
                             grid.pitch_y_mm, kMostPitch_mm)};
  }
  return std::unique_ptr<Surface>(std::make_unique<HeightField>(std::move(grid)));
}

}  // namespace gravure::texture
