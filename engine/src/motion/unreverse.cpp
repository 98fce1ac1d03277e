#include "gravure/motion/unreverse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gravure::motion {
namespace {

int sign_of(double value) noexcept {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// A piece of the path between two intended turns.
struct Piece {
  std::span<const double> parameter;
  std::span<const double> angle;
  SplineEnd start = SplineEnd::anchored;
  SplineEnd end = SplineEnd::anchored;
};

/// Doubles the control points until the tolerance holds; a monotone curve within it exists, since what runs backwards
/// inside a piece is smaller.
Result<MonotoneFit> fit_piece(const Piece& piece, std::size_t control_points, double tolerance) {
  MonotoneFitRequest request{piece.parameter,
                             piece.angle,
                             std::max<std::size_t>(8, control_points),
                             sign_of(piece.angle.back() - piece.angle.front()),
                             piece.start,
                             piece.end};
  if (request.direction == 0) {  // ends where it began: it stays there
    request.direction = 1;
  }
  const std::size_t most = std::max<std::size_t>(64, 64 * piece.angle.size());
  while (true) {
    GRAVURE_TRY(MonotoneFit fit, fit_monotone(request));
    if (fit.largest <= tolerance) {
      return fit;
    }
    request.control_points *= 2;
    if (request.control_points > std::min<std::size_t>(most, 1'000'000)) {
      return Error{
          ErrorCode::out_of_range,
          fmt::format("unreverse: a piece of {} samples from parameter {} on still deviates by {} with {} control "
                      "points: allow more than the tolerance of {} or sample the path more evenly",
                      piece.angle.size(), piece.parameter.front(), fit.largest, request.control_points / 2, tolerance)};
    }
  }
}

struct Deviation {
  double largest = 0;
  double rms = 0;
};

Deviation deviation_of(std::span<const double> angle, std::span<const double> wanted) noexcept {
  Deviation deviation;
  double squares = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const double off = std::abs(angle[k] - wanted[k]);
    squares += off * off;
    deviation.largest = std::max(deviation.largest, off);
  }
  deviation.rms = wanted.empty() ? 0 : std::sqrt(squares / static_cast<double>(wanted.size()));
  return deviation;
}

}  // namespace

std::size_t count_reversals(std::span<const double> angle) noexcept {
  std::size_t count = 0;
  int sense = 0;
  for (std::size_t k = 1; k < angle.size(); ++k) {
    const int step = sign_of(angle[k] - angle[k - 1]);
    count += step != 0 && sense != 0 && step != sense ? 1 : 0;
    sense = step != 0 ? step : sense;
  }
  return count;
}

std::vector<std::size_t> intended_turns(std::span<const double> angle, double prominence) {
  std::vector<std::size_t> turns{0};
  std::size_t low = 0;
  std::size_t high = 0;
  int sense = 0;
  for (std::size_t k = 1; k < angle.size(); ++k) {
    low = angle[k] < angle[low] ? k : low;
    high = angle[k] > angle[high] ? k : high;
    if (sense >= 0 && angle[high] - angle[k] > prominence) {  // it has turned down for good
      if (sense != 0 && high > turns.back()) {                // what comes before the first such stretch is smaller
        turns.push_back(high);
      }
      sense = -1;
      low = high = k;
    } else if (sense <= 0 && angle[k] - angle[low] > prominence) {
      if (sense != 0 && low > turns.back()) {
        turns.push_back(low);
      }
      sense = 1;
      low = high = k;
    }
  }
  if (angle.size() > 1) {
    turns.push_back(angle.size() - 1);
  }
  return turns;
}

std::vector<double> unwrapped(std::span<const double> angle, double turn) {
  std::vector<double> whole(angle.begin(), angle.end());
  double turns = 0;  // counted, not summed, so that nothing drifts
  for (std::size_t k = 1; k < angle.size(); ++k) {
    const double step = angle[k] - angle[k - 1];
    const double reduced = std::remainder(step, turn);
    const bool half = std::abs(reduced) == turn / 2;
    turns += half ? std::round((std::copysign(turn / 2, step) - step) / turn) : std::round((reduced - step) / turn);
    whole[k] = angle[k] + turns * turn;
  }
  return whole;
}

