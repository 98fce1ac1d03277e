#include "gravure/texture/clamping.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gravure::texture {
namespace {

Eigen::Matrix3d turn_of(const Clamping& clamping) {
  return (Eigen::AngleAxisd(clamping.about_y_rad, Vector3::UnitY()) *
          Eigen::AngleAxisd(clamping.about_x_rad, Vector3::UnitX()))
      .toRotationMatrix();
}

/// The clamping that turns z by `tilt` towards `direction` of the plane.
Clamping leaning(double tilt_rad, double direction_rad) {
  const Vector3 z(std::sin(tilt_rad) * std::cos(direction_rad), std::sin(tilt_rad) * std::sin(direction_rad),
                  std::cos(tilt_rad));
  const double about_x_rad = std::asin(-z.y());  // Ry Rx z = (sin y cos x, -sin x, cos y cos x)
  return {about_x_rad, std::atan2(z.x(), z.z())};
}

}  // namespace

Split clamped(Split split, const Clamping& clamping) {
  const Eigen::Matrix3d turn = turn_of(clamping);
  for (auto* points : {&split.targets, &split.stages}) {
    for (SurfacePoint& each : *points) {
      each = {turn * each.position_mm, turn * each.normal};
    }
  }
  return split;
}

CTravel c_travel(std::span<const SurfacePoint> stages, double step_mm, const Clamping& clamping) {
  const Eigen::Matrix3d turn = turn_of(clamping);
  CTravel travel;
  travel.nearest_pole_rad = std::numbers::pi;
  Vector2 before = Vector2::Zero();
  for (const SurfacePoint& stage : stages) {
    const Vector3 normal = turn * stage.normal;
    const Vector2 now = normal.head<2>();
    travel.nearest_pole_rad = std::min(travel.nearest_pole_rad, std::atan2(now.norm(), normal.z()));
    constexpr double kPole = 1e-12;  // as the inverse of the axes has it: C stays
    if (now.norm() <= kPole) {
      continue;
    }
    const double step_rad =
        before.isZero(0) ? 0 : std::abs(std::atan2(before.x() * now.y() - before.y() * now.x(), before.dot(now)));
    travel.turns += step_rad / (2 * std::numbers::pi);
    travel.max_rate_rad_per_mm = std::max(travel.max_rate_rad_per_mm, step_rad / step_mm);
    before = now;
  }
  return travel;
}

Result<ClampingAdvice> advise_clamping(std::span<const SurfacePoint> stages, double step_mm, double most_tilt_rad,
                                       const CancelToken& cancel) {
  constexpr std::size_t kPoints = 8192;
  const std::size_t stride = stages.size() / kPoints + 1;
  std::vector<SurfacePoint> some;
  for (std::size_t i = 0; i < stages.size(); i += stride) {
    some.push_back(stages[i]);
  }
  struct Trial {
    Clamping clamping;
    double rate;
  };
  std::vector<Trial> trials;  // smallest tilts first
  constexpr int kDirections = 24;
  constexpr double kDegree = std::numbers::pi / 180;
  for (double tilt_rad = 0; tilt_rad <= most_tilt_rad * (1 + 1e-12); tilt_rad += kDegree) {
    if (cancel.cancelled()) {
      return Error{ErrorCode::cancelled, "stopped while a clamping was sought"};
    }
    for (int i = 0; i < (trials.empty() ? 1 : kDirections); ++i) {
      const Clamping clamping = leaning(tilt_rad, 2 * std::numbers::pi * i / kDirections);
      trials.push_back({clamping, c_travel(some, step_mm * static_cast<double>(stride), clamping).max_rate_rad_per_mm});
    }
  }
  const auto slower = [](const Trial& a, const Trial& b) { return a.rate < b.rate; };
  const double slowest = std::min_element(trials.begin(), trials.end(), slower)->rate;
  constexpr double kAlmost = 1.2;
  const auto chosen = std::find_if(trials.begin(), trials.end(),
                                   [slowest](const Trial& trial) { return trial.rate <= kAlmost * slowest; });
  ClampingAdvice advice;
  advice.clamping = chosen->clamping;
  advice.flat = c_travel(stages, step_mm, {});
  advice.tilted = c_travel(stages, step_mm, advice.clamping);
  constexpr double kPays = 0.8;
  advice.pays = advice.tilted.max_rate_rad_per_mm < kPays * advice.flat.max_rate_rad_per_mm;
  return advice;
}

}  // namespace gravure::texture
