#include "worst_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error_side.hpp"

namespace gravure::motion {
namespace {

/// Of the tolerance: nearer to it than this counts as outside, so that no stride gets too short.
constexpr double kNearest = 2e-4;
/// Of the tolerance, for each mode: what interpolation may be off by.
constexpr double kInterpolation = 1e-4;

/// The sides of one mode's rectangle of errors.
std::vector<ErrorSide> sides_of(const SearchProblem& problem, const Mode& mode, std::span<const InputJump> input,
                                double until_s) {
  const double error = problem.mode_error_percent / 100;
  const std::array<double, 2> f_hz{mode.f_hz * (1 - error), mode.f_hz * (1 + error)};
  const std::array<double, 2> zeta{mode.zeta * (1 - error), std::min(0.999, mode.zeta * (1 + error))};
  const SideAccuracy accuracy{kInterpolation * problem.band.tolerance, until_s};
  std::vector<ErrorSide> sides;
  for (std::size_t i = 0; i < (zeta[1] > zeta[0] ? 2 : 1); ++i) {
    sides.push_back(
        ErrorSide::over_frequency({f_hz[0], zeta[i], mode.participation}, f_hz[1], problem.band.of, input, accuracy));
    if (zeta[1] > zeta[0]) {
      sides.push_back(
          ErrorSide::over_damping({f_hz[i], zeta[0], mode.participation}, zeta[1], problem.band.of, input, accuracy));
    }
  }
  return sides;
}

using ModeSides = std::vector<ErrorSide>;

/// Back in time from the instant at which the envelopes of all errors are within the band, in strides that no signal
/// can cross: it changes by at most (w times envelope) in a unit of time.
class BackwardProof {
 public:
  BackwardProof(const SearchProblem& problem, std::span<const InputJump> input)
      : tolerance_(problem.band.tolerance), modes_(problem.modes) {
    for (const Mode& mode : modes_) {
      sides_.push_back(sides_of(problem, mode, input, 0));
    }
    start_s_ = envelope_time_s();
    if (start_s_ > 0 && start_s_ < std::numeric_limits<double>::infinity()) {
      for (std::size_t i = 0; i < modes_.size(); ++i) {
        sides_[i] = sides_of(problem, modes_[i], input, start_s_);
      }
      start_s_ = std::min(start_s_, envelope_time_s());
    }
  }

  WorstCase run() {
    if (!(start_s_ < std::numeric_limits<double>::infinity())) {
      look_at(0);
      return {start_s_, worst_modes()};
    }
    double after_s = start_s_;
    std::size_t work = 0;
    for (constexpr std::size_t kMostWork = 20'000'000; after_s > 0 && work < kMostWork;) {
      work += look_at(after_s);
      const double room = tolerance_ - std::max(highest_, -lowest_);
      if (room <= kNearest * tolerance_) {
        return {after_s, worst_modes()};
      }
      // Envelopes grow by no more than a quarter on the way back.
      after_s -= std::min(room / (1.25 * fastest_), std::log(1.25) / decay_);
    }
    after_s = std::max(0.0, after_s);
    look_at(after_s);
    return {after_s, worst_modes()};
  }

 private:
  /// From here on the sum of all that the modes can be is within the band.
  double envelope_time_s() const {
    const auto most_at = [this](double after_s) {
      double sum = 0;
      for (const ModeSides& sides : sides_) {
        double most = 0;
        for (const ErrorSide& side : sides) {
          most = std::max(most, side.envelope(after_s));
        }
        sum += most;
      }
      return sum;
    };
    if (most_at(0) <= tolerance_) {
      return 0;
    }
    double high_s = 1e-3;
    while (most_at(high_s) > tolerance_) {
      high_s *= 2;
      if (high_s > 1e12) {
        return std::numeric_limits<double>::infinity();
      }
    }
    double low_s = 0;
    for (int step = 0; step < 30; ++step) {
      const double middle_s = (low_s + high_s) / 2;
      (most_at(middle_s) > tolerance_ ? low_s : high_s) = middle_s;
    }
    return high_s;
  }

  /// What the signal can be at an instant, and how fast it can change there; returns the work done.
  std::size_t look_at(double after_s) {
    highest_ = 0;
    lowest_ = 0;
    fastest_ = 0;
    decay_ = 1e-300;
    std::size_t work = 0;
    reaches_.assign(sides_.size(), {});
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      double w = 0;
      for (const ErrorSide& side : sides_[i]) {
        work += side.reach(after_s, reaches_[i]);
        w = std::max(w, side.largest_w());
        decay_ = std::max(decay_, side.largest_decay_per_s());
      }
      highest_ += reaches_[i].high;
      lowest_ += reaches_[i].low;
      fastest_ += w * reaches_[i].envelope;
    }
    return work;
  }

  std::vector<Mode> worst_modes() const {
    const bool up = highest_ >= -lowest_;
    std::vector<Mode> modes;
    for (const Reach& reach : reaches_) {
      modes.push_back(up ? reach.high_mode : reach.low_mode);
    }
    return modes;
  }

  double tolerance_;
  const std::vector<Mode>& modes_;
  std::vector<ModeSides> sides_;
  double start_s_ = 0;
  std::vector<Reach> reaches_;
  double highest_ = 0;
  double lowest_ = 0;
  double fastest_ = 0;
  double decay_ = 0;
};

}  // namespace

WorstCase worst_case(const SearchProblem& problem, std::span<const InputJump> input) {
  if (problem.mode_error_percent == 0 || input.empty()) {
    return {residual_of(problem.modes, input, problem.band.of).last_exit_s(problem.band.tolerance), problem.modes};
  }
  return BackwardProof(problem, input).run();
}

}  // namespace gravure::motion
