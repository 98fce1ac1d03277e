#include "scanner_errors.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gravure/core/units.hpp"
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

double pulse_slot(const scan::LineTiming& timing, Direction direction, std::int64_t index) {
  return timing.pulse_at(direction, timing.first_slot(direction) + index);
}

/// The orders of a line that runs this way, and between which of them its pulses come.
RoundedOrders orders_of(const LineTrajectory& trajectory, Direction direction, const ScannerTerms& terms) {
  const scan::LineTiming& timing = trajectory.path.timing();
  const LandingModel model = model_of(trajectory, terms);
  RoundedOrders orders;
  if (terms.microvectors) {
    for (const scan::SetPoint& point : trajectory.set_points(direction)) {
      orders.order_um.push_back(point.u_mm * kUmPerMm);
    }
  }
  const std::int64_t last_but_one = timing.slots / timing.slots_per_microvector - 2;
  const auto most = static_cast<double>(last_but_one);
  for (std::int64_t i = 0; i < timing.pixels; ++i) {
    const double slot = pulse_slot(timing, direction, i) - model.lag_us * 1e-6 / timing.slot_s();
    if (!terms.microvectors) {
      const double early = static_cast<double>(trajectory.lag_ticks) / static_cast<double>(timing.ticks_per_slot);
      orders.order_um.push_back(trajectory.path.at(direction, slot + early).u_mm * kUmPerMm);
      orders.order_before.push_back(static_cast<std::size_t>(i));
      orders.share_of_next.push_back(0);
      continue;
    }
    const double microvectors = slot / static_cast<double>(timing.slots_per_microvector);
    const double before = std::clamp(std::floor(microvectors), 0.0, std::max(0.0, most));
    orders.order_before.push_back(static_cast<std::size_t>(before));
    orders.share_of_next.push_back(std::clamp(microvectors - before, 0.0, 1.0));
  }
  orders.order_um.push_back(orders.order_um.back());  // after the last one
  return orders;
}

void fill(const LineTrajectory& trajectory, Direction direction, const ScannerTerms& terms, LineErrors& errors) {
  const scan::LineTiming& timing = trajectory.path.timing();
  const scan::LineGeometry& geometry = trajectory.path.geometry();
  const LandingModel ideal = ideal_model(trajectory);
  const LandingModel model = model_of(trajectory, terms);
  const bool later = terms.galvo_resolution && terms.shifted_lines;
  LandingModel unrounded = model;
  unrounded.rounding = false;
  const bool as_ideal = !terms.lag && !terms.galvo_resolution && !terms.microvectors;
  const Vector3 along = (trajectory.path.target(1) - trajectory.path.target(0)).normalized();
  const Vector3 across = geometry.surface_normal.cross(along);
  const std::int64_t last = timing.pixels - 1;
  for (std::int64_t i = 0; i < timing.pixels; ++i) {
    const std::int64_t pixel = direction == Direction::forward ? i : last - i;
    const double slot = pulse_slot(timing, direction, i);
    const LandingError path = landing_error(trajectory, direction, pixel, ideal);
    LandingError error = as_ideal ? path : landing_error(trajectory, direction, pixel, model);
    if (later) {
      error.along_um = landing_error(trajectory, direction, pixel, unrounded).along_um;
    }
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
    const double onwards = terms.backwards ? -1 : 1;
    const auto at = static_cast<std::size_t>(i);
    errors.along_um[at] = error.along_um;
    errors.across_um[at] = onwards * error.across_um;
    errors.defocus_um[at] = path.defocus_um;
    errors.slope_along[at] = beam.dot(along) / rise;
    errors.slope_across[at] = onwards * beam.dot(across) / rise;
  }
  if (later) {
    errors.rounded = orders_of(trajectory, direction, terms);
  }
}

Interval range_of(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, *most};
}

}  // namespace

std::vector<double> RoundedOrders::rounded_off_um(double shift_um, double count_um) const {
  std::vector<double> off(order_um.size());
  for (std::size_t i = 0; i < off.size(); ++i) {
    const double counts = (order_um[i] + shift_um) / count_um;
    off[i] = (std::round(counts) - counts) * count_um;
  }
  return off;
}

ScannerErrors scanner_errors(const LineTrajectory& trajectory, const ScannerTerms& terms) {
  const scan::LineTiming& timing = trajectory.path.timing();
  ScannerErrors both;
  for (std::vector<double>* part :
       {&both[0].along_um, &both[0].across_um, &both[0].defocus_um, &both[0].slope_along, &both[0].slope_across}) {
    part->assign(static_cast<std::size_t>(timing.pixels), 0);
  }
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
