#pragma once

#include <vector>

#include "gravure/scan/line_trajectory.hpp"

namespace gravure::scan {

/// How the scanner turns set-points into light.
struct LandingModel {
  double lag_us = 0;         ///< the mirrors follow so much later
  bool rounding = true;      ///< set-points are whole counts
  bool microvectors = true;  ///< the scanner moves straight from one set-point to the next; else it knows the path
};

/// Landing minus target of one pulse on the surface: along the line (positive to higher pixels), across it (positive to
/// higher lines), and the distance of the surface from focus (positive towards the head).
struct LandingError {
  double along_um = 0;
  double across_um = 0;
  double defocus_um = 0;
};

/// The model with the scanner's own lag, everything else on.
LandingModel landing_model(const LineTrajectory& trajectory);

/// Where the mirrors are at a time of a line that runs this way, in mm of the field.
kinematics::FieldPoint mirrors_at(const LineTrajectory& trajectory, Direction direction, double slot,
                                  const LandingModel& model);

/// One pulse.
LandingError landing_error(const LineTrajectory& trajectory, Direction direction, std::int64_t pixel,
                           const LandingModel& model);

/// Every pulse of a line, by pixel.
std::vector<LandingError> landing_errors(const LineTrajectory& trajectory, Direction direction,
                                         const LandingModel& model);

}  // namespace gravure::scan
