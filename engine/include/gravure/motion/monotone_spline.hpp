#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::motion {

/// A cubic B-spline over [from, to] with evenly spaced knots, clamped at both ends. Its derivative's control points are
/// differences of its own, so control points that never fall give a curve that never falls.
struct CubicSpline {
  double from = 0;
  double to = 1;
  std::vector<double> control_points;          ///< at least 4
  double at(double parameter) const noexcept;  ///< held at the ends outside
};

/// How an end of the fitted curve is held.
enum class SplineEnd : std::uint8_t {
  free,
  anchored,  ///< the curve starts (ends) on the given value
  resting,   ///< and with neither slope nor curvature there, so that pieces join smoothly at a turning point
};

struct MonotoneFitRequest {
  std::span<const double> parameter;  ///< rising strictly
  std::span<const double> value;
  std::size_t control_points = 4;     ///< 4 to 1e6; 6 or more where both ends rest
  int direction = 1;                  ///< +1 never falls, -1 never rises, 0 unconstrained
  SplineEnd start = SplineEnd::free;  ///< held ends take the first and last value
  SplineEnd end = SplineEnd::free;
};

struct MonotoneFit {
  CubicSpline spline;
  double rms = 0;  ///< deviation from the values at their parameters
  double largest = 0;
  bool optimal = true;  ///< false where the search for the least squares was cut short; it is monotone all the same
};

/// The least-squares curve under the constraint: non-negative least squares on the differences of the control points,
/// solved by exchanging active constraints; every solve is a banded one over the free blocks, so 100,000 values and
/// 2,000 control points take milliseconds. Where a knot span holds no value, a second-difference penalty of 1e-9 of the
/// mean diagonal decides.
/// Fails with out_of_range for sizes outside their ranges and bad_argument for parameters that do not rise, values that
/// are not finite, or held ends that lie against the direction.
Result<MonotoneFit> fit_monotone(const MonotoneFitRequest& request);

}  // namespace gravure::motion
