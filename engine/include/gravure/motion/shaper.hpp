#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gravure/motion/vibration.hpp"

namespace gravure::motion {

enum class ShaperKind : std::uint8_t { zv, zvd };

/// One impulse of an input shaper; the sizes of a shaper add up to 1.
struct ShaperImpulse {
  double time_s = 0;
  double size = 0;
};

/// Zero-vibration shaper (2 impulses a mode), or the one that is also flat in frequency (3 a mode), for all modes at
/// once by convolution. Shaping delays the axis: axes that follow one contour need the same shaper.
/// Fails with out_of_range for modes check_modes() refuses and for more than 4 modes (the impulses multiply).
Result<std::vector<ShaperImpulse>> make_shaper(ShaperKind kind, std::span<const Mode> modes);

/// The input run through the shaper: each jump once per impulse, in order of time.
std::vector<InputJump> shape_input(std::span<const InputJump> input, std::span<const ShaperImpulse> shaper);

}  // namespace gravure::motion
