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

std::vector<Vector2> by_fft(std::span<const Vector2> path, const std::vector<double>& weights, Ends ends) {
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

/// The path less the straight line between its ends, and that line.
std::vector<Vector2> straight_line(std::span<const Vector2> path) {
  std::vector<Vector2> line(path.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(line.size() - 1);
    line[i] = (1 - share) * path.front() + share * path.back();
  }
  return line;
}

/// Less the line between its ends the mirrored path repeats itself every 2 (count - 1) points: weights of the same
/// place of that period are one.
std::vector<double> folded_odd(const Weight& weight, std::int64_t radius, std::int64_t count) {
  const std::int64_t half = count - 1;
  std::vector<double> folded(static_cast<std::size_t>(count));
  for (std::int64_t k = radius; k >= 0; --k) {
    const std::int64_t place = k % (2 * half);
    const std::int64_t j = std::min(place, 2 * half - place);
    folded[static_cast<std::size_t>(j)] += (j == 0 && k > 0 ? 2 : 1) * weight(k);
  }
  return folded;
}

std::vector<Vector2> convolve_odd(std::span<const Vector2> path, const Weight& weight, std::int64_t radius) {
  const std::vector<Vector2> line = straight_line(path);
  std::vector<Vector2> rest(path.begin(), path.end());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    rest[i] -= line[i];
  }
  std::vector<Vector2> means =
      by_fft(rest, folded_odd(weight, radius, static_cast<std::int64_t>(path.size())), Ends::odd);
  for (std::size_t i = 0; i < means.size(); ++i) {
    means[i] += line[i];
  }
  return means;
}

/// Weights further out than the path is long meet its ends only.
std::vector<Vector2> convolve_repeat(std::span<const Vector2> path, const Weight& weight, std::int64_t radius) {
  const auto count = static_cast<std::int64_t>(path.size());
  double tail = 0;
  for (std::int64_t k = radius; k >= count; --k) {
    tail += weight(k);
  }
  std::vector<double> weights(path.size());
  for (std::int64_t k = 0; k < count; ++k) {
    weights[static_cast<std::size_t>(k)] = weight(k);
  }
  std::vector<Vector2> means = by_fft(path, weights, Ends::repeat);
  const Vector2 ends = tail * (path.front() + path.back());
  for (Vector2& mean : means) {
    mean += ends;
  }
  return means;
}

}  // namespace

bool is_folded(std::int64_t radius, std::size_t count) noexcept {
  constexpr std::int64_t kAlways = 1 << 16;
  return count > 1 && radius > std::max(kAlways, static_cast<std::int64_t>(count));
}

std::vector<Vector2> convolve(std::span<const Vector2> path, const Weight& weight, std::int64_t radius, Ends ends) {
  if (is_folded(radius, path.size())) {
    return ends == Ends::odd ? convolve_odd(path, weight, radius) : convolve_repeat(path, weight, radius);
  }
  std::vector<double> weights(static_cast<std::size_t>(radius) + 1);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] = weight(static_cast<std::int64_t>(k));
  }
  return by_fft(path, weights, ends);
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
