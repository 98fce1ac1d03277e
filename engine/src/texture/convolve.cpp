#include "convolve.hpp"

#include <algorithm>
#include <complex>
#include <cstdint>
#include <numbers>
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

Complex as_number(const Vector2& point) {
  return {point.x(), point.y()};
}

/// The path's point at any place, by what stands beyond its ends. x and y as one complex number.
Complex beyond(std::span<const Vector2> path, std::int64_t place, Ends ends) {
  const auto last = static_cast<std::int64_t>(path.size()) - 1;
  const auto at = [&path](std::int64_t i) { return as_number(path[static_cast<std::size_t>(i)]); };
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

std::vector<Vector2> convolve(std::span<const Vector2> path, const std::vector<double>& weights, Ends ends) {
  const auto count = static_cast<std::int64_t>(path.size());
  const auto radius = static_cast<std::int64_t>(weights.size()) - 1;
  const std::size_t length = fast_length(static_cast<std::size_t>(count + 2 * radius));
  std::vector<Complex> kernel(length);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    kernel[k] = weights[k];
    kernel[(length - k) % length] = weights[k];
  }
  std::vector<Complex> points(length);
  for (std::int64_t i = 0; i < count + 2 * radius; ++i) {
    points[static_cast<std::size_t>(i)] = beyond(path, i - radius, ends);
  }
  Eigen::FFT<double> fft;
  std::vector<Complex> kernel_spectrum;
  std::vector<Complex> spectrum;
  fft.fwd(kernel_spectrum, kernel);
  fft.fwd(spectrum, points);
  for (std::size_t i = 0; i < length; ++i) {
    spectrum[i] *= kernel_spectrum[i].real();  // of an even kernel
  }
  fft.inv(points, spectrum);
  std::vector<Vector2> means(path.size());
  for (std::size_t i = 0; i < means.size(); ++i) {
    const Complex point = points[i + static_cast<std::size_t>(radius)];
    means[i] = Vector2(point.real(), point.imag());
  }
  return means;
}

std::vector<double> weights_of(const std::function<double(double)>& response, std::size_t radius) {
  const std::size_t length = fast_length(4 * radius + 2);
  std::vector<Complex> spectrum(length);
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t wave = std::min(i, length - i);
    spectrum[i] = response(2 * std::numbers::pi * static_cast<double>(wave) / static_cast<double>(length));
  }
  Eigen::FFT<double> fft;
  std::vector<Complex> kernel;
  fft.inv(kernel, spectrum);
  std::vector<double> weights(radius + 1);
  double sum = 0;
  for (std::size_t k = 0; k <= radius; ++k) {
    weights[k] = kernel[k].real();
    sum += (k == 0 ? 1 : 2) * weights[k];
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

}  // namespace gravure::texture
