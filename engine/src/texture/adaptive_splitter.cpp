#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "convolve.hpp"
#include "splitters.hpp"

namespace gravure::texture {
namespace {

constexpr double kNextLevel = 0.8;  // of sigma, from Gaussian to Gaussian
constexpr double kMostSlope = 0.2;  // of sigma along the path: slower than the filter's own window changes
constexpr double kNarrower = 0.85;  // where the limits are broken still
constexpr int kMostNarrowings = 40;

/// Sigma of every point, and Gaussians of some sigmas from which paths with any are blended.
class Adaptation {
 public:
  Adaptation(const SplitRequest& request, const GaussianFilter& filter)
      : request_(request), filter_(filter), sigma_mm_(request.targets.size(), request.sigma_mm) {}

  Result<std::vector<Vector2>> run(const CancelToken& cancel) {
    std::vector<double> allowed_mm = sigma_mm_;
    for (int round = 0; round < kMostNarrowings; ++round) {
      if (cancel.cancelled()) {
        return Error{ErrorCode::cancelled, "stopped while sigma was adapted"};
      }
      GRAVURE_TRY(const std::vector<Vector2> path, blend());
      GRAVURE_TRY(const bool kept, look(path, allowed_mm));
      if (kept) {
        return path;
      }
      spread(allowed_mm);
    }
    return Error{ErrorCode::out_of_range,
                 fmt::format("adaptive split: {} rounds of narrowing do not meet the limits near x = {} mm, y = {} mm: "
                             "widen them, or take a smoother surface or a finer path",
                             kMostNarrowings, worst_mm_.x(), worst_mm_.y())};
  }

 private:
  /// Where limits are broken, what is allowed falls.
  Result<bool> look(const std::vector<Vector2>& path, std::vector<double>& allowed_mm) {
    std::vector<SurfacePoint> stages(path.size());
    GRAVURE_CHECK(request_.surface.project(path, stages));
    double worst = 1;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const double now = strain(deviation(request_.targets[i], stages[i]), request_.limits);
      if (now > 1) {
        // Displacement grows with sigma, focus offset with its square: the root never asks for too much.
        allowed_mm[i] = sigma_mm_[i] * std::clamp(1 / std::sqrt(now), 0.25, kNarrower);
      }
      if (now > worst) {
        worst = now;
        worst_mm_ = request_.path.points_mm[i];
      }
    }
    return worst <= 1;
  }

  /// The largest sigma below what is allowed whose slope is bounded, its bends rounded.
  void spread(const std::vector<double>& allowed_mm) {
    const double rise_mm = kMostSlope * request_.path.step_mm;
    sigma_mm_ = allowed_mm;
    for (std::size_t i = 1; i < sigma_mm_.size(); ++i) {
      sigma_mm_[i] = std::min(sigma_mm_[i], sigma_mm_[i - 1] + rise_mm);
    }
    for (std::size_t i = sigma_mm_.size() - 1; i-- > 0;) {
      sigma_mm_[i] = std::min(sigma_mm_[i], sigma_mm_[i + 1] + rise_mm);
    }
    std::vector<Vector2> bends(sigma_mm_.size());
    for (std::size_t i = 0; i < bends.size(); ++i) {
      bends[i] = Vector2(sigma_mm_[i], 0);
    }
    const double narrowest_mm = *std::min_element(sigma_mm_.begin(), sigma_mm_.end());
    const auto rounded = slow_part(bends, request_.path.step_mm, {narrowest_mm / 2, 4, Ends::repeat});
    if (rounded) {
      for (std::size_t i = 0; i < bends.size(); ++i) {
        sigma_mm_[i] = rounded.value()[i].x();
      }
    }
  }

  /// Each point of the Gaussians next to its sigma, mixed by a cubic B-spline over their numbers: sigma may change and
  /// the path keeps two continuous derivatives. From the widest on, the widest alone.
  Result<std::vector<Vector2>> blend() const {
    const double ratio = std::log(kNextLevel);
    std::vector<double> place(sigma_mm_.size());
    double last = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      place[i] = std::log(sigma_mm_[i] / request_.sigma_mm) / ratio - 1;
      last = std::max(last, std::floor(place[i]) + 2);
    }
    std::vector<Vector2> path(place.size(), Vector2::Zero());
    for (int level = 0; level <= static_cast<int>(last); ++level) {
      GaussianFilter filter = filter_;
      filter.sigma_mm = request_.sigma_mm * std::pow(kNextLevel, level);
      GRAVURE_TRY(const std::vector<Vector2> slow, slow_part(request_.path.points_mm, request_.path.step_mm, filter));
      for (std::size_t i = 0; i < path.size(); ++i) {
        const double weight = share(place[i], level);
        if (weight > 0) {
          path[i] += weight * slow[i];
        }
      }
    }
    return path;
  }

  static double share(double place, int level) {
    const auto spline = [](double apart) {
      const double a = std::abs(apart);
      return a >= 2 ? 0.0 : a >= 1 ? (2 - a) * (2 - a) * (2 - a) / 6 : 2.0 / 3 - a * a + a * a * a / 2;
    };
    double sum = spline(place - level);
    for (int wider = 1; level == 0 && wider <= 3; ++wider) {  // those that are not there: the widest stands for them
      sum += spline(place + wider);
    }
    return sum;
  }

  const SplitRequest& request_;
  const GaussianFilter& filter_;
  std::vector<double> sigma_mm_;
  Vector2 worst_mm_ = Vector2::Zero();
};

class AdaptiveSplitter final : public Splitter {
 public:
  explicit AdaptiveSplitter(const GaussianFilter& filter) : filter_(filter) {}
  Result<std::vector<Vector2>> stages_mm(const SplitRequest& request, const CancelToken& cancel) const override {
    return Adaptation(request, filter_).run(cancel);
  }
  bool keeps_limits() const noexcept override { return true; }

 private:
  GaussianFilter filter_;
};

}  // namespace

std::unique_ptr<Splitter> adaptive_splitter(const GaussianFilter& filter) {
  return std::make_unique<AdaptiveSplitter>(filter);
}

}  // namespace gravure::texture
