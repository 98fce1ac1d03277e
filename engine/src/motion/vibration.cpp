#include "gravure/motion/vibration.hpp"

#include <fmt/format.h>

#include <cmath>

#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

Error mode_error(std::size_t index, std::string_view field, double value, std::string_view allowed) {
  return Error{ErrorCode::out_of_range,
               fmt::format("motion: mode {}: {} = {}: must be {}", index + 1, field, value, allowed)};
}

void add_jump(std::vector<InputJump>& input, double time_s, double acceleration_jump, double jerk_jump) {
  if (acceleration_jump != 0 || jerk_jump != 0) {
    input.push_back({time_s, acceleration_jump, jerk_jump});
  }
}

struct InputNow {
  double acceleration = 0;
  double jerk = 0;
};

/// After the last jump a move stands still or runs on evenly; the sums would leave rounding there.
InputNow input_at(std::span<const InputJump> input, double time_s) noexcept {
  InputNow now;
  if (input.empty() || time_s >= input.back().time_s) {
    return now;
  }
  for (const InputJump& jump : input) {
    if (jump.time_s > time_s) {
      break;
    }
    now.acceleration += jump.acceleration_jump_mm_s2 + jump.jerk_jump_mm_s3 * (time_s - jump.time_s);
    now.jerk += jump.jerk_jump_mm_s3;
  }
  return now;
}

}  // namespace

Result<void> check_modes(std::span<const Mode> modes) {
  if (modes.empty() || modes.size() > kMaxModes) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("motion: {} modes given: must be 1 to {}", modes.size(), kMaxModes)};
  }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (!(modes[i].f_hz >= 1e-6 && modes[i].f_hz <= 1e9)) {
      return mode_error(i, "f_hz", modes[i].f_hz, "from 1e-6 to 1e9");
    }
    if (!(modes[i].zeta >= 0 && modes[i].zeta < 1)) {
      return mode_error(i, "zeta", modes[i].zeta, "at least 0 and below 1 (from 1 on nothing rings)");
    }
    if (!(std::abs(modes[i].participation) <= 1e9)) {
      return mode_error(i, "participation", modes[i].participation, "from -1e9 to 1e9");
    }
  }
  return {};
}

Result<std::vector<Mode>> chain_modes(std::span<const FrequencyAndDamping> modes) {
  std::vector<Mode> chain;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    double share = 1;
    for (std::size_t j = 0; j < modes.size(); ++j) {
      const double other = modes[j].f_hz;
      const double gap = other - modes[i].f_hz;
      if (j != i && std::abs(gap) < 1e-6 * other) {
        return mode_error(i, "f_hz", modes[i].f_hz,
                          "apart from the other frequencies: a chain has no two equal ones; give each mode its share");
      }
      share *= j == i ? 1 : other * other / (gap * (other + modes[i].f_hz));
    }
    chain.push_back({modes[i].f_hz, modes[i].zeta, share});
  }
  GRAVURE_CHECK(check_modes(chain));
  return chain;
}

std::vector<InputJump> input_of(const Profile& profile) {
  std::vector<InputJump> input;
  double acceleration = 0;  // at the end of the segment before
  double jerk = 0;
  for (std::size_t k = 0; k < 7; ++k) {
    // Segments of no duration have jerk 0, and their acceleration must not show.
    if (profile.durations_s[k] > 0) {
      const double from = k == 0 || k == 4 ? 0 : profile.acceleration_mm_s2[k];
      const bool step = profile.jerk_mm_s3[k] == 0 && jerk == 0;  // trapezoids jump; others meet but for rounding
      add_jump(input, profile.times_s[k], step ? from - acceleration : 0, profile.jerk_mm_s3[k] - jerk);
      jerk = profile.jerk_mm_s3[k];
      acceleration = from + jerk * profile.durations_s[k];
    }
  }
  add_jump(input, profile.times_s[7], jerk == 0 ? -acceleration : 0, -jerk);
  return input;
}

Result<std::vector<InputJump>> quantised_input_of(const Profile& profile, double update_us) {
  GRAVURE_TRY(const auto samples, sample_profile(profile, update_us));
  std::vector<InputJump> input;
  const double update_s = update_us * 1e-6;
  double acceleration = 0;
  double velocity = profile.at(0).velocity_mm_s;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const double next = samples[k + 1].state.velocity_mm_s;
    const double now = (next - velocity) / update_s;
    add_jump(input, samples[k].time_s, now - acceleration, 0);
    acceleration = now;
    velocity = next;
  }
  add_jump(input, samples.back().time_s, -acceleration, 0);
  return input;
}

std::vector<InputJump> delayed(std::vector<InputJump> input, double delay_s) {
  for (InputJump& jump : input) {
    jump.time_s += delay_s;
  }
  return input;
}

CarriedState carried_at(std::span<const Mode> modes, std::span<const InputJump> input, double time_s) {
  const InputNow now = input_at(input, time_s);
  CarriedState state{now.acceleration, 0};
  for (const Mode& mode : modes) {
    const ModeConstants m = constants_of(mode.f_hz, mode.zeta);
    std::complex<double> sum;  // of (dJ + lambda dA) exp(lambda (t - t_k))
    for (const InputJump& jump : input) {
      if (jump.time_s > time_s) {
        break;
      }
      const std::complex<double> weight = jump.jerk_jump_mm_s3 + m.lambda * jump.acceleration_jump_mm_s2;
      sum += times(weight, exp_of(m, time_s - jump.time_s));
    }
    const double forced = -(now.acceleration - 2 * mode.zeta / m.w * now.jerk) / (m.w * m.w);
    state.acceleration_mm_s2 -= mode.participation * sum.imag() / m.rad_per_s;
    state.deviation_mm += mode.participation * (forced - twice_integrated(sum, m).imag() / m.rad_per_s);
  }
  return state;
}

}  // namespace gravure::motion
