#include "damped_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

/// `linear_only`: derivatives to s and w are left out, so that the step solves offset, A and B.
Normal normal_equations(const Series& series, const VectorXd& p, bool linear_only) {
  const Index size = p.size();
  Normal normal{MatrixXd::Zero(size, size), VectorXd::Zero(size), 0};
  VectorXd row(size);
  for (std::size_t k = 0; k < series.values.size(); ++k) {
    const double t = static_cast<double>(k) * series.period_s;
    double model = p[0];
    row[0] = 1;
    for (Index m = 1; m < size; m += 4) {
      const double decay = std::exp(-p[m] * t);
      const double cosine = decay * std::cos(p[m + 1] * t);
      const double sine = decay * std::sin(p[m + 1] * t);
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

std::vector<std::complex<double>> estimate_poles(const Series& series, std::size_t count, std::size_t stride) {
  const auto lag = static_cast<Index>(stride);
  const auto size = static_cast<Index>(series.values.size());
  const Index lags = std::min(kLags, size / (2 * lag));
  const auto order = static_cast<Index>(2 * count + 1);  // one for the offset
  if (lags < order + 2) {
    return {};
  }
  const Index rows = size - (lags - 1) * lag;
  const double mean = mean_of(series.values);
  MatrixXd gram = MatrixXd::Zero(lags, lags);
  VectorXd window(lags);
  for (Index k = 0; k < rows; ++k) {
    for (Index i = 0; i < lags; ++i) {
      window[i] = series.values[static_cast<std::size_t>(k + i * lag)] - mean;
    }
    add_outer_product(gram, window);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(gram);
  const MatrixXd space = spectrum.eigenvectors().rightCols(order);
  const MatrixXd upper = space.topRows(lags - 1);
  const MatrixXd shift = (upper.transpose() * upper).ldlt().solve(upper.transpose() * space.bottomRows(lags - 1));
  const Eigen::EigenSolver<MatrixXd> turns(shift, false);
  std::vector<std::complex<double>> poles;
  const double lag_s = series.period_s * static_cast<double>(stride);
  for (Index i = 0; i < order; ++i) {
    const std::complex<double> pole = std::log(turns.eigenvalues()[i]) / lag_s;
    if (oscillates(pole, series.period_s, series.values.size())) {
      poles.emplace_back(std::min(pole.real(), -1e-3 * pole.imag()), pole.imag());
    }
  }
  std::sort(poles.begin(), poles.end(), [](const auto& a, const auto& b) { return a.imag() < b.imag(); });
  return poles;
}

DampedFit fit_damped(const Series& series, const std::vector<std::complex<double>>& poles) {
  DampedFit fit;
  VectorXd p = VectorXd::Zero(1 + 4 * static_cast<Index>(poles.size()));
  for (std::size_t m = 0; m < poles.size(); ++m) {
    p[1 + 4 * static_cast<Index>(m)] = -poles[m].real();
    p[2 + 4 * static_cast<Index>(m)] = poles[m].imag();
  }
  p += step_of(normal_equations(series, p, true), 1e-14);
  Normal now = normal_equations(series, p, false);
  double damping = 1e-3;
  for (int step = 0; step < 60 && damping < 1e10; ++step) {
    const VectorXd trial = p + step_of(now, damping);
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
  const VectorXd scale = now.matrix.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const MatrixXd even = scale.cwiseInverse().asDiagonal() * now.matrix * scale.cwiseInverse().asDiagonal();
  const Eigen::LDLT<MatrixXd> inverse(even);
  fit.solved = p.allFinite() && inverse.info() == Eigen::Success && inverse.vectorD().minCoeff() > 1e-13;
  if (fit.solved) {
    const double degrees = std::max(1.0, static_cast<double>(series.values.size()) - static_cast<double>(p.size()));
    fit.covariance = scale.cwiseInverse().asDiagonal() * inverse.solve(MatrixXd::Identity(p.size(), p.size())) *
                     scale.cwiseInverse().asDiagonal();
    fit.covariance *= fit.sum_of_squares / degrees;
  }
  return fit;
}

}  // namespace gravure::motion
