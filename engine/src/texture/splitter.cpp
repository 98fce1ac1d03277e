#include "gravure/texture/splitter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convolve.hpp"
#include "splitters.hpp"

namespace gravure::texture {
namespace {

/// Where a Gaussian of sigma 1 halves a wave, rad: exp(-w^2 / 2) = 1/2.
const double kHalfWave = std::sqrt(2 * std::log(2.0));

Result<double> sigma_steps(const SplitRequest& request) {
  const double steps = request.sigma_mm / request.path.step_mm;
  constexpr double kMost = 1e6;
  if (!(steps > 0) || !(steps < kMost)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("sigma of {} mm over steps of {} mm: both must be above 0, and sigma below {} steps",
                             request.sigma_mm, request.path.step_mm, kMost)};
  }
  return steps;
}

class GaussianSplitter final : public Splitter {
 public:
  explicit GaussianSplitter(const GaussianFilter& filter) : filter_(filter) {}
  Result<std::vector<Vector2>> stages_mm(const SplitRequest& request, const CancelToken& /*cancel*/) const override {
    GaussianFilter filter = filter_;
    filter.sigma_mm = request.sigma_mm;
    return slow_part(request.path.points_mm, request.path.step_mm, filter);
  }
  bool keeps_limits() const noexcept override { return false; }

 private:
  GaussianFilter filter_;
};

class SavitzkyGolaySplitter final : public Splitter {
 public:
  Result<std::vector<Vector2>> stages_mm(const SplitRequest& request, const CancelToken& /*cancel*/) const override {
    GRAVURE_TRY(const double steps, sigma_steps(request));
    // The response of a window -1 to 1, 3/2 (5 sin w / w^3 - 5 cos w / w^2 - sin w / w), is 1/2 at this w.
    constexpr double kWindowHalfWave = 4.00438518148207;
    const double m = std::max(1.0, std::round(kWindowHalfWave / kHalfWave * steps));
    const auto parabola = [m](std::int64_t k) {
      const auto at = static_cast<double>(k);
      return 3 * (3 * m * m + 3 * m - 1 - 5 * at * at) / ((2 * m - 1) * (2 * m + 1) * (2 * m + 3));
    };
    return convolve(request.path.points_mm, parabola, static_cast<std::int64_t>(m), Ends::odd);
  }
  bool keeps_limits() const noexcept override { return false; }
};

class FftSplitter final : public Splitter {
 public:
  Result<std::vector<Vector2>> stages_mm(const SplitRequest& request, const CancelToken& /*cancel*/) const override {
    GRAVURE_TRY(const double steps, sigma_steps(request));
    const double half = kHalfWave / steps;
    // Its weights fall by e in steps / (half wave * sin(pi / 8)): 1e-16 is left there.
    constexpr double kFaded = 85;
    const auto radius = static_cast<std::int64_t>(std::ceil(kFaded * steps));
    if (is_folded(radius, request.path.points_mm.size())) {
      return convolve(
          request.path.points_mm, [half](std::int64_t k) { return weight_at(half, k); }, radius, Ends::odd);
    }
    const std::vector<double> weights = weights_of([half](double wave) { return 1 / (1 + std::pow(wave / half, 8)); },
                                                   static_cast<std::size_t>(radius));
    return convolve(
        request.path.points_mm, [&weights](std::int64_t k) { return weights[static_cast<std::size_t>(k)]; }, radius,
        Ends::odd);
  }
  bool keeps_limits() const noexcept override { return false; }

 private:
  /// The transform of 1 / (1 + (w / half)^8), from its four poles above the axis; where `half` is small it is that of
  /// the steps as well.
  static double weight_at(double half, std::int64_t k) {
    const double at = half * static_cast<double>(k);
    double sum = 0;
    for (const double pole : {std::numbers::pi / 8, 3 * std::numbers::pi / 8}) {
      sum += std::exp(-at * std::sin(pole)) * std::sin(pole + at * std::cos(pole));
    }
    return half / 4 * sum;
  }
};

}  // namespace

std::string_view split_method_name(SplitMethod method) noexcept {
  switch (method) {
    case SplitMethod::gaussian:
      return "gaussian";
    case SplitMethod::savitzky_golay:
      return "savitzky-golay";
    case SplitMethod::fft:
      return "fft";
    case SplitMethod::adaptive:
      return "adaptive";
    case SplitMethod::optimal:
      return "optimal";
  }
  return "";
}

std::unique_ptr<Splitter> gaussian_splitter(const GaussianFilter& filter) {
  return std::make_unique<GaussianSplitter>(filter);
}

std::unique_ptr<Splitter> make_splitter(SplitMethod method, const GaussianFilter& filter) {
  switch (method) {
    case SplitMethod::savitzky_golay:
      return std::make_unique<SavitzkyGolaySplitter>();
    case SplitMethod::fft:
      return std::make_unique<FftSplitter>();
    case SplitMethod::adaptive:
      return adaptive_splitter(filter);
    case SplitMethod::optimal:
      return optimal_splitter();
    case SplitMethod::gaussian:
      break;
  }
  return gaussian_splitter(filter);
}

double strain(const Deviation& off, const DeviationLimits& limits) {
  return std::max({std::abs(off.focus_mm) / limits.focus_mm, off.incidence_rad / limits.incidence_rad,
                   off.displacement_mm / limits.displacement_mm});
}

StageDemand stage_demand(std::span<const SurfacePoint> stages, double step_mm) {
  StageDemand demand;
  double squares = 0;
  const auto p = [&stages](std::size_t i) -> const Vector3& { return stages[i].position_mm; };
  for (std::size_t i = 0; i + 2 < stages.size(); ++i) {
    const Vector3 second = p(i + 2) - 2 * p(i + 1) + p(i);
    demand.max_bend_per_mm = std::max(demand.max_bend_per_mm, second.norm() / (step_mm * step_mm));
    if (i + 3 < stages.size()) {
      const Vector3 third = p(i + 3) - 3 * p(i + 2) + 3 * p(i + 1) - p(i);
      const double jerk = third.norm() / (step_mm * step_mm * step_mm);
      demand.max_jerk_per_mm2 = std::max(demand.max_jerk_per_mm2, jerk);
      squares += jerk * jerk;
    }
  }
  const std::size_t thirds = stages.size() < 4 ? 1 : stages.size() - 3;
  demand.rms_jerk_per_mm2 = std::sqrt(squares / static_cast<double>(thirds));
  return demand;
}

}  // namespace gravure::texture
