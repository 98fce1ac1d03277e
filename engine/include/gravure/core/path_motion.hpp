#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure {

/// The axes of a program that follows a path, in this order everywhere: five stages, the galvo and, where the head has
/// one, the focus axis along the beam.
inline constexpr std::array<std::string_view, 8> kPathAxes{"X", "Y", "Z", "A", "C", "U", "V", "W"};
/// Where W stands among them, and how many axes there are without it.
inline constexpr std::size_t kFocusAxis = 7;

/// Where all axes are ordered to stand at one instant of the servo: mm, A and C in rad with their turns counted on.
struct PathInstant {
  std::array<double, kPathAxes.size()> axes{};  ///< W is 0 where there is none
  /// Length of path on the surface that the spot has covered, mm; never less than an instant before, and the same
  /// while the light has no way to go (dark moves).
  double along_mm = 0;
};

/// Motion along a path: an instant at the start, at every servo period after it, and the last one at or after the end,
/// where every axis rests.
class PathMotion {
 public:
  virtual ~PathMotion() = default;
  virtual std::int64_t instants() const noexcept = 0;
  /// Instants first, first + 1, ... into all of `out`; first + out.size() <= instants(). May be called from one thread
  /// at a time, cheapest in order.
  virtual Result<void> read(std::int64_t first, std::span<PathInstant> out) const = 0;
};

/// The pulses along a path: pulse i belongs where along_mm == (i + 1/2) * pitch_mm, and fires if its bit is 1.
struct PathPulses {
  double pitch_mm = 0;
  std::int64_t count = 0;
  std::vector<std::byte> bits;  ///< MSB first
};

}  // namespace gravure
