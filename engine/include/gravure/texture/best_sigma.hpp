#pragma once

#include <span>
#include <vector>

#include "gravure/texture/clamping.hpp"
#include "gravure/texture/path_timing.hpp"
#include "gravure/texture/split.hpp"
#include "gravure/texture/splitter.hpp"

namespace gravure::texture {

/// What motion along a path has to keep to.
struct PathMachine {
  kinematics::Machine machine;  ///< as kinematics::xyzac_machine() makes it
  AxesLimits limits;
  Stops stops = Stops::corners;
  double servo_s = 50e-6;
  kinematics::Branch branch = kinematics::Branch::positive;  ///< sign of A
  Clamping clamping = {};                                    ///< how the workpiece lies
  bool corner_law = false;                                   ///< PathTimingRequest::corner_law
  AxesServos servos = assumed_servos();                      ///< for the stages' lag
  std::int64_t memory_bytes = 0;                             ///< PathTimingRequest::memory_bytes
};

/// A split with the axes and times that follow from it.
struct TimedSplit {
  Split split;                      ///< as it was made, on the surface as it is given
  std::vector<SurfacePoint> lying;  ///< its targets in the clamping; empty: it lies level
  std::vector<SevenAxes> axes;
  std::vector<double> pulse_mm;
  TimedPath timed;           ///< its motion only from time_split(): split_by_time() would have to hold more than one
  double fastest_s = 0;      ///< of all sigmas that were looked at
  double widest_lag_mm = 0;  ///< TimedPath::stage_lag_mm of the published rule's sigma, beside that of `timed`
  double published_mm = 0;   ///< the sigma of the published rule; 0: nobody asked for it
  int tries = 0;             ///< sigmas that were timed
  /// The points of the texture where the machine finds them.
  std::span<const SurfacePoint> targets() const noexcept { return lying.empty() ? split.targets : lying; }
  /// For time_seven_axes() and prove_seven_axes(); refers to this.
  PathTimingRequest request(const PathMachine& machine, const TexturePath& path) const;
};

/// Times a split that has been made. Errors as seven_axes(), rotary_table() and time_seven_axes().
Result<TimedSplit> time_split(Split split, const TexturePath& path, const PathMachine& machine,
                              const CancelToken& cancel);

/// The better rule: the smallest sigma whose motion takes at most `share` longer than the fastest, because below some
/// sigma the galvo sets the time and a wider one only costs focus and incidence. Looks from the sigma of the published
/// rule down by halves until the share is exceeded, then twice between. The limits hold as in that rule; a splitter
/// that keeps to them itself is run once. `progress` is told of every sigma that was looked at, and how many there may
/// be.
Result<TimedSplit> split_by_time(const Splitter& splitter, const Surface& surface, const TexturePath& path,
                                 const DeviationLimits& limits, const PathMachine& machine, double share,
                                 const CancelToken& cancel, Progress* progress = nullptr);

}  // namespace gravure::texture
