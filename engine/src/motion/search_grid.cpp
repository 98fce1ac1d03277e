#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check_request.hpp"
#include "gravure/motion/search.hpp"
#include "residual_kernel.hpp"
#include "search_problem.hpp"

namespace gravure::motion {
namespace {

/// Feasibility is decided with this much room in seconds: grids put points exactly on the border (tj = V/A).
constexpr double kBorderRoom_s = 1e-15;

class GridWalk {
 public:
  GridWalk(const SearchProblem& problem, const SearchGrid& grid, double mark_s)
      : problem_(problem), grid_(grid), mark_s_(mark_s), kernel_(problem.modes, problem.band.of) {
    for (std::size_t s = 0; s < grid_.s_factor.count(); ++s) {
      jerk_turns_.push_back(kernel_.turns(jerk_time_s(s)));
    }
  }

  GridSearch run(bool asymmetric) {
    result_.best.positioning_time_s = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < grid_.v_mm_s.count(); ++v) {
      const double velocity = grid_.v_mm_s.at(v);
      if (velocity <= problem_.v_max_mm_s) {
        walk_velocity(velocity, asymmetric);
      }
    }
    return result_;
  }

 private:
  double jerk_time_s(std::size_t s) const noexcept { return grid_.s_factor.at(s) * problem_.update_us * 1e-6; }

  void walk_velocity(double velocity, bool asymmetric) {
    ramp_turns_.clear();
    const std::size_t count = grid_.a_mm_s2.count();
    for (std::size_t a = 0; a < count; ++a) {
      ramp_turns_.push_back(kernel_.turns(velocity / grid_.a_mm_s2.at(a)));
    }
    for (std::size_t up = 0; up < count; ++up) {
      for (std::size_t down = asymmetric ? 0 : up; down < (asymmetric ? count : up + 1); ++down) {
        walk_jerk_times(velocity, up, down);
      }
    }
  }

  void walk_jerk_times(double velocity, std::size_t up, std::size_t down) {
    const double a_up = grid_.a_mm_s2.at(up);
    const double a_down = grid_.a_mm_s2.at(down);
    if (a_up > problem_.a_up_max_mm_s2 || a_down > problem_.a_down_max_mm_s2) {
      return;
    }
    Durations d{0, velocity / a_up, velocity / a_down, 0};
    const double room_s = std::abs(problem_.stroke_mm) / velocity - (d.up_s + d.down_s) / 2;
    const double longest_s = std::min({d.up_s, d.down_s, room_s}) + kBorderRoom_s;
    for (std::size_t s = 0; s < jerk_turns_.size(); ++s) {
      d.jerk_s = jerk_time_s(s);
      if (d.jerk_s > longest_s) {
        break;
      }
      if (std::max(a_up, a_down) <= problem_.jerk_max_mm_s3 * d.jerk_s) {
        d.cruise_s = std::max(0.0, room_s - d.jerk_s);
        consider(d, velocity, s, up, down);
      }
    }
  }

  void consider(const Durations& d, double velocity, std::size_t s, std::size_t up, std::size_t down) {
    ++result_.evaluated;
    const double access_s = d.access_time_s();
    // Only what beats the best or the mark needs its time; the others need the proof that they do not.
    const double interesting_s = std::max(result_.best.positioning_time_s, mark_s_);
    if (access_s >= interesting_s) {
      return;
    }
    const ResidualSignal signal =
        kernel_.residual(jerk_turns_[s], ramp_turns_[up], ramp_turns_[down], kernel_.turns(d.cruise_s), d, velocity);
    const double tolerance = problem_.band.tolerance;
    if (interesting_s < std::numeric_limits<double>::infinity() &&
        std::abs(signal.at(interesting_s - access_s)) > tolerance) {
      return;
    }
    const double time_s = access_s + signal.last_exit_s(tolerance);
    result_.below_mark += time_s < mark_s_ ? 1 : 0;
    if (time_s < result_.best.positioning_time_s) {
      result_.best = {velocity, grid_.a_mm_s2.at(up), grid_.a_mm_s2.at(down), grid_.s_factor.at(s), access_s, time_s};
    }
  }

