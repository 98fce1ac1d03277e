#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "smooth_tube.hpp"
#include "splitters.hpp"

namespace gravure::texture {
namespace {

constexpr int kMostRounds = 60;
constexpr int kSteps = 60;
constexpr double kMargin = 0.99;  // of the limits: what the steps leave over stays within them

/// A path apart from the texture's, and how far each point strains the limits.
struct Look {
  std::vector<Vector2> stages_mm;
  std::vector<double> strains;
  double worst = 0;
  Vector2 worst_mm = Vector2::Zero();

  Result<void> take(const SplitRequest& request, const std::vector<Vector2>& apart_mm) {
    const std::vector<Vector2>& path = request.path.points_mm;
    stages_mm.resize(path.size());
    strains.resize(path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      stages_mm[i] = path[i] + apart_mm[i];
    }
    std::vector<SurfacePoint> stages(path.size());
    GRAVURE_CHECK(request.surface.project(stages_mm, stages));
    worst = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      strains[i] = strain(deviation(request.targets[i], stages[i]), request.limits);
      if (strains[i] > worst) {
        worst = strains[i];
        worst_mm = path[i];
      }
    }
    return {};
  }
};

/// Round every point of the texture the largest disc found within which the stages' point keeps to the limits there;
/// the smoothest path through the discs. Discs shrink where the path that came breaks a limit, until none is broken.
class OptimalSplitter final : public Splitter {
 public:
  Result<std::vector<Vector2>> stages_mm(const SplitRequest& request, const CancelToken& cancel) const override {
    const std::vector<Vector2>& path = request.path.points_mm;
    SmoothTube tube(path, first_discs(request));
    Result<void> projected;
    Look at_discs;
    for (int round = 0; round < kMostRounds; ++round) {
      if (cancel.cancelled()) {
        return Error{ErrorCode::cancelled, "stopped while the smoothest path was sought"};
      }
      tube.improve(kSteps);
      projected = at_discs.take(request, tube.bounded_mm());
      if (!projected) {  // beyond the rim of the surface
        for (std::size_t i = 0; i < path.size(); ++i) {
          tube.narrow(i, tube.radius_mm(i) / 2);
        }
        continue;
      }
      narrow(tube, at_discs.strains, request.path.step_mm);
      if (at_discs.worst > 1) {
        continue;
      }
      Look at_path;
      projected = at_path.take(request, tube.smooth_mm());
      if (projected && at_path.worst <= 1) {
        return at_path.stages_mm;
      }
      constexpr double kLeftOver = 0.98;  // what the steps have left over, made good in advance
      for (std::size_t i = 0; projected && i < path.size(); ++i) {
        if (at_path.strains[i] > 1) {
          tube.narrow(i, kLeftOver * tube.radius_mm(i));
        }
      }
    }
    GRAVURE_CHECK(std::move(projected));
    return Error{
        ErrorCode::out_of_range,
        fmt::format("optimal split: {} rounds do not meet the limits near x = {} mm, y = {} mm: widen them, or "
                    "take a smoother surface or a finer path",
                    kMostRounds, at_discs.worst_mm.x(), at_discs.worst_mm.y())};
  }
  bool keeps_limits() const noexcept override { return true; }

 private:
  /// Discs whose rim breaks a limit. Focus offset grows with the square of the distance: the root never asks for too
  /// much.
  static void narrow(SmoothTube& tube, const std::vector<double>& strains, double step_mm) {
    for (std::size_t i = 0; i < strains.size(); ++i) {
      if (strains[i] > kMargin) {
        const double distance_mm = tube.bounded_mm()[i].norm();
        tube.narrow(i, std::max(distance_mm * std::sqrt(kMargin / strains[i]) * kMargin, 1e-9 * step_mm));
      }
    }
  }
  /// What the galvo reaches, less what the slope adds: never beyond the limit on a plane.
  static std::vector<double> first_discs(const SplitRequest& request) {
    std::vector<double> radius_mm;
    radius_mm.reserve(request.targets.size());
    for (const SurfacePoint& target : request.targets) {
      radius_mm.push_back(kMargin * request.limits.displacement_mm * target.normal.z());
    }
    return radius_mm;
  }
};

}  // namespace

std::unique_ptr<Splitter> optimal_splitter() {
  return std::make_unique<OptimalSplitter>();
}

}  // namespace gravure::texture
