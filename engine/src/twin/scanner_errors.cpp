#include "scanner_errors.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "gravure/scan/landing.hpp"

namespace gravure {
namespace {

using kinematics::Vector3;
using scan::Direction;
using scan::LandingError;
using scan::LandingModel;
using scan::LineTrajectory;

/// A scanner that does what it is told, at once or as early as it is told.
LandingModel ideal_model(const LineTrajectory& trajectory) {
  const auto hz = static_cast<double>(trajectory.path.timing().fpga_hz);
  return {static_cast<double>(trajectory.lag_ticks) / hz * 1e6, false, false};
}

LandingModel model_of(const LineTrajectory& trajectory, const ScannerTerms& terms) {
  LandingModel model = ideal_model(trajectory);
  if (terms.lag) {
    model.lag_us = scan::landing_model(trajectory).lag_us;
  }
  model.rounding = terms.galvo_resolution;
  model.microvectors = terms.microvectors;
  return model;
}

void fill(const LineTrajectory& trajectory, Direction direction, const ScannerTerms& terms, LineErrors& errors) {
  const scan::LineTiming& timing = trajectory.path.timing();
  const scan::LineGeometry& geometry = trajectory.path.geometry();
  const LandingModel ideal = ideal_model(trajectory);
  const LandingModel model = model_of(trajectory, terms);
  const bool as_ideal = !terms.lag && !terms.galvo_resolution && !terms.microvectors;
  const Vector3 along = (trajectory.path.target(1) - trajectory.path.target(0)).normalized();
  const Vector3 across = geometry.surface_normal.cross(along);
  const std::int64_t last = timing.pixels - 1;
  for (std::int64_t i = 0; i < timing.pixels; ++i) {
    const std::int64_t pixel = direction == Direction::forward ? i : last - i;
    const auto slot = static_cast<double>(timing.slot_of_pixel(direction, pixel));
    const LandingError path = landing_error(trajectory, direction, pixel, ideal);
    LandingError error = as_ideal ? path : landing_error(trajectory, direction, pixel, model);
    if (!terms.lag) {  // the delay of reverse pulses is there to make up for it
      error.along_um -= path.along_um;
    }
    if (!terms.cross_scan) {
      error.across_um -= path.across_um;
    }
    const auto beam = kinematics::forward(geometry.machine, trajectory.path.joints_at(slot),
                                          mirrors_at(trajectory, direction, slot, ideal))
                          .towards_head;
    const double rise = beam.dot(geometry.surface_normal);
    const auto at = static_cast<std::size_t>(i);
    errors.along_um[at] = error.along_um;
    errors.across_um[at] = error.across_um;
    errors.defocus_um[at] = path.defocus_um;
    errors.slope_along[at] = beam.dot(along) / rise;
    errors.slope_across[at] = beam.dot(across) / rise;
  }
}

Interval range_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, *most};
}

}  // namespace

LineErrors LineErrors::none(std::int64_t pixels) {
  LineErrors errors;
  for (std::vector<double>* part :
       {&errors.along_um, &errors.across_um, &errors.defocus_um, &errors.slope_along, &errors.slope_across}) {
    part->assign(static_cast<std::size_t>(pixels), 0);
  }
  return errors;
}

ScannerErrors scanner_errors(const LineTrajectory& trajectory, const ScannerTerms& terms) {
  const scan::LineTiming& timing = trajectory.path.timing();
  ScannerErrors both = {LineErrors::none(timing.pixels), {}};
  fill(trajectory, Direction::forward, terms, both[0]);
  both[1] = both[0];
  if (timing.bidirectional) {
    fill(trajectory, Direction::reverse, terms, both[1]);
  }
  for (LineErrors& errors : both) {
    errors.along = range_of(errors.along_um);
    errors.across = range_of(errors.across_um);
    errors.defocus = range_of(errors.defocus_um);
    errors.slope_along_range = range_of(errors.slope_along);
    errors.slope_across_range = range_of(errors.slope_across);
  }
  return both;
}

}  // namespace gravure
