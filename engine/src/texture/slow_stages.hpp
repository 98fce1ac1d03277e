#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gravure/texture/path_timing.hpp"
#include "path_feed.hpp"
#include "path_runs.hpp"
#include "path_spline.hpp"
#include "smooth_place.hpp"

namespace gravure::texture {

/// Caps every run by what U, V and W can, less what the stages' own motion takes of it: [M p]''' - X''' has M''' p,
/// 3 M'' p', 3 M' p'' and X''' beside M p''', and so on for acceleration and speed; each is bounded from above. Without
/// `place` the stages are taken to stand still.
void cap_by_galvo(const PathTimingRequest& request, const StageSpline& stages, const SmoothPlace* place,
                  PathRuns& path);

/// How much slower each segment must get, found spread over its neighbours.
class Needs {
 public:
  explicit Needs(const PathRuns& path);
  void add(std::int64_t from_period, std::int64_t to_period, double factor);
  /// What is needed fades by e within `spread` periods to both sides.
  void spread(const PathFeed& feed, double spread);
  /// Short runs as a whole, long ones where it is needed.
  void slow(PathFeed& feed, PathRuns& path) const;

 private:
  const PathRuns& path_;
  std::vector<double> factors_;
};

/// Whether a stage is beyond a limit somewhere; where it is worst.
struct SlowDown {
  bool needed = false;
  std::size_t point = 0;
  std::size_t axis = 0;
};
/// Looks at the stages all along and slows the runs round every place where a limit is broken, less and less with
/// the distance from it; `gain` times as much as one place by itself would ask for, 1 or more. `most_speed`: points a
/// second at each point (corner_feed()), or empty.
SlowDown slow_stages(const AxesLimits& limits, const StageSpline& stages, const SmoothPlace& place,
                     std::span<const double> most_speed, double gain, PathFeed& feed, PathRuns& path);

/// Caps a run of the stages alone. The axis that cannot be kept within its limits, if there is one.
std::optional<std::size_t> cap_by_stages(const AxesLimits& limits, const StageSpline& stages, const PathRuns& path,
                                         PathRun& run);

}  // namespace gravure::texture
