#pragma once

#include <cstdint>

#include "gravure/motion/profile.hpp"
#include "path_runs.hpp"

namespace gravure::texture {

/// What the spot does in one run, by periods from its start: its profile, or the spline of its feed. Refers to both.
class RunMotion {
 public:
  RunMotion(const PathRuns& path, const PathRun& run);
  /// Length run in the plane, mm; at and behind the end exactly all of it.
  double at(std::int64_t period) const noexcept;
  /// Integral of that length over periods, mm s; 0 <= from <= to, halves too.
  double travelled(double from_period, double to_period) const noexcept;

 private:
  double between(double period) const noexcept;
  const PathRuns* path_;
  const PathRun* run_;
  motion::Profile profile_;
};

}  // namespace gravure::texture
