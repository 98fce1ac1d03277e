#include "gravure/texture/decomposition.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <unsupported/Eigen/FFT>

namespace gravure::texture {
namespace {

using Complex = std::complex<double>;

/// The next length the FFT is fast at: factors 2, 3 and 5.
std::size_t fast_length(std::size_t least) {
  for (std::size_t n = least;; ++n) {
    std::size_t rest = n;
    for (const std::size_t prime : {2U, 3U, 5U}) {
      while (rest % prime == 0) {
        rest /= prime;
      }
    }
    if (rest == 1) {
      return n;
    }
  }
}

/// The path's point at any place, by what stands beyond its ends. x and y as one complex number.
Complex beyond(std::span<const Vector2> path, std::int64_t place, Ends ends) {
  const auto last = static_cast<std::int64_t>(path.size()) - 1;
  const auto at = [&path](std::int64_t i) {
    const Vector2& point = path[static_cast<std::size_t>(i)];
    return Complex(point.x(), point.y());
  };
  if (place >= 0 && place <= last) {
    return at(place);
  }
  const std::int64_t end = place < 0 ? 0 : last;
  if (ends == Ends::repeat || last == 0) {
    return at(end);
  }
  // Longer than the path: the reflection goes on by whole lengths, each further along by what lies between the ends.
  const std::int64_t period = 2 * last;
  const std::int64_t turns = (place < 0 ? place - period + 1 : place) / period;
  const std::int64_t inside = place - turns * period;
  const Complex span = at(last) - at(0);
  const Complex shift = 2.0 * static_cast<double>(turns) * span;
  return shift + (inside <= last ? at(inside) : 2.0 * at(last) - at(period - inside));
}

}  // namespace

Result<std::vector<Vector2>> slow_part(std::span<const Vector2> path_mm, double step_mm, const GaussianFilter& filter) {
  const double sigma_steps = filter.sigma_mm / step_mm;
  const double wing = filter.cut * sigma_steps + 0.5;
  constexpr double kMostWing = 1e8;
  if (!(step_mm > 0) || !(filter.sigma_mm > 0) || !(filter.cut > 0) || !(wing < kMostWing)) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("Gaussian of sigma {} mm over steps of {} mm, cut at {} sigma: all must be above 0, and at "
                    "most {} steps to each side",
                    filter.sigma_mm, step_mm, filter.cut, kMostWing)};
  }
  const auto radius = static_cast<std::int64_t>(wing);
  const auto count = static_cast<std::int64_t>(path_mm.size());
  const std::size_t length = fast_length(static_cast<std::size_t>(count + 2 * radius));

  std::vector<double> weights(static_cast<std::size_t>(radius) + 1);
  double sum = 0;
  for (std::int64_t k = radius; k >= 0; --k) {
    const double at = static_cast<double>(k) / sigma_steps;
    weights[static_cast<std::size_t>(k)] = std::exp(-at * at / 2);
    sum += (k == 0 ? 1 : 2) * weights[static_cast<std::size_t>(k)];
  }
  std::vector<Complex> kernel(length);
  for (std::int64_t k = 0; k <= radius; ++k) {
    const double weight = weights[static_cast<std::size_t>(k)] / sum;
    kernel[static_cast<std::size_t>(k)] = weight;
    kernel[(length - static_cast<std::size_t>(k)) % length] = weight;
  }
  std::vector<Complex> path(length);
  for (std::int64_t i = 0; i < count + 2 * radius; ++i) {
    path[static_cast<std::size_t>(i)] = beyond(path_mm, i - radius, filter.ends);
  }

  Eigen::FFT<double> fft;
  std::vector<Complex> kernel_spectrum;
  std::vector<Complex> spectrum;
  fft.fwd(kernel_spectrum, kernel);
  fft.fwd(spectrum, path);
  for (std::size_t i = 0; i < length; ++i) {
    spectrum[i] *= kernel_spectrum[i].real();  // of an even kernel
  }
  fft.inv(path, spectrum);

  std::vector<Vector2> slow(path_mm.size());
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const Complex point = path[i + static_cast<std::size_t>(radius)];
    slow[i] = Vector2(point.real(), point.imag());
  }
  return slow;
}

Deviation deviation(const SurfacePoint& target, const SurfacePoint& stage) {
  const Vector3 apart = target.position_mm - stage.position_mm;
  const double focus_mm = stage.normal.dot(apart);
  return {.focus_mm = focus_mm,
          .incidence_rad = std::atan2(target.normal.cross(stage.normal).norm(), target.normal.dot(stage.normal)),
          .displacement_mm = (apart - focus_mm * stage.normal).norm()};
}

DeviationSummary summarise(std::span<const SurfacePoint> targets, std::span<const SurfacePoint> stages) {
  DeviationSummary summary;
  double squares = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Deviation each = deviation(targets[i], stages[i]);
    squares += each.focus_mm * each.focus_mm;
    summary.max_focus_mm = std::max(summary.max_focus_mm, std::abs(each.focus_mm));
    summary.max_incidence_rad = std::max(summary.max_incidence_rad, each.incidence_rad);
    summary.max_displacement_mm = std::max(summary.max_displacement_mm, each.displacement_mm);
  }
  summary.rms_focus_mm = targets.empty() ? 0 : std::sqrt(squares / static_cast<double>(targets.size()));
  return summary;
}

}  // namespace gravure::texture
