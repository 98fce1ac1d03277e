#include "active_set.hpp"

#include <algorithm>
#include <cmath>

namespace gravure::motion {
namespace {

/// Active constraints merge control points into blocks of one value.
class ActiveSet {
 public:
  explicit ActiveSet(const MonotoneProblem& problem)
      : p_(problem), n_(problem.right.size()), active_(n_ - 1, false), solves_left_(200 + 400'000 / n_) {
    for (std::size_t i = 0; i + 1 < n_; ++i) {
      active_[i] = p_.fixed[i] && p_.fixed[i + 1] && p_.held[i] == p_.held[i + 1];
    }
  }

  /// Exchanges all violated constraints at a time, which mostly ends in a few rounds; where it does not, a descent that
  /// stays feasible and so cannot cycle.
  std::vector<double> run(bool constrained) {
    std::vector<double> c = solve();
    for (int round = 0; constrained && round < 30; ++round) {
      const std::vector<std::size_t> wrong = violated(c);
      if (wrong.empty()) {
        return c;
      }
      for (const std::size_t i : wrong) {
        active_[i] = !active_[i];
      }
      c = solve();
    }
    return constrained ? descend_from(feasible_start()) : c;
  }

  /// False where the descent was ended before nothing pulled any more; the result is monotone all the same.
  bool optimal() const noexcept { return solves_left_ > 0; }

 private:
  bool both_fixed(std::size_t i) const { return p_.fixed[i] && p_.fixed[i + 1]; }

  /// Holds whatever falls until nothing does.
  std::vector<double> feasible_start() {
    while (true) {
      std::vector<double> c = solve();
      bool fell = false;
      for (std::size_t i = 0; i + 1 < n_; ++i) {
        if (!active_[i] && !both_fixed(i) && c[i + 1] < c[i]) {
          active_[i] = fell = true;
        }
      }
      if (!fell) {
        return c;
      }
    }
  }

  /// Releases constraints that hold the cost up, all at once or, when that gained nothing, the strongest alone.
  std::vector<double> descend_from(std::vector<double> c) {
    bool one_at_a_time = false;
    while (solves_left_ > 0) {
      const std::vector<double> pull = multipliers(gradient_at(c));
      std::vector<std::size_t> held;
      for (std::size_t i = 0; i + 1 < n_; ++i) {
        if (active_[i] && !both_fixed(i) && pull[i] < -tolerance()) {
          held.push_back(i);
        }
      }
      if (held.empty()) {
        break;
      }
      if (one_at_a_time) {
        held = {*std::min_element(held.begin(), held.end(),
                                  [&](std::size_t i, std::size_t j) { return pull[i] < pull[j]; })};
      }
      for (const std::size_t i : held) {
        active_[i] = false;
      }
      std::vector<double> next = walk_down(c);
      const bool gained = cost(next) < cost(c) - 1e-14 * std::abs(cost(c));
      if (gained) {
        c = std::move(next);
      }
      if (!gained && one_at_a_time) {
        break;
      }
      one_at_a_time = !gained;
    }
    return c;
  }

  /// Towards the optimum of the free blocks, holding each step that would begin to fall on the way.
  std::vector<double> walk_down(std::vector<double> c) {
    while (true) {
      std::vector<double> target = solve();
      solves_left_ -= solves_left_ > 0 ? 1 : 0;
      double share = 1;
      std::size_t first = n_;
      for (std::size_t i = 0; i + 1 < n_; ++i) {
        const double rise = std::max(0.0, c[i + 1] - c[i]);
        const double wanted = target[i + 1] - target[i];
        if (!active_[i] && !both_fixed(i) && wanted < 0 && rise / (rise - wanted) < share) {
          share = rise / (rise - wanted);
          first = i;
        }
      }
      for (std::size_t i = 0; i < n_; ++i) {
        c[i] += share * (target[i] - c[i]);
      }
      if (first == n_) {
        return target;
      }
      if (solves_left_ == 0) {
        return c;
      }
      for (std::size_t i = 0; i + 1 < n_; ++i) {
        const bool flat = c[i + 1] - c[i] <= 1e-15 * std::abs(c[i]) && target[i + 1] < target[i];
        active_[i] = active_[i] || i == first || (flat && !both_fixed(i));
      }
    }
  }

