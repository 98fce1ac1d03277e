#pragma once

#include <algorithm>
#include <vector>

#include "gravure/motion/plan_profile.hpp"
#include "gravure/motion/search.hpp"
#include "motion_test_support.hpp"

namespace gravure::motion::test {

/// A random move with random modes, in a band that it leaves by up to a few hundred times.
struct ErringMove {
  SearchProblem problem;
  std::vector<InputJump> input;
};

inline ErringMove random_erring_move(Random& random, std::size_t mode_count) {
  ErringMove move;
  const double v = random.log_between(20, 500);
  const double a = random.log_between(1000, 30000);
  const double stroke = random.log_between(0.5, 50);
  const double s_factor = random.uniform() < 0.2 ? 0 : random.between(0, 100);
  move.input = input_of(
      plan_profile(SFactorRequest{{stroke, v, a, a * random.log_between(0.5, 2), 0, 0}, s_factor, 250}).value());
  move.problem = {stroke, v, a, a, 1e21, 250, {}, {}, random.log_between(0.5, 10)};
  for (std::size_t i = 0; i < mode_count; ++i) {
    move.problem.modes.push_back({random.log_between(10, 120), random.log_between(0.005, 0.5), random.between(-1, 1)});
  }
  const BandOf of = random.uniform() < 0.5 ? BandOf::acceleration : BandOf::position;
  const double size = residual_of(move.problem.modes, move.input, of).envelope(0);
  move.problem.band = {of, size * random.log_between(0.003, 1.2) + 1e-300};
  return move;
}

/// `from` to `to` in `steps`, ends included.
inline double level(double from, double to, int index, int steps) {
  return from + (to - from) * index / steps;
}

}  // namespace gravure::motion::test
