#pragma once

#include <span>
#include <vector>

#include "gravure/texture/axis_limits.hpp"
#include "path_runs.hpp"
#include "path_spline.hpp"

namespace gravure::texture {

/// How fast long runs (PathRun::is_long()) are passed, point by point: time-optimal along the path under speed and
/// acceleration of all stages, by one sweep back and one forth over the square of the speed (as TOPP-RA does), then
/// sampled every knot as the control points of a cubic spline in time, which keeps the jerk of the spot finite. What
/// the sweeps cannot know (jerk, the smoothing of the stages) is put right by `slow`.
class PathFeed {
 public:
  PathFeed() = default;
  explicit PathFeed(const PathRuns& path);
  /// Whether there is a long run at all.
  bool any() const noexcept { return !slack_.empty(); }
  /// Passes the segment from point `segment` to the next `factor` times slower than its limits allow, on top of what
  /// has been said before.
  void slow(std::size_t segment, double factor) noexcept { slack_[segment] *= factor; }
  /// Finds the speeds and gives every long run its feed; the first time it chooses the knots as well.
  /// out_of_range where feeds would be too long to be held.
  Result<void> plan(const AxesLimits& limits, const StageSpline& stages, PathRuns& path);
  /// How long a segment of a long run takes, s.
  double segment_s(std::size_t segment) const noexcept;

 private:
  struct Caps {
    double speed2 = 0;  ///< points^2 / s^2
    double acceleration = 0;
  };
  void cap_runs(const PathRuns& path, bool ends);
  void sweep(const AxesLimits& limits, const StageSpline& stages);
  void choose_knot(const AxesLimits& limits, PathRuns& path) const;
  double time_s(const PathRuns& path) const noexcept;
  void sample(PathRuns& path, PathRun& run) const;

  std::vector<double> slack_;   ///< of segments
  std::vector<Caps> caps_;      ///< of points: what the galvo allows
  std::vector<double> speed2_;  ///< of points
};

}  // namespace gravure::texture
