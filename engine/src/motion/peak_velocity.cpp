#include "peak_velocity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gravure::motion {
namespace {

/// Root of alpha w^2 + beta w = gamma >= 0 that is crossed upwards, without cancellation.
double rising_root(double alpha, double beta, double gamma) noexcept {
  const double root = std::sqrt(beta * beta + 4 * alpha * gamma);
  if (beta >= 0) {
    const double sum = beta + root;
    return sum > 0 ? 2 * gamma / sum : 0;
  }
  return alpha > 0 ? (root - beta) / (2 * alpha) : 0;
}

/// Distance of one ramp as a polynomial of the rise: constant + linear u + square u^2.
struct Quadratic {
  double constant = 0;
  double linear = 0;
  double square = 0;
};

/// `full`: the ramp reaches its acceleration limit. Not for jerk-limited ramps that do not.
Quadratic ramp_distance_polynomial(const RampLaw& law, double end, double top, bool full) noexcept {
  const double mean = (end + top) / 2;
  if (!full) {
    return {2 * law.jerk_time_s() * mean, law.jerk_time_s(), 0};
  }
  const double time = (top - end) / law.acceleration() + law.jerk_time_s();
  return {mean * time, time / 2 + mean / law.acceleration(), 0.5 / law.acceleration()};
}

/// Rises at which a ramp starts to reach its acceleration limit, in order; 0 where it always does.
struct Breaks {
  double low = 0;
  double high = 0;
};

double break_rise(const RampLaw& law, double end, double top) noexcept {
  return std::max(0.0, law.full_change() - (top - end));
}

Breaks breaks_of(const PeakProblem& p, double top) noexcept {
  const double first = break_rise(p.first, p.start_velocity, top);
  const double second = break_rise(p.second, p.end_velocity, top);
  return {std::min(first, second), std::max(first, second)};
}

/// Distance just above rise 0, where a ramp of fixed jerk time already takes 2 tj.
double distance_above(const PeakProblem& p, double rise) noexcept {
  const double top = higher_end(p);
  double distance = 0;
  for (const auto& [law, end] : {std::pair(&p.first, p.start_velocity), std::pair(&p.second, p.end_velocity)}) {
    const double change = top - end + rise;
    const double time = law->fixed() ? std::max(change / law->acceleration(), law->jerk_time_s()) + law->jerk_time_s()
                                     : law->duration_s(change);
    distance += (end + top + rise) / 2 * time;
  }
  return distance;
}

/// The rise inside [low, high], where both ramps keep their branch, by the quadratic.
double solve_piece(const PeakProblem& p, double low, double high, double gamma) noexcept {
  const double top = higher_end(p) + low;
  const bool first_full = low >= break_rise(p.first, p.start_velocity, higher_end(p));
  const bool second_full = low >= break_rise(p.second, p.end_velocity, higher_end(p));
  const Quadratic a = ramp_distance_polynomial(p.first, p.start_velocity, top, first_full);
  const Quadratic b = ramp_distance_polynomial(p.second, p.end_velocity, top, second_full);
  const double rise = rising_root(a.square + b.square, a.linear + b.linear, gamma);
  return std::clamp(low + rise, low, high);
}

/// d distance / d rise of jerk-limited ramps.
double distance_slope(const PeakProblem& p, double rise) noexcept {
  const double top = higher_end(p);
  double slope = 0;
  for (const auto& [law, end] : {std::pair(&p.first, p.start_velocity), std::pair(&p.second, p.end_velocity)}) {
    const double change = top - end + rise;
    const double time_slope =
        change < law->full_change() ? 1 / std::sqrt(change * law->jerk()) : 1 / law->acceleration();
    slope += law->duration_s(change) / 2 + (end + top + rise) / 2 * time_slope;
  }
  return slope;
}

/// Newton in the square root of the rise (the distance is smooth in it), kept inside a shrinking bracket.
double solve_by_newton(const PeakProblem& p, double low, double high) noexcept {
  double s_low = std::sqrt(low);
  double s_high = std::sqrt(high);
  double s = s_high;
  for (int step = 0; step < 200; ++step) {
    const double rise = s * s;
    const double error = distance_above(p, rise) - p.stroke;
    if (error == 0) {
      break;
    }
    (error > 0 ? s_high : s_low) = s;
    double next = s - error / (2 * s * distance_slope(p, rise));
    if (!(next > s_low && next < s_high)) {
      next = s_low + (s_high - s_low) / 2;
    }
    const bool done = std::abs(next - s) <= 2e-16 * s || next == s_low || next == s_high;
    s = next;
    if (done) {
      break;
    }
  }
  return std::clamp(s * s, low, high);
}

/// Both ramps from or to rest and neither reaching its acceleration limit: D = v^1.5 (1/sqrt j1 + 1/sqrt j2).
/// Two roots and a division, so that a denormal stroke keeps its digits.
double solve_triangles(const PeakProblem& p, double high) noexcept {
  const double root = std::cbrt(p.stroke) / std::cbrt(1 / std::sqrt(p.first.jerk()) + 1 / std::sqrt(p.second.jerk()));
  return std::min(root * root, high);
}

double solve_jerk_limited(const PeakProblem& p, double limit) noexcept {
  const Breaks breaks = breaks_of(p, higher_end(p));
  const double high = std::min(breaks.high, limit);
  const double distance_high = distance_above(p, high);
  if (p.stroke >= distance_high) {  // both reach their acceleration limit
    return solve_piece(p, high, limit, p.stroke - distance_high);
  }
  const double low = std::min(breaks.low, limit);
  const bool below_low = p.stroke <= distance_above(p, low);
  if (below_low && p.start_velocity == 0 && p.end_velocity == 0) {
    return solve_triangles(p, low);
  }
  return below_low ? solve_by_newton(p, 0, low) : solve_by_newton(p, low, high);
}

double solve_fixed(const PeakProblem& p, double limit) noexcept {
  const Breaks breaks = breaks_of(p, higher_end(p));
  const std::array<double, 4> ends{0, std::min(breaks.low, limit), std::min(breaks.high, limit), limit};
  for (std::size_t piece = 0; piece < 3; ++piece) {
    if (ends[piece + 1] > ends[piece] && (piece == 2 || distance_above(p, ends[piece + 1]) >= p.stroke)) {
      return solve_piece(p, ends[piece], ends[piece + 1], p.stroke - distance_above(p, ends[piece]));
    }
  }
  return limit;
}

/// The move that stays at the higher end velocity and needs one ramp only.
Peak stay_at_end(const PeakProblem& p, double direct) noexcept {
  const double top = higher_end(p);
  const double left = p.stroke - direct;
  return {0, left > 0 && top > 0 ? left / top : 0};
}

Peak with_rise(const PeakProblem& p, double rise, double limit) noexcept {
  if (rise < limit) {
    return {rise, 0};
  }
  const double left = p.stroke - distance_above(p, limit);
  return {limit, left > 0 && p.v_max > 0 ? left / p.v_max : 0};
}

}  // namespace

