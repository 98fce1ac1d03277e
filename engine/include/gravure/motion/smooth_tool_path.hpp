#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "gravure/motion/ruled_blade.hpp"
#include "gravure/motion/unreverse.hpp"

namespace gravure::motion {

/// Surfaces the tool (or the cone of a beam) must stay clear of, and how far C may be turned out of the way.
struct Surroundings {
  std::span<const Vector3> points;  ///< in the workpiece's frame; none: nothing is tested
  ToolShape shape;
  double margin_mm = 0;
  double c_step_rad = 0.026;  ///< 1 to 2 degrees are published
  double c_most_rad = 0.5;
};

/// Another place the tool goes to with the angles of a sample, as with a move of X, Y or Z alone.
struct HeldStop {
  std::size_t sample = 0;  ///< whose angles hold
  Vector3 centre_mm{};     ///< tip (or focus)
  std::size_t line = 0;    ///< for errors; 0: it is named by its sample
};

struct SmoothPathRequest {
  std::span<const ToolPose> path;  ///< tip (or focus) and direction, as wanted
  std::span<const double> a_deg;   ///< the axes that stand so, C unwrapped
  std::span<const double> c_deg;
  std::span<const double> parameter;  ///< rising strictly
  double tolerance_deg = 0;
  std::size_t control_points = 16;
  double ball_radius_mm = 0;  ///< its centre is held; 0 holds the tip or the focus
  Surroundings around;
  std::span<const HeldStop> stops{};              ///< tested as well; by sample
  std::span<const std::size_t> line_of_sample{};  ///< for errors; none: samples are named by their number
  /// Between samples the machine's axes move evenly, about this rotary centre; none: the tip does, with A and C.
  std::optional<Vector3> straight_axes_about_mm{};
};

struct SmoothPath {
  Unreversed a;
  Unreversed c;                 ///< its deviations are from the wanted C, turns out of the way included
  std::vector<ToolPose> tools;  ///< with the new angles, the ball where it was
  std::size_t turned_samples = 0;
  double largest_turn_deg = 0;  ///< of C out of the way
  double clearance_mm = 0;      ///< least, infinite without points
  std::size_t rounds = 0;       ///< of smoothing
};

/// The loop of [C2] with bounds: reversals are removed from A and C, tool (or focus) centres are computed anew, every
/// sample is tested against the surroundings; where one touches, C is turned by increments until it is free, and the
/// path is smoothed again, until all samples and stops are free, and so is what lies between them, in steps in which
/// no point of the tool moves by more than half of (radius at the tip + margin), or 0.02 mm if that is more: what a
/// step can miss is at most a 31st of that reach deep. Where it touches between two samples both are turned. Fails like
/// remove_reversals() and turn_clear(), naming the sample, or the two it lies between; with out_of_range where samples,
/// or what is between them, still touch after 8 rounds, and where stops are not in order or their samples not there.
Result<SmoothPath> smooth_tool_path(const SmoothPathRequest& request);

}  // namespace gravure::motion
