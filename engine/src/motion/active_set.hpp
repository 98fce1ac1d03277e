#pragma once

#include <vector>

#include "gravure/core/banded.hpp"

namespace gravure::motion {

/// Least squares of all control points, rising: B'B c = B'a.
struct MonotoneProblem {
  Banded gram;
  std::vector<double> right;
  std::vector<bool> fixed;
  std::vector<double> held;  ///< values of the fixed ones
};

struct MonotoneSolution {
  std::vector<double> control_points;
  bool optimal =
      true;  ///< false where the descent was ended before nothing pulled any more; it is monotone all the same
};

/// The least squares, `constrained` to control points that do not fall.
MonotoneSolution solve_monotone(const MonotoneProblem& problem, bool constrained);

}  // namespace gravure::motion
