#pragma once

#include <optional>

#include "gravure/core/error.hpp"

namespace gravure::zones {

/// A Gaussian beam before its lens.
struct Beam {
  double wavelength_um = 0;       ///< > 0
  double m_squared = 1;           ///< >= 1
  double diameter_mm = 0;         ///< > 0, on the lens
  double focal_length_mm = 0;     ///< > 0
  double average_power_w = 0;     ///< > 0
  double repetition_rate_hz = 0;  ///< > 0
};

/// What it is in focus.
struct Spot {
  double waist_um = 0;     ///< w0, the radius where the fluence is 1/e^2 of its peak
  double rayleigh_mm = 0;  ///< zR
  double pulse_energy_uj = 0;
  double peak_fluence_j_cm2 = 0;  ///< I0 = 2 E / (pi w0^2), [D] eq. 2
};

/// [D] eqs 5 and 6 in their right form: 2 w0 = 4 M^2 lambda f / (pi D), zR = pi w0^2 / (M^2 lambda). The publication
/// calls the former w0 and prints a major spot diameter as zR. out_of_range names the value that is not positive.
Result<Spot> focus(const Beam& beam);
/// The same for a waist that is known.
Result<Spot> focus_of_waist(double waist_um, const Beam& beam);

/// w(z) = w0 sqrt(1 + (z/zR)^2).
double beam_radius_um(const Spot& spot, double defocus_mm) noexcept;
/// I(r, z) / I0 = (w0/w)^2 exp(-2 r^2 / w^2). [D] eq. 1 has the first power of w0/w, by which the energy through the
/// plane z = zR would be 1.41 times the pulse's.
double fluence_fraction(const Spot& spot, double radius_um, double defocus_mm) noexcept;

/// How far from focus, to either side, the fluence on the axis is still `share` (above 0, at most 1) of the peak, in
/// mm: zR sqrt(1/share - 1). Layers may be twice as thick.
Result<double> processing_range_mm(const Spot& spot, double share);

/// What one pulse ablates: an ellipse, long in the plane of incidence.
struct Ellipse {
  double short_radius_um = 0;
  double long_radius_um = 0;
};

/// By the fluence at normal incidence over the threshold of ablation and the angle of incidence: short radius^2 =
/// (w0^2 / 2) ln(over cos(incidence)), long = short / cos(incidence) ([D] eqs 3, 4). Nothing where nothing is ablated.
std::optional<Ellipse> ablated_ellipse(const Spot& spot, double over_threshold, double incidence_rad) noexcept;

/// Width of a line of such ellipses that runs at `angle_rad` to their long axis.
double line_width_um(const Ellipse& ellipse, double angle_rad) noexcept;

/// Peak fluence over threshold that makes grooves of this width in focus: exp(2 r^2 / w0^2).
double over_threshold_of_groove(const Spot& spot, double width_um) noexcept;

/// The largest angle of incidence up to which both radii stay within `tolerance` (0.01: 1 %) of those at normal
/// incidence. out_of_range unless over_threshold > 1 and tolerance > 0.
Result<double> largest_incidence_rad(double over_threshold, double tolerance);

}  // namespace gravure::zones