double higher_end(const PeakProblem& p) noexcept {
  return std::max(p.start_velocity, p.end_velocity);
}

double ramps_distance(const PeakProblem& p, double rise) noexcept {
  const double top = higher_end(p) + rise;
  return (p.start_velocity + top) / 2 * p.first.duration_s(higher_end(p) - p.start_velocity + rise) +
         (top + p.end_velocity) / 2 * p.second.duration_s(higher_end(p) - p.end_velocity + rise);
}

double ramps_duration_s(const PeakProblem& p, double rise) noexcept {
  return p.first.duration_s(higher_end(p) - p.start_velocity + rise) +
         p.second.duration_s(higher_end(p) - p.end_velocity + rise);
}

Peak solve_peak(const PeakProblem& p) noexcept {
  const double direct = ramps_distance(p, 0);
  const double limit = std::max(0.0, p.v_max - higher_end(p));
  if (p.stroke <= direct || limit == 0) {
    return stay_at_end(p, direct);
  }
  if (!p.first.fixed()) {
    const double reach = distance_above(p, limit);
    return with_rise(p, p.stroke >= reach ? limit : solve_jerk_limited(p, limit), limit);
  }
  // Ramps of fixed jerk time cannot be short: rising above the higher end may take longer than staying there.
  const Peak staying = stay_at_end(p, direct);
  if (higher_end(p) > 0 && p.stroke < distance_above(p, 0)) {
    return staying;
  }
  const double rise = p.stroke >= distance_above(p, limit) ? limit : solve_fixed(p, limit);
  const Peak rising = with_rise(p, rise, limit);
  const bool stay = rise == 0 || (higher_end(p) > 0 && ramps_duration_s(p, 0) + staying.cruise_s <
                                                           ramps_duration_s(p, rise) + rising.cruise_s);
  return stay ? staying : rising;
}

}  // namespace gravure::motion
