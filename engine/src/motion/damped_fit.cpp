#include "damped_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// matrix += vector vector^T, the lower triangle only.
void add_outer_product(MatrixXd& matrix, const VectorXd& vector) {
  for (Eigen::Index k = 0; k < vector.size(); ++k) {
    const Eigen::Index left = vector.size() - k;
    matrix.col(k).tail(left) += vector[k] * vector.tail(left);
  }
}

constexpr Index kLags = 48;

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

/// Sums over the record that a Gauss-Newton step needs.
struct Normal {
  MatrixXd matrix;
  VectorXd right;
  double sum_of_squares = 0;
};

/// exp(-s t) (cos w t + i sin w t) of every mode, sample by sample: one multiplication each, from exact values every
/// few samples so that rounding does not gather.
class Oscillations {
 public:
  Oscillations(const VectorXd& p, double period_s) : p_(p), period_s_(period_s) {
    for (Index m = 1; m < p.size(); m += 4) {
      turn_.push_back(exact(m, period_s));
      now_.emplace_back(1, 0);
    }
  }
  const std::vector<std::complex<double>>& at(std::size_t sample) {
    constexpr std::size_t kExactEvery = 64;
    for (std::size_t i = 0; i < now_.size() && sample > 0; ++i) {
      const auto m = static_cast<Index>(1 + 4 * i);
      now_[i] =
          sample % kExactEvery == 0 ? exact(m, static_cast<double>(sample) * period_s_) : times(now_[i], turn_[i]);
    }
    return now_;
  }

 private:
  std::complex<double> exact(Index m, double t) const {
    const double size = std::exp(-p_[m] * t);
    return {size * std::cos(p_[m + 1] * t), size * std::sin(p_[m + 1] * t)};
  }
  const VectorXd& p_;
  double period_s_;
  std::vector<std::complex<double>> turn_;
  std::vector<std::complex<double>> now_;
};

/// `linear_only`: derivatives to s and w are left out, so that the step solves offset, A and B.
Normal normal_equations(const Series& series, const VectorXd& p, bool linear_only) {
  const Index size = p.size();
  Normal normal{MatrixXd::Zero(size, size), VectorXd::Zero(size), 0};
  VectorXd row(size);
  Oscillations oscillations(p, series.period_s);
  for (std::size_t k = 0; k < series.values.size(); ++k) {
    const double t = static_cast<double>(k) * series.period_s;
    const auto& modes = oscillations.at(k);
    double model = p[0];
    row[0] = 1;
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const auto m = static_cast<Index>(1 + 4 * i);
      const double cosine = modes[i].real();
      const double sine = modes[i].imag();
      const double value = p[m + 2] * cosine + p[m + 3] * sine;
      model += value;
      row[m] = linear_only ? 0 : -t * value;
      row[m + 1] = linear_only ? 0 : t * (p[m + 3] * cosine - p[m + 2] * sine);
      row[m + 2] = cosine;
      row[m + 3] = sine;
    }
    const double error = series.values[k] - model;
    add_outer_product(normal.matrix, row);
    normal.right += error * row;
    normal.sum_of_squares += error * error;
  }
  normal.matrix = MatrixXd(normal.matrix.selfadjointView<Eigen::Lower>());
  return normal;
}

/// One damped step; the damping is relative to each parameter's own curvature.
VectorXd step_of(const Normal& normal, double damping) {
  MatrixXd matrix = normal.matrix;
  const VectorXd scale = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt();
  matrix = scale.cwiseInverse().asDiagonal() * matrix * scale.cwiseInverse().asDiagonal();
  for (Index i = 0; i < matrix.rows(); ++i) {
    matrix(i, i) = 1 + damping;
  }
  const VectorXd right = normal.right.cwiseQuotient(scale);
  return matrix.ldlt().solve(right).cwiseQuotient(scale);
}

bool oscillates(const std::complex<double>& pole, double period_s, std::size_t count) {
  const double length_s = period_s * static_cast<double>(count);
  return std::isfinite(pole.real()) && pole.imag() * length_s > 3 && pole.imag() * period_s < 3.1;
}

}  // namespace

SignalSpace::SignalSpace(const Series& series, std::size_t stride) : series_(series), stride_(stride) {
  const auto lag = static_cast<Index>(stride);
  const auto size = static_cast<Index>(series.values.size());
  const Index lags = std::min(kLags, size / (2 * lag));
  if (lags < 2) {
    return;
  }
  const Index rows = size - (lags - 1) * lag;
  const double mean = mean_of(series.values);
  const auto value = [&](Index k) { return series.values[static_cast<std::size_t>(k)] - mean; };
  // Sums of products of two windows; one further along the diagonal differs at its ends alone.
  MatrixXd gram = MatrixXd::Zero(lags, lags);
  for (Index j = 0; j < lags; ++j) {
    double sum = 0;
    for (Index k = 0; k < rows; ++k) {
      sum += value(k) * value(k + j * lag);
    }
    gram(j, 0) = sum;
    for (Index i = 1; i + j < lags; ++i) {
      for (Index k = (i - 1) * lag; k < i * lag; ++k) {
        sum += value(k + rows) * value(k + rows + j * lag) - value(k) * value(k + j * lag);
      }
      gram(i + j, i) = sum;
    }
  }
  vectors_ = Eigen::SelfAdjointEigenSolver<MatrixXd>(gram).eigenvectors();
}