  const SearchProblem& problem_;
  const SearchGrid& grid_;
  double mark_s_;
  ResidualKernel kernel_;
  std::vector<Turns> jerk_turns_;
  std::vector<Turns> ramp_turns_;
  GridSearch result_;
};

Result<void> check_axis(std::string_view name, const GridAxis& axis, double least) {
  if (axis.first >= least && axis.last >= axis.first && axis.step > 0 && axis.last <= 1e21) {
    return {};
  }
  return Error{
      ErrorCode::out_of_range,
      fmt::format("motion: search grid: {} from {} to {} in steps of {}: must start at {} or more, rise and have a "
                  "step above 0",
                  name, axis.first, axis.last, axis.step, least)};
}

}  // namespace

std::size_t GridAxis::count() const noexcept {
  return static_cast<std::size_t>(std::min(1e9, std::floor((last - first) / step + 1e-9))) + 1;
}

Result<void> check_problem(const SearchProblem& problem) {
  if (problem.stroke_mm != 0 && !(std::abs(problem.stroke_mm) >= 1e-12 && std::abs(problem.stroke_mm) <= 1e15)) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("motion: stroke_mm = {}: must be 0, or from 1e-12 to 1e+15 either way", problem.stroke_mm)};
  }
  GRAVURE_CHECK(check_range("v_max_mm_s", problem.v_max_mm_s, 1e-12, 1e21));
  GRAVURE_CHECK(check_range("a_up_max_mm_s2", problem.a_up_max_mm_s2, 1e-12, 1e21));
  GRAVURE_CHECK(check_range("a_down_max_mm_s2", problem.a_down_max_mm_s2, 1e-12, 1e21));
  // A jerk segment up to the acceleration limit lasts no longer than the S factor can say.
  const double steepest = std::max(problem.a_up_max_mm_s2, problem.a_down_max_mm_s2);
  GRAVURE_CHECK(check_range("update_us", problem.update_us, 1e-3, 1e9));
  GRAVURE_CHECK(check_range("jerk_max_mm_s3", problem.jerk_max_mm_s3,
                            std::max(1e-12, steepest / (kMostSFactor * problem.update_us * 1e-6)), 1e21));
  GRAVURE_CHECK(check_range("mode_error_percent", problem.mode_error_percent, 0, 50));
  GRAVURE_CHECK(check_range("band tolerance", problem.band.tolerance, 1e-300, 1e300));
  return check_modes(problem.modes);
}

Result<GridSearch> search_grid(const SearchProblem& problem, const SearchGrid& grid, bool asymmetric, double mark_s) {
  GRAVURE_CHECK(check_problem(problem));
  GRAVURE_CHECK(check_axis("v_mm_s", grid.v_mm_s, 1e-12));
  GRAVURE_CHECK(check_axis("a_mm_s2", grid.a_mm_s2, 1e-12));
  GRAVURE_CHECK(check_axis("s_factor", grid.s_factor, 0));
  const auto a_count = static_cast<double>(grid.a_mm_s2.count());
  const double points = static_cast<double>(grid.v_mm_s.count()) * static_cast<double>(grid.s_factor.count()) *
                        a_count * (asymmetric ? a_count : 1);
  GRAVURE_CHECK(check_range("search grid points", points, 1, 1e9));
  GRAVURE_CHECK(check_range("search grid s_factor points", static_cast<double>(grid.s_factor.count()), 1, 1e6));
  const GridSearch found = GridWalk(problem, grid, mark_s).run(asymmetric);
  if (found.evaluated == 0) {
    return Error{ErrorCode::bad_argument,
                 "motion: search grid: no point is feasible for this stroke under these limits"};
  }
  return found;
}

}  // namespace gravure::motion
