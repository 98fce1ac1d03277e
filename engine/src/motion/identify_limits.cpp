#include "identify_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kPerMode = 4;  // s, w, A, B

/// The fit with one mode split into two of half its amplitude, so far apart; the second stands last.
VectorXd split(const VectorXd& parameters, Index first, double gap_rad_s) {
  VectorXd p(parameters.size() + kPerMode);
  p << parameters, parameters.segment(first, kPerMode);
  for (const Index at : {first, parameters.size()}) {
    p.segment(at + 2, 2) /= 2;
  }
  p[first + 1] -= gap_rad_s / 2;
  p[parameters.size() + 1] += gap_rad_s / 2;
  return p;
}

/// Whether such a pair would pass as two.
bool shows(const Series& series, const VectorXd& p, Index first, double gap_rad_s, double variance) {
  const VectorXd pair = split(p, first, gap_rad_s);
  const Eigen::MatrixXd covariance = covariance_at(series, pair, variance);
  if (covariance.size() == 0) {
    return false;
  }
  const auto sd = [&covariance](Index i, Index j) { return std::sqrt(covariance(i, i) + covariance(j, j)); };
  const auto stands_out = [&](Index at) {
    return std::hypot(pair[at + 2], pair[at + 3]) > kStandsOutInDeviations * sd(at + 2, at + 3);
  };
  return gap_rad_s >= kApartInDeviations * sd(first + 1, p.size() + 1) && stands_out(first) && stands_out(p.size());
}

double length_of(const Series& series) {
  return series.period_s * static_cast<double>(series.values.size());
}

double noise_variance(const Series& series, const DampedFit& fit) {
  const auto parameters = static_cast<double>(fit.parameters.size());
  return fit.sum_of_squares / std::max(1.0, static_cast<double>(series.values.size()) - parameters);
}

std::string resolution_text(const Identification& found, const IdentifiedMode& mode, double bandwidth_hz) {
  const std::string limit = std::isfinite(mode.resolution_hz) ? fmt::format("closer than {:.3g} Hz", mode.resolution_hz)
                                                              : std::string("however far apart");
  return fmt::format(
      "{:.4g} Hz may be two: modes {} look like one in {:.4g} s of record (1/T = {:.3g} Hz) with noise of {:.3g} "
      "mm/s^2, "
      "though its bandwidth is {:.3g} Hz; record longer, or with less noise",
      mode.mode.f_hz, limit, found.record_s, 1 / found.record_s, found.noise_sd_mm_s2, bandwidth_hz);
}

}  // namespace

double resolution_hz(const Series& series, const DampedFit& fit, std::size_t mode) {
  constexpr double kLeast = 1e-4;  // of 1 / T
  constexpr double kPrecise = 1.01;
  const Index first = 1 + kPerMode * static_cast<Index>(mode);
  const double variance = noise_variance(series, fit);
  const auto told = [&](double gap_rad_s) { return shows(series, fit.parameters, first, gap_rad_s, variance); };
  double low = kLeast * kTwoPi / length_of(series);
  double high = low;
  const double most = fit.parameters[first + 1];  // the lower one then has half the frequency
  while (!told(high)) {
    if (high >= most) {
      return std::numeric_limits<double>::infinity();
    }
    low = high;
    high = std::min(most, 4 * high);
  }
  while (high > kPrecise * low) {
    const double middle = std::sqrt(low * high);
    (told(middle) ? high : low) = middle;
  }
  return high / kTwoPi;
}

std::vector<std::string> warnings_of(const Series& series, const DampedFit& fit, const Identification& found) {
  constexpr double kShareOfBandwidth = 0.25;
  constexpr double kShareOfRate = 0.2;
  constexpr double kDeviations = 5;
  std::vector<std::string> warnings;
  for (const IdentifiedMode& mode : found.modes) {
    const double f = mode.mode.f_hz;
    const double bandwidth_hz = 2 * mode.mode.zeta * f;
    if (mode.resolution_hz > kShareOfBandwidth * bandwidth_hz) {
      warnings.push_back(resolution_text(found, mode, bandwidth_hz));
    }
    if (f > kShareOfRate * found.sample_hz) {
      warnings.push_back(fmt::format(
          "{:.4g} Hz may be {:.4g} Hz, folded at half the sample rate of {:.4g} Hz; sample faster than {:.4g} "
          "Hz, or keep what is above {:.4g} Hz from the sampler",
          f, found.sample_hz - f, found.sample_hz, (found.sample_hz - f) / kShareOfRate, found.sample_hz / 2));
    }
  }
  // White noise stays within a few 1 / sqrt(samples).
  const double correlation = residual_correlation(series, fit);
  if (correlation < -kDeviations / std::sqrt(static_cast<double>(series.values.size()))) {
    warnings.push_back(fmt::format(
        "what is left besides the modes alternates from sample to sample (correlation {:.2g}), as a vibration "
        "close to half the sample rate of {:.4g} Hz does; sample faster, or filter before the sampler",
        correlation, found.sample_hz));
  }
  return warnings;
}

}  // namespace gravure::motion