  double cost(const std::vector<double>& c) const {
    const std::vector<double> product = p_.gram.times(c);
    double sum = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      sum += c[i] * (product[i] / 2 - p_.right[i]);
    }
    return sum;
  }

  std::vector<double> gradient_at(const std::vector<double>& c) const {
    std::vector<double> gradient = p_.gram.times(c);
    for (std::size_t i = 0; i < n_; ++i) {
      gradient[i] -= p_.right[i];
    }
    return gradient;
  }

  /// Below this a multiplier is rounding.
  double tolerance() const {
    double scale = 0;
    for (const double value : p_.right) {
      scale = std::max(scale, std::abs(value));
    }
    return 1e-12 * scale;
  }

  /// Block of each control point; a block with a fixed one takes its value.
  std::vector<double> solve() const {
    std::vector<std::size_t> block(n_, 0);
    for (std::size_t i = 1; i < n_; ++i) {
      block[i] = block[i - 1] + (active_[i - 1] ? 0 : 1);
    }
    const std::size_t blocks = block.back() + 1;
    std::vector<double> value(blocks, 0);
    std::vector<bool> known(blocks, false);
    for (std::size_t i = 0; i < n_; ++i) {
      if (p_.fixed[i]) {
        known[block[i]] = true;
        value[block[i]] = p_.held[i];
      }
    }
    Banded matrix(blocks);
    std::vector<double> right(blocks, 0);
    const auto add = [&](std::size_t i, std::size_t j, double entry) {
      const std::size_t a = block[i];
      const std::size_t b = block[j];
      if (known[a]) {
        return;
      }
      if (known[b]) {
        right[a] -= entry * value[b];
      } else if (a <= b) {
        matrix.at(a, b - a) += entry;
      }
    };
    for (std::size_t i = 0; i < n_; ++i) {
      right[block[i]] += known[block[i]] ? 0 : p_.right[i];
      add(i, i, p_.gram.at(i, 0));
      for (std::size_t k = 1; k <= Banded::kBand && i + k < n_; ++k) {
        add(i, i + k, p_.gram.at(i, k));
        add(i + k, i, p_.gram.at(i, k));
      }
    }
    for (std::size_t b = 0; b < blocks; ++b) {
      if (known[b]) {
        matrix.at(b, 0) = 1;
        right[b] = value[b];
      }
    }
    matrix.solve(right);
    std::vector<double> c(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      c[i] = p_.fixed[i] ? p_.held[i] : right[block[i]];
    }
    return c;
  }

  /// Falling steps that are free, and flat ones that would rather rise (negative multiplier).
  std::vector<std::size_t> violated(const std::vector<double>& c) const {
    const std::vector<double> multiplier = multipliers(gradient_at(c));
    const double least = -tolerance();
    const double span = std::max(std::abs(c.front()), std::abs(c.back()));
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i + 1 < n_; ++i) {
      if (!both_fixed(i) && (active_[i] ? multiplier[i] < least : c[i + 1] - c[i] < -1e-14 * span)) {
        wrong.push_back(i);
      }
    }
    return wrong;
  }

  /// Of the active constraints, from sums of the gradient inside each block; a fixed control point takes any force, so
  /// the sums start at the free side of its block.
  std::vector<double> multipliers(const std::vector<double>& gradient) const {
    std::vector<double> multiplier(n_ - 1, 0);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < n_; ++i) {
      sum = active_[i] ? sum - gradient[i] : 0;
      multiplier[i] = sum;
    }
    for (std::size_t head = 0; head < n_ && p_.fixed[head] && head + 1 < n_; ++head) {
      std::size_t last = head;
      while (last + 1 < n_ && active_[last]) {
        ++last;
      }
      sum = 0;
      for (std::size_t i = last; i > head; --i) {
        sum += gradient[i];
        multiplier[i - 1] = sum;
      }
    }
    return multiplier;
  }

  const MonotoneProblem& p_;
  std::size_t n_;
  std::vector<bool> active_;
  std::size_t solves_left_;  ///< for the descent; it gains less and less
};

}  // namespace

MonotoneSolution solve_monotone(const MonotoneProblem& problem, bool constrained) {
  ActiveSet solver(problem);
  MonotoneSolution solution;
  solution.control_points = solver.run(constrained);
  solution.optimal = solver.optimal();
  return solution;
}

}  // namespace gravure::motion
