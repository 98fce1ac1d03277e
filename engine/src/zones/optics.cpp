#include "gravure/zones/optics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check_positive.hpp"
#include "gravure/core/units.hpp"

namespace gravure::zones {
namespace {

/// Squares of both radii over the square at normal incidence, by ln(over threshold) and cos(incidence).
double short_share(double log_over, double cosine) noexcept {
  return 1 + std::log(cosine) / log_over;
}
double long_share(double log_over, double cosine) noexcept {
  return short_share(log_over, cosine) / (cosine * cosine);
}

/// The cosine where a share that falls (or rises) from 1 at `from` to beyond `limit` at `to` crosses it.
template <class Share>
double crossing(double from, double to, const Share& is_within) {
  for (int i = 0; i < 100; ++i) {
    const double middle = (from + to) / 2;
    (is_within(middle) ? from : to) = middle;
  }
  return from;
}

}  // namespace

Result<Spot> focus(const Beam& beam) {
  GRAVURE_CHECK(check_positive("diameter_mm", beam.diameter_mm));
  GRAVURE_CHECK(check_positive("focal_length_mm", beam.focal_length_mm));
  const double waist_um =
      2 * beam.m_squared * beam.wavelength_um * beam.focal_length_mm / (std::numbers::pi * beam.diameter_mm);
  return focus_of_waist(waist_um, beam);
}

Result<Spot> focus_of_waist(double waist_um, const Beam& beam) {
  GRAVURE_CHECK(check_positive("wavelength_um", beam.wavelength_um));
  GRAVURE_CHECK(check_positive("average_power_w", beam.average_power_w));
  GRAVURE_CHECK(check_positive("repetition_rate_hz", beam.repetition_rate_hz));
  if (!(beam.m_squared >= 1)) {
    return Error{ErrorCode::out_of_range, fmt::format("m_squared = {}: must be 1 or more", beam.m_squared)};
  }
  GRAVURE_CHECK(check_positive("waist_um", waist_um));
  constexpr double kMicro = 1e6;
  constexpr double kUmPerCm = 1e4;
  Spot spot;
  spot.waist_um = waist_um;
  spot.rayleigh_mm = std::numbers::pi * waist_um * waist_um / (beam.m_squared * beam.wavelength_um) / kUmPerMm;
  spot.pulse_energy_uj = beam.average_power_w / beam.repetition_rate_hz * kMicro;
  const double waist_cm = waist_um / kUmPerCm;
  spot.peak_fluence_j_cm2 = 2 * spot.pulse_energy_uj / kMicro / (std::numbers::pi * waist_cm * waist_cm);
  return spot;
}

double beam_radius_um(const Spot& spot, double defocus_mm) noexcept {
  const double turns = defocus_mm / spot.rayleigh_mm;
  return spot.waist_um * std::sqrt(1 + turns * turns);
}

double fluence_fraction(const Spot& spot, double radius_um, double defocus_mm) noexcept {
  const double radius = beam_radius_um(spot, defocus_mm);
  const double narrowing = spot.waist_um / radius;
  return narrowing * narrowing * std::exp(-2 * radius_um * radius_um / (radius * radius));
}

Result<double> processing_range_mm(const Spot& spot, double share) {
  if (!(share > 0) || share > 1) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("share of the peak fluence = {}: must be above 0 and at most 1", share)};
  }
  return spot.rayleigh_mm * std::sqrt(1 / share - 1);
}

std::optional<Ellipse> ablated_ellipse(const Spot& spot, double over_threshold, double incidence_rad) noexcept {
  const double cosine = std::cos(incidence_rad);
  if (!(cosine > 0) || !(over_threshold * cosine > 1)) {
    return std::nullopt;
  }
  const double short_radius = spot.waist_um * std::sqrt(std::log(over_threshold * cosine) / 2);
  return Ellipse{short_radius, short_radius / cosine};
}

double line_width_um(const Ellipse& ellipse, double angle_rad) noexcept {
  return 2 * std::hypot(ellipse.long_radius_um * std::sin(angle_rad), ellipse.short_radius_um * std::cos(angle_rad));
}

double over_threshold_of_groove(const Spot& spot, double width_um) noexcept {
  const double share = width_um / 2 / spot.waist_um;
  return std::exp(2 * share * share);
}

Result<double> largest_incidence_rad(double over_threshold, double tolerance) {
  if (!(over_threshold > 1) || !std::isfinite(over_threshold) || !(tolerance > 0)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("fluence over threshold = {}: must be above 1, and the tolerance {} above 0",
                             over_threshold, tolerance)};
  }
  const double log_over = std::log(over_threshold);
  // The short radius only falls, to nothing at 1 / over_threshold.
  const double least = tolerance < 1 ? (1 - tolerance) * (1 - tolerance) : 0;
  double cosine = crossing(1, 1 / over_threshold, [&](double c) { return short_share(log_over, c) >= least; });
  // The long one rises to its largest at exp(1/2) / over_threshold, and falls from there.
  const double peak = std::min(1.0, std::exp(0.5) / over_threshold);
  const double most = (1 + tolerance) * (1 + tolerance);
  if (long_share(log_over, peak) > most) {
    cosine = std::max(cosine, crossing(1, peak, [&](double c) { return long_share(log_over, c) <= most; }));
  }
  return std::acos(std::min(1.0, cosine));
}

}  // namespace gravure::zones
