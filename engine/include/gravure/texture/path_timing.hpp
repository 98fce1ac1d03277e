#pragma once

#include <memory>
#include <span>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/texture/axes.hpp"
#include "gravure/texture/axis_limits.hpp"
#include "gravure/texture/following_error.hpp"
#include "gravure/texture/prove_limits.hpp"
#include "gravure/texture/stop_times.hpp"

namespace gravure::texture {

/// What is to be run: the points of a path on the surface, and the axes at each (seven_axes()).
struct PathTimingRequest {
  std::span<const SurfacePoint> targets;
  std::span<const SevenAxes> axes;
  std::span<const double> pulse_mm;  ///< PathInstant::along_mm at each point: pulse_lengths_mm()
  RotaryTable table;
  AxesLimits limits;
  Stops stops = Stops::corners;
  double servo_s = 50e-6;
  /// The stages' place along the path is the texture's, averaged over a window of which this is the standard deviation.
  /// 0: a quarter of the time that `sigma_points` take, but from 5 to 60 ms.
  double smoothing_s = 0;
  double sigma_points = 0;  ///< of the split, in points; what the stages have been smoothed by already
  /// Lets the stages pass corners no faster than the law of a Gaussian of `sigma_points` allows (corner_speed_mm_s()),
  /// where the path is straight for three sigma to both sides: nothing more where the split is that Gaussian.
  bool corner_law = false;
  AxesServos servos = assumed_servos();  ///< for TimedPath::stage_lag_mm
  std::int64_t memory_bytes = 0;         ///< check_planning_memory(); 0: as much as it takes
  Progress* progress = nullptr;          ///< told how far proofs are, in servo periods; each proof adds its own
};

/// Motion along a path within limits. It holds what it needs of the request.
struct TimedPath {
  std::shared_ptr<const PathMotion> motion;
  double time_s = 0;       ///< of all instants, lead-in and run-out of the stages included
  double smoothing_s = 0;  ///< as it was chosen
  /// The most that the light will be off its point, across the beam, because the stages follow behind: what loops of
  /// `servos` have at steady speed and acceleration, looked at every half cell of the smoothing. predict_following()
  /// solves them and adds the galvo.
  double stage_lag_mm = 0;
  std::size_t runs = 0;    ///< moves from rest to rest
  std::size_t slowed = 0;  ///< those of them that the stages' limits have made slower
  int passes = 0;          ///< times that the limits were looked at before none was broken
};

/// Motion of all seven axes, and of the focus axis where the limits have one. Between two resting points the spot makes
/// the shortest jerk-limited move from rest to rest that U and V can, straight over the plane, lengthened to whole
/// servo periods; at each it stands exactly on its point. The stages do not rest: they follow the split's path (cubic
/// splines through its points) by the texture's own place along it, smoothed in time, and U and V reach from there to
/// the spot: [U V w] = M (p - p'), both moving; W is w. Where stages would leave their limits the moves round there are
/// slowed until none does. Looks at two places or more a point; prove_limits() and prove_seven_axes() look at every
/// instant. out_of_range for fewer than two points, a servo period that is not 1 us to 1 s, limits that are not above
/// 0, points that no timing can keep within limits (a jump of an axis), and motion longer than a program holds or too
/// long to be planned: these are found from lower bounds of the time, before memory is asked for; cancelled on request.
Result<TimedPath> time_seven_axes(const PathTimingRequest& request, const CancelToken& cancel);

/// Motion whose every instant has been looked at.
struct ProvenPath {
  TimedPath path;
  std::vector<LimitUse> uses;  ///< of the last proof; broken() says what is left, in practice nothing
  int proofs = 0;
};
/// time_seven_axes(), proved by prove_limits(): what that finds broken is slowed and proved again, at most 12 times.
Result<ProvenPath> prove_seven_axes(const PathTimingRequest& request, const CancelToken& cancel);

/// The same path by the stages alone, U and V at 0; `axes` are those that bring the stages to each point of `targets`.
/// They run straight in their own coordinates from one resting point to the next, in curves through the points between.
Result<TimedPath> time_five_axes(const PathTimingRequest& request, const CancelToken& cancel);

}  // namespace gravure::texture
