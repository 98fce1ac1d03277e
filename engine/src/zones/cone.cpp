#include "gravure/zones/cone.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace gravure::zones {
namespace {

/// Angles that differ by less are equal: rounding of a cross product.
constexpr double kEqual = 1e-14;

/// Squared chords that differ by less may be of angles in another order, by rounding.
constexpr double kSameChord = 1 - 1e-9;

/// The direction farthest from an axis, by the chord between them: it grows as the angle does, and costs no arc
/// tangent.
const Vector3& farthest_of(const Vector3& axis, std::span<const Vector3> directions) noexcept {
  return *std::max_element(directions.begin(), directions.end(), [&axis](const Vector3& a, const Vector3& b) {
    return (a - axis).squaredNorm() < (b - axis).squaredNorm();
  });
}

/// The axis that is equally far from three directions, on their side.
std::optional<Vector3> axis_of_three(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 normal = (b - a).cross(c - a);
  const double length = normal.norm();
  if (!(length > 0)) {
    return std::nullopt;
  }
  const Vector3 axis = normal / length;
  return axis.dot(a) >= 0 ? axis : Vector3(-axis);
}

/// The smallest cone round at most four directions: by one of them, two, or three.
Cone small_cone(std::span<const Vector3> of, std::vector<Vector3>& basis) {
  Cone best{of[0], 4};
  const auto offer = [&](const std::optional<Vector3>& axis, std::vector<Vector3> standing_on) {
    const double angle = axis && axis->allFinite() ? largest_angle_from(*axis, of) : 4;
    if (angle < best.half_angle_rad - kEqual) {
      best = {*axis, angle};
      basis = std::move(standing_on);
    }
  };
  for (std::size_t i = 0; i < of.size(); ++i) {
    offer(of[i], {of[i]});
  }
  for (std::size_t i = 0; i < of.size(); ++i) {
    for (std::size_t j = i + 1; j < of.size(); ++j) {
      offer((of[i] + of[j]).normalized(), {of[i], of[j]});
    }
  }
  for (std::size_t i = 0; i < of.size(); ++i) {
    for (std::size_t j = i + 1; j < of.size(); ++j) {
      for (std::size_t k = j + 1; k < of.size(); ++k) {
        offer(axis_of_three(of[i], of[j], of[k]), {of[i], of[j], of[k]});
      }
    }
  }
  return best;
}

}  // namespace

double angle_between(const Vector3& a, const Vector3& b) noexcept {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Result<Cone> enclosing_cone(std::span<const Vector3> directions) {
  if (directions.empty()) {
    return Error{ErrorCode::bad_argument, "a cone needs one direction or more"};
  }
  // The direction farthest outside joins those that the cone stands on; each time the cone grows, so it ends.
  std::vector<Vector3> basis{directions[0]};
  Cone cone{directions[0], 0};
  constexpr int kMostRounds = 1000;
  for (int round = 0; round < kMostRounds; ++round) {
    const Vector3& farthest = farthest_of(cone.axis, directions);
    const double angle = angle_between(cone.axis, farthest);
    if (angle <= cone.half_angle_rad + kEqual) {
      break;
    }
    std::vector<Vector3> four = basis;
    four.push_back(farthest);
    const Cone next = small_cone(four, basis);
    if (!(next.half_angle_rad > cone.half_angle_rad)) {
      break;
    }
    cone = next;
  }
  cone.half_angle_rad = largest_angle_from(cone.axis, directions);
  if (!(cone.half_angle_rad < std::numbers::pi / 2)) {
    return Error{ErrorCode::out_of_range, "no cone below 90 degrees holds all directions: they point to all sides"};
  }
  return cone;
}

double largest_angle_from(const Vector3& axis, std::span<const Vector3> directions) noexcept {
  double longest = 0;
  for (const Vector3& direction : directions) {
    longest = std::max(longest, (direction - axis).squaredNorm());
  }
  double most = 0;
  for (const Vector3& direction : directions) {
    if ((direction - axis).squaredNorm() >= longest * kSameChord) {
      most = std::max(most, angle_between(axis, direction));
    }
  }
  return most;
}

double largest_angle(std::span<const Vector3> directions) noexcept {
  double longest = 0;
  double most = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const std::span<const Vector3> others = directions.subspan(i);
    const double chord = (farthest_of(directions[i], others) - directions[i]).squaredNorm();
    if (chord >= longest * kSameChord) {
      most = std::max(most, largest_angle_from(directions[i], others));
      longest = std::max(longest, chord);
    }
  }
  return most;
}

}  // namespace gravure::zones
