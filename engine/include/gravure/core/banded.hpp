#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace gravure {

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

  /// Eliminates downwards in place, for solve_factored(). Positive definite matrices only.
  void factor() noexcept {
    for (std::size_t i = 0; i < size(); ++i) {
      const double pivot = rows_[i][0];
      for (std::size_t k = 1; k <= kBand && i + k < size(); ++k) {
        const double share = rows_[i][k] / pivot;
        for (std::size_t l = k; l <= kBand && i + l < size(); ++l) {
          rows_[i + k][l - k] -= share * rows_[i][l];
        }
      }
    }
  }

  /// Solves in place of the right side (numbers, or vectors of them), after factor().
  template <class Value>
  void solve_factored(std::vector<Value>& right) const noexcept {
    for (std::size_t i = 0; i < size(); ++i) {
      const double pivot = rows_[i][0];
      for (std::size_t k = 1; k <= kBand && i + k < size(); ++k) {
        right[i + k] -= rows_[i][k] / pivot * right[i];
      }
    }
    for (std::size_t i = size(); i-- > 0;) {
      for (std::size_t k = 1; k <= kBand && i + k < size(); ++k) {
        right[i] -= rows_[i][k] * right[i + k];
      }
      right[i] /= rows_[i][0];
    }
  }

  /// Solves this * x = right in place of right, factoring over itself.
  void solve(std::vector<double>& right) noexcept {
    factor();
    solve_factored(right);
  }

 private:
  std::vector<std::array<double, kBand + 1>> rows_;
};

}  // namespace gravure
