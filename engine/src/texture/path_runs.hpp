#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gravure/motion/profile.hpp"
#include "gravure/texture/axis_limits.hpp"
#include "gravure/texture/surface.hpp"
#include "path_axes.hpp"

namespace gravure::texture {

/// A move from rest to rest, over `count` segments of equal length in the plane.
struct PathRun {
  std::size_t first = 0;  ///< point
  std::size_t count = 1;
  double length_mm = 0;      ///< in the plane
  AxisBounds caps;           ///< of the length run in the plane
  double stretch = 1;        ///< >= 1: so much slower than the caps allow
  std::int64_t periods = 0;  ///< it lasts
  std::int64_t start = 0;    ///< period, the first run's being 0
  /// Where the spot is every knot, but for both ends: control points of a cubic spline. Empty: a profile.
  std::vector<double> feed_mm = {};

  /// Of the shortest move under the caps: how long it takes, and its peaks (mm/s, mm/s^2). Set with the caps.
  double shortest_s = 0;
  double shortest_speed = 0;
  double shortest_acceleration = 0;

  /// Control point k of the feed, which is passed about k + 1 knots after the start.
  double control(std::int64_t k) const noexcept {
    const auto inner = static_cast<std::int64_t>(feed_mm.size());
    return k <= 0 ? 0 : k > inner ? length_mm : feed_mm[static_cast<std::size_t>(k - 1)];
  }
  bool fed() const noexcept { return !feed_mm.empty(); }
  /// Over so many segments that one hard place must not slow all of them.
  bool is_long() const noexcept { return count >= 8; }
};

/// Where a spot is on the surface.
struct SpotState {
  Vector3 position_mm = Vector3::Zero();
  Vector3 tangent = Vector3::UnitX();  ///< by the length run in the plane
  double bend_per_mm = 0;              ///< of z, second derivative by that length
};

/// The way from a point to the next: straight in the plane, z by the cubic that meets the normals.
class SpotSegment {
 public:
  SpotSegment() = default;
  SpotSegment(const SurfacePoint& from, const SurfacePoint& to);
  Vector3 position(double share) const noexcept {
    const double rest = 1 - share;
    Vector3 at = from_ + share * step_;
    at.z() += share * rest * (rest * left_ - share * right_);
    return at;
  }
  SpotState state(double share) const noexcept;

 private:
  Vector3 from_ = Vector3::Zero();
  Vector3 step_ = Vector3::Zero();
  double left_ = 0;   ///< how much steeper than the chord z begins, over the segment
  double right_ = 0;  ///< and ends
};

/// The moves of a path and their times.
class PathRuns {
 public:
  PathRuns() = default;
  PathRuns(std::vector<SurfacePoint> targets, std::span<const std::size_t> stops, double period_s);

  std::vector<PathRun>& runs() noexcept { return runs_; }
  const std::vector<PathRun>& runs() const noexcept { return runs_; }
  const std::vector<SurfacePoint>& targets() const noexcept { return *targets_; }
  double period_s() const noexcept { return period_s_; }
  /// Periods of all runs; known after schedule().
  std::int64_t periods() const noexcept { return runs_.empty() ? 0 : runs_.back().start + runs_.back().periods; }

  /// Periods from control point to control point of feeds, 0 before set_knot().
  std::int64_t knot() const noexcept { return knot_; }
  void set_knot(std::int64_t periods);
  /// The weights of four control points so many periods behind a knot.
  const std::array<double, 4>& knot_weights(std::int64_t phase) const noexcept {
    return knot_weights_[static_cast<std::size_t>(phase)];
  }

  /// Sets caps of a run and what follows from them.
  static void cap(PathRun& run, const AxisBounds& caps);
  /// The shortest move under the caps, stretched, then to whole periods; of runs that are not fed.
  motion::Profile profile(const PathRun& run) const;
  double peak_speed(const PathRun& run) const noexcept;         ///< mm/s
  double peak_acceleration(const PathRun& run) const noexcept;  ///< mm/s^2
  /// All runs together at least, feeds where they have been set; for a look before schedule().
  double least_time_s() const noexcept;
  /// Sets periods and start of every run.
  void schedule();
  /// The run that period `period` falls into; at the end of one the next.
  std::size_t run_at(std::int64_t period) const noexcept;
  /// Where the spot is after `run_mm` of a run.
  static Place place(const PathRun& run, double run_mm) noexcept;
  SpotSegment segment(std::size_t index) const { return {(*targets_)[index], (*targets_)[index + 1]}; }
  SpotState spot(const PathRun& run, double run_mm) const noexcept;

 private:
  std::int64_t profile_periods(const PathRun& run) const noexcept;
  std::shared_ptr<const std::vector<SurfacePoint>> targets_;  ///< copies of a path share them
  std::vector<PathRun> runs_;
  double period_s_ = 0;
  std::int64_t knot_ = 0;
  std::vector<std::array<double, 4>> knot_weights_;
};

/// The mean of the texture's place over cells of `cell` periods, for SmoothPlace.
std::vector<double> mean_places(const PathRuns& path, std::int64_t cell);

}  // namespace gravure::texture
