#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace gravure::motion {

/// Evenly sampled values.
struct Series {
  std::vector<double> values;
  double period_s = 0;
};

/// offset + sum over modes of exp(-s t) (A cos w t + B sin w t); parameters are offset, then s, w, A, B of each mode.
struct DampedFit {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;
  double sum_of_squares = 0;
  bool solved = false;
  std::size_t modes() const noexcept { return static_cast<std::size_t>(parameters.size() - 1) / 4; }
};

/// What the windows of a series have in common, for ESPRIT with a lag of `stride` samples. Refers to the series.
class SignalSpace {
 public:
  SignalSpace(const Series& series, std::size_t stride);
  /// Poles -s + i w (w > 0) of at most `count` modes. Fewer where the data have fewer that oscillate.
  std::vector<std::complex<double>> poles(std::size_t count) const;

 private:
  const Series& series_;
  std::size_t stride_;
  Eigen::MatrixXd vectors_;  ///< by rising share
};

/// Sum of squares that is left with these poles and the best amplitudes.
double misfit(const Series& series, const std::vector<std::complex<double>>& poles);

/// Covariance of the parameters at p for white noise of this variance; empty where they cannot be told from each other.
Eigen::MatrixXd covariance_at(const Series& series, const Eigen::VectorXd& p, double variance);

/// Correlation of what the fit leaves from one sample to the next: 0 for white noise, -1 for what alternates.
double residual_correlation(const Series& series, const DampedFit& fit);

/// Levenberg-Marquardt from the given poles.
DampedFit fit_damped(const Series& series, const std::vector<std::complex<double>>& poles);

}  // namespace gravure::motion
