#include "gravure/motion/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "check_request.hpp"
#include "damped_fit.hpp"
#include "gravure/motion/settling.hpp"
#include "identify_limits.hpp"
#include "mode_constants.hpp"

namespace gravure::motion {
namespace {

constexpr std::size_t kMostModes = 4;
constexpr std::size_t kLeastSamples = 40;
constexpr std::size_t kMostFitted = 200'000;

Error cannot_tell(std::string reason) {
  return Error{ErrorCode::bad_file, "identify: the data cannot tell: " + std::move(reason)};
}

/// The part from start_s on, checked to be even.
Result<Series> series_of(const IdentifyRequest& request) {
  const auto& times = request.recording.time_s;
  const auto& values = request.recording.acceleration_mm_s2;
  if (times.size() != values.size()) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("identify: {} times but {} accelerations", times.size(), values.size())};
  }
  // Half a nanosecond of room: start_s is often a sum that rounds above its sample.
  const auto first = static_cast<std::size_t>(
      std::find_if(times.begin(), times.end(), [&](double t) { return t >= request.start_s - 5e-10; }) - times.begin());
  const std::size_t count = times.size() - first;
  if (count < kLeastSamples) {
    return cannot_tell(
        fmt::format("{} samples from start_s = {} on: at least {} are needed", count, request.start_s, kLeastSamples));
  }
  Series series;
  series.period_s = (times.back() - times[first]) / static_cast<double>(count - 1);
  for (std::size_t k = first; k < times.size(); ++k) {
    const double expected = times[first] + static_cast<double>(k - first) * series.period_s;
    if (!(std::abs(times[k] - expected) <= 0.02 * series.period_s) || !std::isfinite(values[k])) {
      return cannot_tell(fmt::format("sample {} at {} s is off the even period of {} s, or not finite; resample it",
                                     k + 1, times[k], series.period_s));
    }
  }
  // Beyond this many samples the tail says nothing new.
  series.values.assign(values.begin() + static_cast<std::ptrdiff_t>(first),
                       values.begin() + static_cast<std::ptrdiff_t>(first + std::min(count, kMostFitted)));
  return series;
}

double information_criterion(const DampedFit& fit, const Series& series, double power) {
  const auto n = static_cast<double>(series.values.size());
  // Data without noise would reward any fit of the rounding.
  const double least = 1e-18 * power;
  return n * std::log(std::max(fit.sum_of_squares / n, least)) +
         static_cast<double>(fit.parameters.size()) * std::log(n);
}

/// Oscillations below the folding frequency that last longer than a few samples and stand out of their own uncertainty:
/// a fit may wander to others to follow the noise.
bool plausible(const DampedFit& fit, double period_s) {
  for (Eigen::Index m = 1; m < fit.parameters.size(); m += 4) {
    const double w = fit.parameters[m + 1];
    const double amplitude = std::hypot(fit.parameters[m + 2], fit.parameters[m + 3]);
    const double sd = std::sqrt(fit.covariance(m + 2, m + 2) + fit.covariance(m + 3, m + 3));
    if (!(w > 0 && w * period_s < kTwoPi / 2 && fit.parameters[m] * period_s < 0.3 &&
          amplitude > kStandsOutInDeviations * sd)) {
      return false;
    }
  }
  return true;
}

using Poles = std::vector<std::complex<double>>;

