#include "gravure/motion/monotone_spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "active_set.hpp"

namespace gravure::motion {
namespace {

/// Knot span of `x` in spans (0 .. spans), and the four basis functions there (Cox-de Boor on clamped even knots).
struct Basis {
  std::size_t span = 0;  ///< first of the four control points
  std::array<double, 4> weight{};
};

Basis basis_at(double x, std::size_t spans) noexcept {
  Basis basis;
  const auto last = static_cast<double>(spans - 1);
  basis.span = static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, last));
  const auto knot = [spans](std::ptrdiff_t i) {
    return static_cast<double>(std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(spans)));
  };
  const auto s = static_cast<std::ptrdiff_t>(basis.span);
  basis.weight = {1, 0, 0, 0};
  for (std::ptrdiff_t degree = 1; degree <= 3; ++degree) {
    double saved = 0;
    for (std::ptrdiff_t r = 0; r < degree; ++r) {
      const double right = knot(s + r + 1) - x;
      const double left = x - knot(s + 1 - degree + r);
      auto& weight = basis.weight[static_cast<std::size_t>(r)];
      const double part = weight / (right + left);
      weight = saved + right * part;
      saved = left * part;
    }
    basis.weight[static_cast<std::size_t>(degree)] = saved;
  }
  return basis;
}

double in_spans(double parameter, double from, double to, std::size_t spans) noexcept {
  return std::clamp((parameter - from) / (to - from), 0.0, 1.0) * static_cast<double>(spans);
}

std::size_t held_points(SplineEnd end) noexcept {
  return end == SplineEnd::free ? 0 : end == SplineEnd::anchored ? 1 : 3;
}

void hold_ends(const MonotoneFitRequest& r, double sign, MonotoneProblem& problem) {
  const std::size_t n = r.control_points;
  problem.fixed.assign(n, false);
  problem.held.assign(n, 0);
  for (std::size_t i = 0; i < held_points(r.start); ++i) {
    problem.fixed[i] = true;
    problem.held[i] = sign * r.value.front();
  }
  for (std::size_t i = 0; i < held_points(r.end); ++i) {
    problem.fixed[n - 1 - i] = true;
    problem.held[n - 1 - i] = sign * r.value.back();
  }
}

/// Second differences, where knot spans without values leave control points undecided.
void add_penalty(Banded& gram) {
  double trace = 0;
  for (std::size_t i = 0; i < gram.size(); ++i) {
    trace += gram.at(i, 0);
  }
  const double weight = 1e-9 * trace / static_cast<double>(gram.size());
  static constexpr std::array<double, 3> kStencil{1, -2, 1};
  for (std::size_t i = 0; i + 2 < gram.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = a; b < 3; ++b) {
        gram.at(i + a, b - a) += weight * kStencil[a] * kStencil[b];
      }
    }
  }
}

MonotoneProblem problem_of(const MonotoneFitRequest& r, double sign) {
  const std::size_t n = r.control_points;
  const std::size_t spans = n - 3;
  MonotoneProblem problem{Banded(n), std::vector<double>(n, 0), {}, {}};
  std::vector<bool> filled(spans, false);
  for (std::size_t k = 0; k < r.value.size(); ++k) {
    const Basis basis = basis_at(in_spans(r.parameter[k], r.parameter.front(), r.parameter.back(), spans), spans);
    filled[basis.span] = true;
    for (std::size_t a = 0; a < 4; ++a) {
      problem.right[basis.span + a] += basis.weight[a] * sign * r.value[k];
      for (std::size_t b = a; b < 4; ++b) {
        problem.gram.at(basis.span + a, b - a) += basis.weight[a] * basis.weight[b];
      }
    }
  }
  if (r.value.size() < 2 * n || std::find(filled.begin(), filled.end(), false) != filled.end()) {
    add_penalty(problem.gram);
  }
  hold_ends(r, sign, problem);
  return problem;
}

Result<void> check_fit_request(const MonotoneFitRequest& r) {
  const std::size_t least = std::max<std::size_t>(4, held_points(r.start) + held_points(r.end));
  if (r.control_points < least || r.control_points > 1'000'000) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("fit_monotone: control_points = {}: must be from {} to 1000000", r.control_points, least)};
  }
  if (r.value.size() < 2 || r.value.size() != r.parameter.size() || r.direction < -1 || r.direction > 1) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format(
            "fit_monotone: {} parameters, {} values, direction {}: at least 2 of each, and a direction of -1, 0 "
            "or 1 are needed",
            r.parameter.size(), r.value.size(), r.direction)};
  }
  for (std::size_t k = 0; k < r.value.size(); ++k) {
    if (!std::isfinite(r.value[k]) || !std::isfinite(r.parameter[k]) ||
        (k > 0 && !(r.parameter[k] > r.parameter[k - 1]))) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("fit_monotone: sample {}: parameter {} and value {} must be finite and parameters rise",
                               k + 1, r.parameter[k], r.value[k])};
    }
  }
  const bool both_held = r.start != SplineEnd::free && r.end != SplineEnd::free;
  if (both_held && r.direction * (r.value.back() - r.value.front()) < 0) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("fit_monotone: the held ends {} and {} lie against the direction {}", r.value.front(),
                             r.value.back(), r.direction)};
  }
  return {};
}

}  // namespace

double CubicSpline::at(double parameter) const noexcept {
  const std::size_t spans = control_points.size() - 3;
  const Basis basis = basis_at(in_spans(parameter, from, to, spans), spans);
  double value = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    value += basis.weight[a] * control_points[basis.span + a];
  }
  return value;
}

Result<MonotoneFit> fit_monotone(const MonotoneFitRequest& r) {
  GRAVURE_CHECK(check_fit_request(r));
  const double sign = r.direction < 0 ? -1 : 1;
  const MonotoneProblem problem = problem_of(r, sign);
  MonotoneSolution solution = solve_monotone(problem, r.direction != 0);
  std::vector<double>& c = solution.control_points;
  double before = c.front();
  for (double& point : c) {
    // Blocks are equal but for the last bit of the tolerance: make the promise exact.
    point = r.direction != 0 ? std::max(point, before) : point;
    before = point;
  }
  MonotoneFit fit{{r.parameter.front(), r.parameter.back(), std::move(c)}, 0, 0, solution.optimal};
  for (double& point : fit.spline.control_points) {
    point *= sign;
  }
  double squares = 0;
  for (std::size_t k = 0; k < r.value.size(); ++k) {
    const double off = std::abs(fit.spline.at(r.parameter[k]) - r.value[k]);
    squares += off * off;
    fit.largest = std::max(fit.largest, off);
  }
  fit.rms = std::sqrt(squares / static_cast<double>(r.value.size()));
  return fit;
}

}  // namespace gravure::motion
