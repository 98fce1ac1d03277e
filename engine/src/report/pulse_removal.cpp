#include "gravure/report/pulse_removal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gravure/kinematics/scan_head.hpp"
#include "gravure/scan/plan_trajectory.hpp"

namespace gravure::report {

double PulseRemoval::strength(double incidence_rad) const {
  const double ratio = fluence_j_cm2 * std::cos(incidence_rad) / threshold_j_cm2;
  return ratio > 1 ? std::log(ratio) : 0;
}

double PulseRemoval::depth_um(double incidence_rad) const {
  return penetration_um * strength(incidence_rad);
}

double PulseRemoval::radius_um(double incidence_rad) const {
  return waist_um * std::sqrt(strength(incidence_rad) / 2);
}

double PulseRemoval::volume_um3(double incidence_rad) const {
  const double size = waist_um * strength(incidence_rad);
  return std::numbers::pi * penetration_um * size * size / (4 * std::cos(incidence_rad));
}

double PulseRemoval::depth_at_um(double across_um, double along_um, double incidence_rad) const {
  const double along = along_um * std::cos(incidence_rad);
  const double fall = 2 * (across_um * across_um + along * along) / (waist_um * waist_um);
  return penetration_um * std::max(0.0, strength(incidence_rad) - fall);
}

std::optional<PulseRemoval> pulse_removal(const LaserSettings& laser) {
  if (!laser.spot_um || !laser.fluence_j_cm2 || !laser.threshold_j_cm2 || !laser.penetration_nm) {
    return std::nullopt;
  }
  return PulseRemoval{to_double(*laser.spot_um) / 2, to_double(*laser.fluence_j_cm2), to_double(*laser.threshold_j_cm2),
                      to_double(*laser.penetration_nm) / 1000};
}

std::string absent_removal_keys(const LaserSettings& laser) {
  std::string absent;
  const auto look = [&absent](const char* key, const std::optional<Rational>& value) {
    if (!value) {
      absent += (absent.empty() ? "" : ", ") + std::string(key);
    }
  };
  look("spot_um", laser.spot_um);
  look("fluence_j_cm2", laser.fluence_j_cm2);
  look("threshold_j_cm2", laser.threshold_j_cm2);
  look("penetration_nm", laser.penetration_nm);
  return absent;
}

Incidence::Incidence(const Plan& plan) : pixels_(plan.line.pixels), slides_(plan.carriage.has_value()) {
  if (Result<scan::LineGeometry> geometry = scan::plan_geometry(plan)) {
    geometry_ = std::move(geometry).value();
  }
}

double Incidence::at_column_rad(std::int64_t column) const {
  if (!geometry_) {
    return 0;
  }
  const double pixel = slides_ ? static_cast<double>(pixels_ - 1) / 2 : static_cast<double>(column % pixels_);
  const double from_middle_mm = (pixel - static_cast<double>(pixels_ - 1) / 2) * geometry_->pixel_pitch_mm;
  const kinematics::FieldPoint field{geometry_->centre_u_mm + from_middle_mm, geometry_->centre_v_mm, 0};
  const kinematics::Vector3 beam = kinematics::beam_of(geometry_->machine.head, field);
  return std::acos(std::clamp(beam.dot(geometry_->surface_normal), -1.0, 1.0));
}

std::vector<double> window_depth_um(const PulseWindow& window, const PulseRemoval& removal, double incidence_rad) {
  std::vector<double> depth(window.pulses.size(), 0.0);
  const double radius = removal.radius_um(incidence_rad);
  const double stretched = radius / std::cos(incidence_rad);
  const auto reach_x = static_cast<std::int64_t>((window.tilt_down ? radius : stretched) / window.pixel_width_um);
  const auto reach_y = static_cast<std::int64_t>((window.tilt_down ? stretched : radius) / window.pixel_height_um);
  const auto index = [&window](std::int64_t x, std::int64_t y) {
    return static_cast<std::size_t>(y * window.width + x);
  };
  for (std::int64_t dy = -std::min(reach_y, window.height - 1); dy <= std::min(reach_y, window.height - 1); ++dy) {
    for (std::int64_t dx = -std::min(reach_x, window.width - 1); dx <= std::min(reach_x, window.width - 1); ++dx) {
      const double right_um = static_cast<double>(dx) * window.pixel_width_um;
      const double down_um = static_cast<double>(dy) * window.pixel_height_um;
      const double removed = window.tilt_down ? removal.depth_at_um(right_um, down_um, incidence_rad)
                                              : removal.depth_at_um(down_um, right_um, incidence_rad);
      if (removed <= 0) {
        continue;
      }
      for (std::int64_t y = std::max<std::int64_t>(0, dy); y < window.height + std::min<std::int64_t>(0, dy); ++y) {
        for (std::int64_t x = std::max<std::int64_t>(0, dx); x < window.width + std::min<std::int64_t>(0, dx); ++x) {
          depth[index(x, y)] += removed * static_cast<double>(window.pulses[index(x - dx, y - dy)]);
        }
      }
    }
  }
  return depth;
}

}  // namespace gravure::report
