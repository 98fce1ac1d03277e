#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "residual_kernel.hpp"
#include "search_problem.hpp"

namespace gravure::motion {

/// A move as four free numbers: the square roots of tj, V/Au - tj, V/Ad - tj and the cruise. Every point of this space
/// is a feasible move once it is slowed down as a whole to meet the limits, so a descent never leaves it.
using MovePoint = std::array<double, 4>;

/// Positioning times in that space.
class MoveSpace {
 public:
  explicit MoveSpace(const SearchProblem& problem);

  /// Slowed down to the limits; `velocity` of it. An access time of infinity where no slowing down helps.
  struct Move {
    Durations durations;
    double velocity = 0;
  };
  Move move_at(const MovePoint& point) const noexcept;
  static MovePoint point_of(const Durations& durations) noexcept;
  Durations durations_of(const Candidate& candidate) const noexcept;
  Candidate candidate_at(const MovePoint& point) const noexcept;

  /// For the modes as given, with the band a millionth narrower: an optimum whose peak touches the band must still hold
  /// when the profile is planned again from its parameters.
  /// Infinite where it can be seen at a glance that it is not below `cutoff`.
  double exact_cost(const MovePoint& point, double cutoff) const noexcept;
  /// The longest over the modes as given, every corner of their errors, and the errors added since.
  double worst_cost(const MovePoint& point, double cutoff) const noexcept;
  void also_under(const std::vector<Mode>& modes);
  std::uint64_t evaluated() const noexcept { return evaluated_; }

 private:
  double cost(const ResidualKernel& kernel, const Move& move, double cutoff) const noexcept;
  const SearchProblem& problem_;
  ResidualKernel kernel_;
  mutable std::vector<ResidualKernel> corners_;  ///< in any order
  mutable std::uint64_t evaluated_ = 0;
};

/// The S factor at which an acceleration just keeps the jerk limit; 0 without such a limit.
double least_s_factor(const SearchProblem& problem, double a_mm_s2) noexcept;

}  // namespace gravure::motion