/// Poles of so many modes by every stride, those first that leave the least; only a few are worth a fit.
std::vector<Poles> candidates(const Series& series, const std::vector<SignalSpace>& spaces, std::size_t count) {
  constexpr std::size_t kMostCandidates = 3;
  std::vector<std::pair<double, Poles>> found;
  for (const SignalSpace& space : spaces) {
    Poles poles = space.poles(count);
    poles.resize(std::min(poles.size(), count));
    if (poles.size() == count) {
      const double left = misfit(series, poles);
      found.emplace_back(left, std::move(poles));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Poles> best;
  for (std::size_t i = 0; i < std::min(found.size(), kMostCandidates); ++i) {
    best.push_back(std::move(found[i].second));
  }
  return best;
}

/// The best fit over numbers of modes and strides.
std::optional<DampedFit> best_fit(const Series& series, std::uint32_t modes, double power) {
  std::optional<DampedFit> best;
  double best_criterion = std::numeric_limits<double>::infinity();
  if (modes == 0) {
    best = fit_damped(series, {});
    best_criterion = information_criterion(*best, series, power);
  }
  std::vector<SignalSpace> spaces;
  for (std::size_t stride = 1; stride * 24 < series.values.size(); stride *= 2) {
    spaces.emplace_back(series, stride);
  }
  const std::size_t low = modes == 0 ? 1 : modes;
  const std::size_t high = modes == 0 ? kMostModes : modes;
  for (std::size_t count = low; count <= high; ++count) {
    for (const Poles& poles : candidates(series, spaces, count)) {
      DampedFit fit = fit_damped(series, poles);
      const double criterion = information_criterion(fit, series, power);
      // A criterion better by less than 10 is no evidence for more parameters.
      if (fit.solved && plausible(fit, series.period_s) &&
          criterion < best_criterion - (best && fit.modes() > best->modes() ? 10 : 0)) {
        best_criterion = criterion;
        best = std::move(fit);
      }
    }
    if (modes == 0 && best->modes() < count) {
      break;  // one more mode explained nothing
    }
  }
  return best;
}

/// What one mode's parameters (offset, s, w, A, B) say.
struct Reading {
  double f_hz = 0;
  double zeta = 0;
  double participation = 0;
  double mismatch = 0;  ///< of the phase the input should have caused, relative to the amplitude
};

using Local = std::array<double, 5>;

Reading read_mode(const IdentifyRequest& request, const Local& p, double amplitude_sum) {
  const double w = std::hypot(p[1], p[2]);
  Reading reading{w / kTwoPi, p[1] / w, std::hypot(p[3], p[4]) / amplitude_sum, 0};
  std::vector<InputJump> input = request.input;
  double after_s = input.empty() ? 0 : request.start_s - input.back().time_s;
  if (request.of == RecordingOf::step) {
    input = {{0, p[0], 0}};
    after_s = 0;
  }
  if (input.empty() || !(reading.zeta < 1)) {
    return reading;
  }
  // Im((B + i A) exp(lambda t)) against what a participation of 1 would give.
  const std::array<Mode, 1> unit{Mode{reading.f_hz, std::max(0.0, reading.zeta), 1}};
  const ModeConstants m = constants_of(unit[0].f_hz, unit[0].zeta);
  const auto expected = times(residual_of(unit, input, BandOf::acceleration).terms()[0].amplitude, exp_of(m, after_s));
  const std::complex<double> ratio = std::complex<double>(p[4], p[3]) / expected;
  reading.participation = ratio.real();
  reading.mismatch = std::abs(ratio.imag()) / std::abs(ratio);
  return reading;
}

/// A reading with standard deviations by differences of it.
struct Measured {
  IdentifiedMode mode;
  double mismatch = 0;
};

Measured measure_mode(const IdentifyRequest& request, const DampedFit& fit, std::size_t index, double amplitude_sum) {
  const auto first = static_cast<Eigen::Index>(1 + 4 * index);
  const std::array<Eigen::Index, 5> where{0, first, first + 1, first + 2, first + 3};
  Local p{};
  for (std::size_t i = 0; i < 5; ++i) {
    p[i] = fit.parameters[where[i]];
  }
  const Reading centre = read_mode(request, p, amplitude_sum);
  std::array<std::array<double, 3>, 5> slope{};
  for (std::size_t i = 0; i < 5; ++i) {
    const double step =
        std::max(1e-6 * std::abs(p[i]), 1e-3 * std::sqrt(std::max(0.0, fit.covariance(where[i], where[i]))));
    Local moved = p;
    moved[i] += step;
    const Reading there = read_mode(request, moved, amplitude_sum);
    slope[i] = {(there.f_hz - centre.f_hz) / step, (there.zeta - centre.zeta) / step,
                (there.participation - centre.participation) / step};
    if (step == 0) {
      slope[i] = {};
    }
  }
  std::array<double, 3> variance{};
  for (std::size_t q = 0; q < 3; ++q) {
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j < 5; ++j) {
        variance[q] += slope[i][q] * slope[j][q] * fit.covariance(where[i], where[j]);
      }
    }
  }
  const auto sd = [&variance](std::size_t q) { return std::sqrt(std::max(0.0, variance[q])); };
  return {{{centre.f_hz, centre.zeta, centre.participation}, sd(0), sd(1), sd(2)}, centre.mismatch};
}

Result<void> check_mode(const IdentifyRequest& request, const Series& series, const Measured& measured) {
  const IdentifiedMode& found = measured.mode;
  const double f = found.mode.f_hz;
  const double length_s = series.period_s * static_cast<double>(series.values.size());
  if (found.mode.zeta < -3 * found.zeta_sd) {
    return cannot_tell(fmt::format("the vibration of {:.4g} Hz grows (zeta = {:.3g})", f, found.mode.zeta));
  }
  if (f * series.period_s > 0.45) {
    return cannot_tell(fmt::format("{:.4g} Hz is above 0.45 of the sample rate; sample faster", f));
  }
  if (f * length_s < 2) {
    return cannot_tell(
        fmt::format("the record of {:.4g} s is shorter than two periods of {:.4g} Hz; record longer", length_s, f));
  }
  if (!(found.f_sd_hz <= request.max_f_sd_percent / 100 * f)) {
    return cannot_tell(
        fmt::format("{:.4g} Hz is known to +-{:.3g} Hz only, more than the {} % allowed; less noise or a longer "
                    "record is needed",
                    f, found.f_sd_hz, request.max_f_sd_percent));
  }
  if (!(found.zeta_sd <= request.max_zeta_sd)) {
    return cannot_tell(
        fmt::format("the damping {:.3g} of {:.4g} Hz is known to +-{:.3g} only, more than the {} allowed",
                    found.mode.zeta, f, found.zeta_sd, request.max_zeta_sd));
  }
  const bool known_input = request.of == RecordingOf::step || !request.input.empty();
  if (known_input && measured.mismatch > 0.3) {
    return cannot_tell(fmt::format("the phase of {:.4g} Hz does not fit the stated {}; check start_s and the input", f,
                                   request.of == RecordingOf::step ? "step" : "input"));
  }
  return {};
}