std::vector<std::complex<double>> SignalSpace::poles(std::size_t count) const {
  const Index lags = vectors_.cols();
  const auto order = static_cast<Index>(2 * count + 1);  // one for the offset
  if (lags < order + 2) {
    return {};
  }
  const MatrixXd space = vectors_.rightCols(order);
  const MatrixXd upper = space.topRows(lags - 1);
  const MatrixXd shift = (upper.transpose() * upper).ldlt().solve(upper.transpose() * space.bottomRows(lags - 1));
  const Eigen::EigenSolver<MatrixXd> turns(shift, false);
  std::vector<std::complex<double>> poles;
  const double lag_s = series_.period_s * static_cast<double>(stride_);
  for (Index i = 0; i < order; ++i) {
    const std::complex<double> pole = std::log(turns.eigenvalues()[i]) / lag_s;
    if (oscillates(pole, series_.period_s, series_.values.size())) {
      poles.emplace_back(std::min(pole.real(), -1e-3 * pole.imag()), pole.imag());
    }
  }
  std::sort(poles.begin(), poles.end(), [](const auto& a, const auto& b) { return a.imag() < b.imag(); });
  return poles;
}

namespace {

/// The parameters with these poles, offset and amplitudes by least squares.
VectorXd parameters_of(const Series& series, const std::vector<std::complex<double>>& poles) {
  VectorXd p = VectorXd::Zero(1 + 4 * static_cast<Index>(poles.size()));
  for (std::size_t m = 0; m < poles.size(); ++m) {
    p[1 + 4 * static_cast<Index>(m)] = -poles[m].real();
    p[2 + 4 * static_cast<Index>(m)] = poles[m].imag();
  }
  p += step_of(normal_equations(series, p, true), 1e-14);
  return p;
}

/// Empty where the parameters cannot be told from each other.
MatrixXd covariance_of(const Normal& normal, double variance) {
  const VectorXd scale = normal.matrix.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const MatrixXd even = scale.cwiseInverse().asDiagonal() * normal.matrix * scale.cwiseInverse().asDiagonal();
  const Eigen::LDLT<MatrixXd> inverse(even);
  if (inverse.info() != Eigen::Success || !(inverse.vectorD().minCoeff() > 1e-13)) {
    return {};
  }
  const MatrixXd identity = MatrixXd::Identity(even.rows(), even.cols());
  return variance * (scale.cwiseInverse().asDiagonal() * inverse.solve(identity) * scale.cwiseInverse().asDiagonal());
}

}  // namespace

MatrixXd covariance_at(const Series& series, const VectorXd& p, double variance) {
  return covariance_of(normal_equations(series, p, false), variance);
}

double residual_correlation(const Series& series, const DampedFit& fit) {
  Oscillations oscillations(fit.parameters, series.period_s);
  double before = 0;
  double products = 0;
  double squares = 0;
  for (std::size_t k = 0; k < series.values.size(); ++k) {
    const auto& modes = oscillations.at(k);
    double left = series.values[k] - fit.parameters[0];
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const auto m = static_cast<Index>(1 + 4 * i);
      left -= fit.parameters[m + 2] * modes[i].real() + fit.parameters[m + 3] * modes[i].imag();
    }
    products += left * before;
    squares += left * left;
    before = left;
  }
  return squares > 0 ? products / squares : 0;
}

double misfit(const Series& series, const std::vector<std::complex<double>>& poles) {
  const double squares = normal_equations(series, parameters_of(series, poles), true).sum_of_squares;
  return std::isfinite(squares) ? squares : std::numeric_limits<double>::infinity();
}

DampedFit fit_damped(const Series& series, const std::vector<std::complex<double>>& poles) {
  DampedFit fit;
  VectorXd p = parameters_of(series, poles);
  Normal now = normal_equations(series, p, false);
  double damping = 1e-3;
  for (int step = 0; step < 60 && damping < 1e10; ++step) {
    const VectorXd change = step_of(now, damping);
    if (change.dot(now.right) <= 1e-13 * now.sum_of_squares) {
      break;  // even a straight slope would gain nothing
    }
    const VectorXd trial = p + change;
    const Normal next = trial.allFinite() ? normal_equations(series, trial, false) : now;
    if (trial.allFinite() && next.sum_of_squares < now.sum_of_squares) {
      const bool done = now.sum_of_squares - next.sum_of_squares < 1e-13 * now.sum_of_squares;
      p = trial;
      now = next;
      damping = std::max(1e-12, damping / 10);
      if (done) {
        break;
      }
    } else {
      damping *= 10;
    }
  }
  fit.parameters = p;
  fit.sum_of_squares = now.sum_of_squares;
  const double degrees = std::max(1.0, static_cast<double>(series.values.size()) - static_cast<double>(p.size()));
  fit.covariance = covariance_of(now, fit.sum_of_squares / degrees);
  fit.solved = p.allFinite() && fit.covariance.size() > 0;
  return fit;
}

}  // namespace gravure::motion
