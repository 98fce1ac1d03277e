#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "gravure/texture/surface.hpp"

namespace gravure::texture {
namespace {

constexpr double kMostHeight_mm = 10'000;  // what machines are; beyond, doubles have no nanometres left

class SlopeLimited final : public Surface {
 public:
  SlopeLimited(std::unique_ptr<Surface> surface, double most_rad)
      : surface_(std::move(surface)), most_rad_(most_rad), least_z_(std::cos(most_rad)) {}

  Result<void> project(std::span<const Vector2> plane_mm, std::span<SurfacePoint> out) const override {
    GRAVURE_CHECK(surface_->project(plane_mm, out));
    for (std::size_t i = 0; i < plane_mm.size(); ++i) {
      const double z_mm = out[i].position_mm.z();
      if (!(std::abs(z_mm) <= kMostHeight_mm)) {
        return Error{
            ErrorCode::out_of_range,
            fmt::format("surface: z = {:.6g} mm at x = {:.6g} mm, y = {:.6g} mm: must be {} to {} mm; is it in mm?",
                        z_mm, plane_mm[i].x(), plane_mm[i].y(), -kMostHeight_mm, kMostHeight_mm)};
      }
      const Vector3& normal = out[i].normal;
      if (!(normal.z() >= least_z_)) {
        constexpr double kDegrees = 180 / std::numbers::pi;
        return Error{
            ErrorCode::out_of_range,
            fmt::format("surface: slope of {:.6g} deg at x = {:.6g} mm, y = {:.6g} mm, at most {:.6g} deg is allowed; "
                        "turn the workpiece, or allow more",
                        std::atan2(normal.head<2>().norm(), normal.z()) * kDegrees, plane_mm[i].x(), plane_mm[i].y(),
                        most_rad_ * kDegrees)};
      }
    }
    return {};
  }

 private:
  std::unique_ptr<Surface> surface_;
  double most_rad_;
  double least_z_;
};

}  // namespace

std::unique_ptr<Surface> limit_slope(std::unique_ptr<Surface> surface, double most_rad) {
  return std::make_unique<SlopeLimited>(std::move(surface), most_rad);
}

}  // namespace gravure::texture
