#include "gravure/core/exposure_map.hpp"

#include <algorithm>

namespace gravure {
namespace {

__extension__ using Wide = __int128;

constexpr std::int64_t kMostPart = std::int64_t{1} << 62;

}  // namespace

HelicalWindow helical_window(const Plan& plan, std::int64_t revolution, std::int64_t line) {
  const CarriagePlan& carriage = *plan.carriage;
  const Integer steps = (Integer(revolution) - carriage.layers) * plan.rotary.lines_per_revolution + line;
  const Rational at = carriage.feed_pixels * ratio(steps, plan.rotary.lines_per_revolution);
  const Integer first = floor_of(at);
  return {static_cast<std::int64_t>(first), at - Rational(first)};
}

bool ExposureMap::fits(const Rational& feed_pixels, std::int64_t lines) {
  const Rational step = feed_pixels / Rational(lines);
  return numerator_of(step) <= kMostPart && denominator_of(step) <= kMostPart;
}

ExposureMap::ExposureMap(const Plan& plan)
    : lines_(plan.rotary.lines_per_revolution),
      columns_(image_columns(plan)),
      pixels_(plan.line.pixels),
      revolutions_per_band_(revolutions_per_band(plan)),
      to_and_fro_(plan.mode == Mode::flat),
      whole_images_(plan.mode == Mode::rotary && !plan.bands) {
  if (plan.carriage) {
    const Rational step = plan.carriage->feed_pixels / Rational(lines_);
    num_ = static_cast<std::int64_t>(numerator_of(step));
    den_ = static_cast<std::int64_t>(denominator_of(step));
    layers_ = plan.carriage->layers;
    helical_ = true;
  }
}

std::int64_t ExposureMap::column_after(std::int64_t steps) const noexcept {
  std::int64_t near = 0;
  if (!__builtin_mul_overflow(num_, steps, &near)) {  // nearly always, and several times faster
    const std::int64_t whole = near / den_;
    return near % den_ < 0 ? whole - 1 : whole;
  }
  const Wide product = static_cast<Wide>(num_) * steps;
  const Wide whole = product / den_;
  return static_cast<std::int64_t>(product % den_ < 0 ? whole - 1 : whole);
}

bool ExposureMap::runs_backwards(std::int64_t revolution) const noexcept {
  return to_and_fro_ && (revolution & 1) != 0;
}

std::int64_t ExposureMap::image_line(std::int64_t revolution, std::int64_t line) const noexcept {
  return runs_backwards(revolution) ? lines_ - 1 - line : line;
}

Stretch ExposureMap::stretch(std::int64_t revolution, std::int64_t line, std::int64_t index) const noexcept {
  Stretch stretch;
  std::int64_t end = 0;
  if (helical_) {
    const std::int64_t window = (revolution - layers_) * lines_ + line;
    const std::int64_t start = window + index * lines_;
    stretch.layer = layers_ - 1 - index;
    stretch.first_column = column_after(start);
    stretch.first_pixel = stretch.first_column - column_after(window);
    end = column_after(start + lines_);
  } else {
    stretch.first_column = revolution / revolutions_per_band_ * pixels_;
    end = stretch.first_column + pixels_;
  }
  const std::int64_t before = std::max<std::int64_t>(0, -stretch.first_column);
  stretch.first_pixel += before;
  stretch.first_column += before;
  stretch.columns = std::max<std::int64_t>(0, std::min(end, columns_) - stretch.first_column);
  return stretch;
}

}  // namespace gravure
