#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/scan/line_geometry.hpp"

namespace gravure::report {

/// What one pulse of a Gaussian spot removes, by the logarithmic law (docs/report.md; the radius is r^2 = (w0^2 / 2)
/// ln(I0 cos t / Ith) of [D]). The spot is w0 in radius, to 1/e^2, and stretched by 1 / cos t along the tilt.
struct PulseRemoval {
  double waist_um = 0;  ///< w0
  double fluence_j_cm2 = 0;
  double threshold_j_cm2 = 0;
  double penetration_um = 0;

  /// ln(F0 cos t / Fth), 0 where nothing is removed.
  double strength(double incidence_rad) const;
  double depth_um(double incidence_rad) const;   ///< in the centre
  double radius_um(double incidence_rad) const;  ///< of the crater, across the tilt
  double volume_um3(double incidence_rad) const;
  /// Depth at a place: `across` the tilt, and `along` it.
  double depth_at_um(double across_um, double along_um, double incidence_rad) const;
};

/// What the job says of it; none where one of the four keys is absent.
std::optional<PulseRemoval> pulse_removal(const LaserSettings& laser);
/// The keys of [laser] that are absent, "spot_um, penetration_nm".
std::string absent_removal_keys(const LaserSettings& laser);

/// The angle between the beam and the normal of the surface where a line marks: 0 where the plan has no scanner. By the
/// geometry of the lines and the lens; bands are alike, and of helical lines, whose window slides, the middle counts.
class Incidence {
 public:
  explicit Incidence(const Plan& plan);
  double at_column_rad(std::int64_t column) const;

 private:
  std::int64_t pixels_ = 1;
  bool slides_ = false;
  std::optional<scan::LineGeometry> geometry_;
};

/// Pulses at the pixels of a small window, and the depth they leave there: every crater around the middle of its pixel,
/// added up. Pixels beyond the window have no pulses.
struct PulseWindow {
  std::int64_t width = 0;
  std::int64_t height = 0;
  double pixel_width_um = 0;
  double pixel_height_um = 0;
  bool tilt_down = true;             ///< the spot is stretched from row to row, else from column to column
  std::vector<std::int64_t> pulses;  ///< row by row
};
std::vector<double> window_depth_um(const PulseWindow& window, const PulseRemoval& removal, double incidence_rad);

}  // namespace gravure::report
