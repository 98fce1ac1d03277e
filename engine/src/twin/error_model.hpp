#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "axis_motion.hpp"
#include "gravure/core/exposure_map.hpp"
#include "gravure/twin/error_budget.hpp"
#include "scanner_errors.hpp"
#include "shifted_surface.hpp"

namespace gravure {

/// Target minus landing of a pulse on the surface: along the line (positive to higher pixels), across it (positive the
/// way the lines follow each other), and the distance of the surface from focus (positive towards the head).
struct PulseError {
  double along_um = 0;
  double across_um = 0;
  double defocus_um = 0;
};

/// What simulated pulses come to.
struct PulseSums {
  std::int64_t pulses = 0;
  double squares_um2 = 0;
  double worst_um2 = -1;
  PulsePlace worst;

  void merge(const PulseSums& other);
};

/// Where the light of a plan's pulses lands, with the terms that are switched on.
class ErrorModel {
 public:
  /// `trajectory`: none where no scanner is known. `back`: of the passes in which the stage of a flat job comes back;
  /// none: as the others. Fails with out_of_range where the A-B registers are none, and where run-out and growth bring
  /// the workpiece out of the light.
  static Result<ErrorModel> make(const Plan& plan, const scan::LineTrajectory* trajectory, const TwinSettings& twin,
                                 const scan::LineTrajectory* back = nullptr);

  PulseError pulse_error(std::int64_t revolution, std::int64_t line, std::int64_t pixel) const;
  /// Every pulse of a line; `fired`: in order of time, MSB first; empty: all of the window.
  void simulate(std::int64_t revolution, std::int64_t line, std::span<const std::byte> fired, PulseSums& sums) const;

  /// What no pulse of a line exceeds.
  struct Bound {
    double landing_um = 0;
    double defocus_um = 0;
  };
  Bound line_bound(std::int64_t revolution, std::int64_t line) const;
  /// Of that, what the simulation leaves out: helical lines whose lag is not compensated.
  double late_shift_um() const noexcept { return late_shift_um_; }
  /// What no pulse of the job exceeds, and where the bound is largest. Beyond run-out, which is the same in every
  /// revolution, all that changes from line to line grows steadily: the first and the last lines of the first and the
  /// last two revolutions (one for each direction) bound the others.
  struct JobBound {
    Bound bound;
    std::int64_t revolution = 0;
    std::int64_t line = 0;
  };
  JobBound job_bound() const;

 private:
  struct Line;
  struct RunOut {
    double eccentricity_um = 0;
    double angle_rad = 0;
  };

  explicit ErrorModel(const Plan& plan) : plan_(plan), map_(plan) {}
  ShiftedSurface surface_at(std::int64_t line) const;
  double flat_growth_um(std::int64_t revolution, std::int64_t line) const;
  const LineErrors& errors_of(std::int64_t revolution, bool reverse) const noexcept;
  Result<void> check_light() const;
  double column_shift_um(std::int64_t revolution, std::int64_t line) const;
  void set_rounding_range();
  Line line_at(std::int64_t revolution, std::int64_t line) const;
  PulseError landed(const Line& line, std::int64_t index, const AxisMotion::Phase& axis,
                    const AxisMotion::Phase& carriage) const;

  const Plan& plan_;
  ExposureMap map_;
  std::optional<AxisMotion> axis_;
  std::optional<AxisMotion> carriage_;
  ScannerErrors scanner_;
  std::optional<ScannerErrors> scanner_back_;  ///< flat: of the passes in which the stage comes back
  double count_um_ = 0;                        ///< of the scanner
  double late_shift_um_ = 0;  ///< helical: most that U is away from its line's fraction of a column at a late pulse
  Interval rounding_range_;   ///< helical: of the orders to U, on all lines
  std::optional<RunOut> run_out_;
  double growth_ = 0;  ///< of every length, by temperature
  double radius_um_ = 0;
  double column_um_ = 0;
  double columns_per_line_ = 0;  ///< helical
};

}  // namespace gravure
