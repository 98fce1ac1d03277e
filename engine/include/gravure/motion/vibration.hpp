#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gravure/motion/profile.hpp"

namespace gravure::motion {

/// One linear mode of what the axis carries: z'' + 2 zeta w z' + w^2 z = -a(t). The carried part moves by the axis'
/// own motion plus the sum of participation * z ([C1], the two-degree-of-freedom table).
struct Mode {
  double f_hz = 0;           ///< undamped natural frequency, w / 2 pi
  double zeta = 0;           ///< damping ratio, 0 <= zeta < 1
  double participation = 0;  ///< the shares of all modes add up to 1 where nothing else moves
};

inline constexpr std::size_t kMaxModes = 8;

struct FrequencyAndDamping {
  double f_hz = 0;
  double zeta = 0;
};

/// Shares for the last mass of a chain on the axis: p_i = product over j != i of f_j^2 / (f_j^2 - f_i^2); the mass
/// ratio drops out. Fails with out_of_range for modes check_modes() refuses, and for two frequencies so near (1e-6)
/// that the chain cannot have them: give the shares instead.
Result<std::vector<Mode>> chain_modes(std::span<const FrequencyAndDamping> modes);

/// out_of_range unless there are 1 to kMaxModes modes with f_hz > 0, 0 <= zeta < 1 and a finite share.
Result<void> check_modes(std::span<const Mode> modes);

/// A change of the input at one instant. A motion with piecewise constant jerk is a list of these, in order of time.
struct InputJump {
  double time_s = 0;
  double acceleration_jump_mm_s2 = 0;
  double jerk_jump_mm_s3 = 0;
};

std::vector<InputJump> input_of(const Profile& profile);

/// What a servo makes of the profile that reads its position at every update and runs at constant velocity in between:
/// the acceleration is a velocity step at each update. Fails like sample_profile().
Result<std::vector<InputJump>> quantised_input_of(const Profile& profile, double update_us);

/// The input `delay_s` later.
std::vector<InputJump> delayed(std::vector<InputJump> input, double delay_s);

/// What is carried, at one instant.
struct CarriedState {
  double acceleration_mm_s2 = 0;  ///< absolute: the axis' own plus that of the modes
  double deviation_mm = 0;        ///< of the position from the axis' own
};

/// In closed form, during the input or after it. Modes as check_modes() accepts.
CarriedState carried_at(std::span<const Mode> modes, std::span<const InputJump> input, double time_s);

}  // namespace gravure::motion
