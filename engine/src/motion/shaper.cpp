#include "gravure/motion/shaper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

constexpr std::size_t kMaxShapedModes = 4;

std::vector<ShaperImpulse> shaper_of(ShaperKind kind, const Mode& mode) {
  const ModeConstants m = constants_of(mode.f_hz, mode.zeta);
  const double half_period = kTwoPi / 2 / m.rad_per_s;
  const double k = std::exp(-m.decay_per_s * half_period);  // what a half period leaves of the vibration
  if (kind == ShaperKind::zv) {
    const double sum = 1 + k;
    return {{0, 1 / sum}, {half_period, k / sum}};
  }
  const double sum = (1 + k) * (1 + k);
  return {{0, 1 / sum}, {half_period, 2 * k / sum}, {2 * half_period, k * k / sum}};
}

}  // namespace

Result<std::vector<ShaperImpulse>> make_shaper(ShaperKind kind, std::span<const Mode> modes) {
  GRAVURE_CHECK(check_modes(modes));
  if (modes.size() > kMaxShapedModes) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("motion: make_shaper: {} modes: must be 1 to {}; shape the slowest", modes.size(),
                             kMaxShapedModes)};
  }
  std::vector<ShaperImpulse> shaper{{0, 1}};
  for (const Mode& mode : modes) {
    std::vector<ShaperImpulse> longer;
    for (const ShaperImpulse& a : shaper) {
      for (const ShaperImpulse& b : shaper_of(kind, mode)) {
        longer.push_back({a.time_s + b.time_s, a.size * b.size});
      }
    }
    shaper = std::move(longer);
  }
  std::stable_sort(shaper.begin(), shaper.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return shaper;
}

std::vector<InputJump> shape_input(std::span<const InputJump> input, std::span<const ShaperImpulse> shaper) {
  std::vector<InputJump> shaped;
  shaped.reserve(input.size() * shaper.size());
  for (const ShaperImpulse& impulse : shaper) {
    for (const InputJump& jump : input) {
      shaped.push_back({jump.time_s + impulse.time_s, impulse.size * jump.acceleration_jump_mm_s2,
                        impulse.size * jump.jerk_jump_mm_s3});
    }
  }
  std::stable_sort(shaped.begin(), shaped.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return shaped;
}

}  // namespace gravure::motion