Result<Unreversed> remove_reversals(const UnreverseRequest& request) {
  if (!(request.tolerance > 0) || request.angle.size() < 2 || request.angle.size() != request.parameter.size()) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("unreverse: tolerance = {} with {} angles and {} parameters: the tolerance must be above 0 and "
                    "both lists as long, 2 or more",
                    request.tolerance, request.angle.size(), request.parameter.size())};
  }
  Unreversed result;
  result.turns = intended_turns(request.angle, request.tolerance);
  result.angle.assign(request.angle.begin(), request.angle.end());
  result.reversals_before = count_reversals(request.angle);
  for (std::size_t t = 0; t + 1 < result.turns.size(); ++t) {
    const std::size_t first = result.turns[t];
    const std::size_t count = result.turns[t + 1] - first + 1;
    Piece piece{request.parameter.subspan(first, count), request.angle.subspan(first, count)};
    piece.start = t == 0 ? SplineEnd::anchored : SplineEnd::resting;
    piece.end = t + 2 == result.turns.size() ? SplineEnd::anchored : SplineEnd::resting;
    GRAVURE_TRY(MonotoneFit fit, fit_piece(piece, request.control_points, request.tolerance));
    for (std::size_t k = 0; k < count; ++k) {
      result.angle[first + k] = fit.spline.at(request.parameter[first + k]);
    }
    // Both are the anchors; evaluation may miss their last bit, and the next piece starts here.
    result.angle[first] = request.angle[first];
    result.angle[first + count - 1] = request.angle[first + count - 1];
    result.control_points += fit.spline.control_points.size();
    result.pieces.push_back(std::move(fit.spline));
  }
  // Evaluation rounds; hold every piece to its sense bit for bit.
  for (std::size_t t = 0; t + 1 < result.turns.size(); ++t) {
    const std::size_t last = result.turns[t + 1];
    const double target = result.angle[last];
    const bool rising = target >= result.angle[result.turns[t]];
    for (std::size_t k = result.turns[t] + 1; k < last; ++k) {
      const double before = result.angle[k - 1];
      result.angle[k] = rising ? std::clamp(result.angle[k], before, std::max(before, target))
                               : std::clamp(result.angle[k], std::min(before, target), before);
    }
  }
  const Deviation off = deviation_of(result.angle, request.angle);
  result.largest_deviation = off.largest;
  result.rms_deviation = off.rms;
  result.reversals_after = count_reversals(result.angle);
  return result;
}

std::vector<double> published_shift(std::span<const double> angle, double shift, int direction) {
  std::vector<double> shifted(angle.begin(), angle.end());
  for (std::size_t k = 1; k < angle.size(); ++k) {
    double step = angle[k] - angle[k - 1];
    if (step * direction < 0 && shift > 0) {
      step += direction * shift * std::ceil(-step * direction / shift);
      step = step * direction < 0 ? 0 : step;
    }
    shifted[k] = shifted[k - 1] + step;
  }
  return shifted;
}

Shifted published_shift_between_turns(std::span<const double> angle, double prominence, double shift) {
  Shifted result;
  const std::vector<std::size_t> turns = intended_turns(angle, prominence);
  for (std::size_t t = 0; t + 1 < turns.size(); ++t) {
    const auto piece = angle.subspan(turns[t], turns[t + 1] - turns[t] + 1);
    std::vector<double> shifted = published_shift(piece, shift, piece.back() < piece.front() ? -1 : 1);
    const double drift = result.angle.empty() ? 0 : result.angle.back() - shifted.front();
    for (std::size_t k = result.angle.empty() ? 0 : 1; k < shifted.size(); ++k) {
      result.angle.push_back(shifted[k] + drift);
    }
  }
  result.reversals_after = count_reversals(result.angle);
  const Deviation off = deviation_of(result.angle, angle);
  result.largest_deviation = off.largest;
  result.rms_deviation = off.rms;
  return result;
}

}  // namespace gravure::motion
