#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace gravure::motion {

/// A symmetric matrix with three diagonals on each side, as cubic splines give; row i holds (i, i) to (i, i + 3).
class Banded {
 public:
  static constexpr std::size_t kBand = 3;
  explicit Banded(std::size_t size) : rows_(size) {}
  std::size_t size() const noexcept { return rows_.size(); }
  /// (i, i + offset), offset 0 to 3.
  double& at(std::size_t i, std::size_t offset) noexcept { return rows_[i][offset]; }
  double at(std::size_t i, std::size_t offset) const noexcept { return rows_[i][offset]; }

  /// this * x.
  std::vector<double> times(const std::vector<double>& x) const {
    std::vector<double> y(x.size(), 0.0);
    for (std::size_t i = 0; i < size(); ++i) {
      y[i] += rows_[i][0] * x[i];
      for (std::size_t k = 1; k <= kBand && i + k < size(); ++k) {
        y[i] += rows_[i][k] * x[i + k];
        y[i + k] += rows_[i][k] * x[i];
      }
    }
    return y;
  }

  /// Solves this * x = right in place of right, factoring L D L' over itself. Positive definite matrices only.
  void solve(std::vector<double>& right) noexcept {
    for (std::size_t i = 0; i < size(); ++i) {
      const double pivot = rows_[i][0];
      for (std::size_t k = 1; k <= kBand && i + k < size(); ++k) {
        const double factor = rows_[i][k] / pivot;
        for (std::size_t l = k; l <= kBand && i + l < size(); ++l) {
          rows_[i + k][l - k] -= factor * rows_[i][l];
        }
        right[i + k] -= factor * right[i];
      }
    }
    for (std::size_t i = size(); i-- > 0;) {
      for (std::size_t k = 1; k <= kBand && i + k < size(); ++k) {
        right[i] -= rows_[i][k] * right[i + k];
      }
      right[i] /= rows_[i][0];
    }
  }

 private:
  std::vector<std::array<double, kBand + 1>> rows_;
};

}  // namespace gravure::motion
