#include "move_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gravure::motion {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr std::size_t kMaxCornerModes = 3;

/// Modes with the errors of corner `bits`: two bits a mode, frequency and damping.
std::vector<Mode> corner_of(const SearchProblem& problem, std::size_t bits) {
  std::vector<Mode> modes = problem.modes;
  const double error = problem.mode_error_percent / 100;
  for (std::size_t i = 0; i < std::min(modes.size(), kMaxCornerModes); ++i) {
    modes[i].f_hz *= (bits >> (2 * i) & 1) != 0 ? 1 + error : 1 - error;
    modes[i].zeta = std::min(0.999, modes[i].zeta * ((bits >> (2 * i + 1) & 1) != 0 ? 1 + error : 1 - error));
  }
  return modes;
}

}  // namespace

MoveSpace::MoveSpace(const SearchProblem& problem) : problem_(problem), kernel_(problem.modes, problem.band.of) {
  const std::size_t corners = std::size_t{1} << (2 * std::min(problem.modes.size(), kMaxCornerModes));
  for (std::size_t bits = 0; bits < corners; ++bits) {
    corners_.emplace_back(corner_of(problem, bits), problem.band.of);
  }
}

MoveSpace::Move MoveSpace::move_at(const MovePoint& x) const noexcept {
  Durations d{x[0] * x[0], 0, 0, x[3] * x[3]};
  d.up_s = d.jerk_s + x[1] * x[1];
  d.down_s = d.jerk_s + x[2] * x[2];
  const double velocity = problem_.stroke_mm / d.stroke_over_velocity_s();
  const double steepest = velocity / std::min(d.up_s, d.down_s);
  double slower = std::max({1.0, velocity / problem_.v_max_mm_s, std::sqrt(velocity / d.up_s / problem_.a_up_max_mm_s2),
                            std::sqrt(velocity / d.down_s / problem_.a_down_max_mm_s2)});
  if (problem_.jerk_max_mm_s3 < 1e21) {
    slower = std::max(slower, std::cbrt(steepest / d.jerk_s / problem_.jerk_max_mm_s3));
  }
  if (!(slower < 1e100)) {
    return {{0, 1, 1, kEndless}, 0};
  }
  return {{d.jerk_s * slower, d.up_s * slower, d.down_s * slower, d.cruise_s * slower}, velocity / slower};
}

MovePoint MoveSpace::point_of(const Durations& d) noexcept {
  const auto root = [](double value) { return std::sqrt(std::max(0.0, value)); };
  return {root(d.jerk_s), root(d.up_s - d.jerk_s), root(d.down_s - d.jerk_s), root(d.cruise_s)};
}

Durations MoveSpace::durations_of(const Candidate& c) const noexcept {
  Durations d{c.s_factor * problem_.update_us * 1e-6, c.v_mm_s / c.a_up_mm_s2, c.v_mm_s / c.a_down_mm_s2, 0};
  d.cruise_s = std::max(0.0, problem_.stroke_mm / c.v_mm_s - d.stroke_over_velocity_s());
  return d;
}

Candidate MoveSpace::candidate_at(const MovePoint& point) const noexcept {
  const Move move = move_at(point);
  const Durations& d = move.durations;
  Candidate c{
      move.velocity,     move.velocity / d.up_s,       move.velocity / d.down_s, d.jerk_s / (problem_.update_us * 1e-6),
      d.access_time_s(), cost(kernel_, move, kEndless)};
  // Rounding must not carry a limit's own value over the limit.
  c.v_mm_s = std::min(c.v_mm_s, problem_.v_max_mm_s);
  c.a_up_mm_s2 = std::min(c.a_up_mm_s2, problem_.a_up_max_mm_s2);
  c.a_down_mm_s2 = std::min(c.a_down_mm_s2, problem_.a_down_max_mm_s2);
  c.s_factor = std::max(c.s_factor, least_s_factor(problem_, std::max(c.a_up_mm_s2, c.a_down_mm_s2)));
  return c;
}

double least_s_factor(const SearchProblem& problem, double a_mm_s2) noexcept {
  if (problem.jerk_max_mm_s3 >= 1e21) {
    return 0;
  }
  double s_factor = a_mm_s2 / problem.jerk_max_mm_s3 / (problem.update_us * 1e-6);
  while (a_mm_s2 / (s_factor * problem.update_us * 1e-6) > problem.jerk_max_mm_s3) {
    s_factor = std::nextafter(s_factor, kEndless);
  }
  return s_factor;
}

void MoveSpace::also_under(const std::vector<Mode>& modes) {
  corners_.emplace_back(modes, problem_.band.of);
}

double MoveSpace::cost(const ResidualKernel& kernel, const Move& move, double cutoff) const noexcept {
  ++evaluated_;
  const double access_s = move.durations.access_time_s();
  if (!(access_s < std::min(cutoff, 1e100))) {
    return kEndless;
  }
  const double tolerance = problem_.band.tolerance * (1 - 1e-6);
  const ResidualSignal signal = kernel.residual(move.durations, move.velocity);
  if (cutoff < 1e100 && std::abs(signal.at(cutoff - access_s)) > tolerance) {
    return kEndless;
  }
  return access_s + signal.last_exit_s(tolerance);
}

double MoveSpace::exact_cost(const MovePoint& point, double cutoff) const noexcept {
  return cost(kernel_, move_at(point), cutoff);
}

double MoveSpace::worst_cost(const MovePoint& point, double cutoff) const noexcept {
  const Move move = move_at(point);
  double worst = cost(kernel_, move, cutoff);
  for (std::size_t i = 0; i < corners_.size() && worst < cutoff; ++i) {
    worst = std::max(worst, cost(corners_[i], move, cutoff));
    if (worst >= cutoff) {
      std::swap(corners_[i], corners_[i / 2]);  // what refuses one point is likely to refuse the next
    }
  }
  return worst < cutoff ? worst : kEndless;
}

}  // namespace gravure::motion
