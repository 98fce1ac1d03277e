#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/kinematics/machine.hpp"

namespace gravure {

/// A wanted point between those of a path.
struct WantedPoint {
  kinematics::Vector3 position_mm = kinematics::Vector3::Zero();
  kinematics::Vector3 normal = kinematics::Vector3::UnitZ();
};

/// Wanted points in the order of the path, from memory or, block by block, from a program.
class TargetWalk {
 public:
  TargetWalk(LineSource& program, std::span<const PathTarget> given);
  bool there() const noexcept { return total_ > 0; }
  /// Where the path is after `along_mm`, straight between points; must not fall from call to call. None beyond its
  /// ends.
  Result<std::optional<WantedPoint>> at(double along_mm);

 private:
  Result<PathTarget> point(std::int64_t index);

  LineSource& program_;
  std::span<const PathTarget> given_;
  std::int64_t total_ = 0;
  std::int64_t at_ = 0;  ///< the segment starts here
  std::int64_t block_first_ = 0;
  std::vector<PathTarget> block_;
};

}  // namespace gravure