Result<void> check_apart(const std::vector<IdentifiedMode>& modes) {
  for (std::size_t i = 0; i + 1 < modes.size(); ++i) {
    const double gap = modes[i + 1].mode.f_hz - modes[i].mode.f_hz;
    const double sd = std::hypot(modes[i].f_sd_hz, modes[i + 1].f_sd_hz);
    if (gap < kApartInDeviations * sd) {
      return cannot_tell(
          fmt::format("two modes at {:.4g} and {:.4g} Hz are closer than three times their uncertainty of {:.3g} "
                      "Hz; record longer or ask for fewer modes",
                      modes[i].mode.f_hz, modes[i + 1].mode.f_hz, sd));
    }
  }
  return {};
}

Result<void> check_identify_request(const IdentifyRequest& request) {
  GRAVURE_CHECK(check_range("modes", request.modes, 0, kMostModes));
  GRAVURE_CHECK(check_range("max_f_sd_percent", request.max_f_sd_percent, 1e-9, 100));
  GRAVURE_CHECK(check_range("max_zeta_sd", request.max_zeta_sd, 1e-12, 1));
  const bool late = !request.input.empty() && request.input.back().time_s > request.start_s + 5e-10;
  if (late) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("identify: start_s = {}: must not lie before the end of the input at {} s",
                             request.start_s, request.input.back().time_s)};
  }
  return {};
}

Result<Identification> read_fit(const IdentifyRequest& request, const Series& series, const DampedFit& fit) {
  Identification result;
  result.samples = series.values.size();
  result.sample_hz = 1 / series.period_s;
  result.record_s = series.period_s * static_cast<double>(series.values.size());
  result.offset_mm_s2 = fit.parameters[0];
  result.noise_sd_mm_s2 = std::sqrt(fit.sum_of_squares / std::max(1.0, static_cast<double>(series.values.size()) -
                                                                           static_cast<double>(fit.parameters.size())));
  result.participation_is_absolute = request.of == RecordingOf::step || !request.input.empty();
  double amplitude_sum = 0;
  for (Eigen::Index m = 1; m < fit.parameters.size(); m += 4) {
    amplitude_sum += std::hypot(fit.parameters[m + 2], fit.parameters[m + 3]);
  }
  for (std::size_t i = 0; i < fit.modes(); ++i) {
    const Measured measured = measure_mode(request, fit, i, amplitude_sum);
    GRAVURE_CHECK(check_mode(request, series, measured));
    result.modes.push_back(measured.mode);
    result.modes.back().mode.zeta = std::max(0.0, measured.mode.mode.zeta);
    result.modes.back().resolution_hz = resolution_hz(series, fit, i);
  }
  std::sort(result.modes.begin(), result.modes.end(),
            [](const IdentifiedMode& a, const IdentifiedMode& b) { return a.mode.f_hz < b.mode.f_hz; });
  GRAVURE_CHECK(check_apart(result.modes));
  result.warnings = warnings_of(series, fit, result);
  return result;
}

}  // namespace

Result<Identification> identify(const IdentifyRequest& request) {
  GRAVURE_CHECK(check_identify_request(request));
  GRAVURE_TRY(const Series series, series_of(request));
  double power = 0;
  for (const double value : series.values) {
    power += value * value / static_cast<double>(series.values.size());
  }
  if (!(power > 0)) {
    return cannot_tell("every sample is 0");
  }
  const std::optional<DampedFit> fit = best_fit(series, request.modes, power);
  if (!fit || fit->modes() == 0 || !fit->solved) {
    return cannot_tell(request.modes == 0
                           ? std::string("no vibration stands out of the noise")
                           : fmt::format("no {} separate vibrations stand out of the noise in {:.4g} s of record; "
                                         "record longer, with less noise, or ask for fewer modes",
                                         request.modes, series.period_s * static_cast<double>(series.values.size())));
  }
  return read_fit(request, series, *fit);
}

}  // namespace gravure::motion
