#include "gravure/texture/mesh_surface.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "triangle_grid.hpp"

namespace gravure::texture {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// For each vertex the first one at the same place.
std::vector<std::uint32_t> weld(std::span<const Vector3> vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&vertices](std::uint32_t i) {
    return std::make_tuple(vertices[i].x(), vertices[i].y(), vertices[i].z(), i);
  };
  std::sort(order.begin(), order.end(), [&key](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

/// Twice the area, pointing out of the triangle.
Vector3 area_of(std::span<const Vector3> vertices, const Corners& triangle) {
  const Vector3& a = vertices[triangle[0]];
  return (vertices[triangle[1]] - a).cross(vertices[triangle[2]] - a);
}

/// The triangles that face the head, their corners welded; a sheet that faces away as a whole is turned over.
std::vector<Corners> facing_head(std::span<const Vector3> vertices, std::span<const Corners> triangles) {
  double up = 0;
  double down = 0;
  for (const Corners& each : triangles) {
    const double z = area_of(vertices, each).z();
    (z > 0 ? up : down) += std::abs(z);
  }
  constexpr double kBodyShare = 0.99;  // the two sides of a body have the same projected area
  const bool turn = up < kBodyShare * down;
  const std::vector<std::uint32_t> first = weld(vertices);
  std::vector<Corners> facing;
  constexpr double kEdgeOn = 1e-12;  // share of the area that is left in the projection
  for (const Corners& each : triangles) {
    const Vector3 area = area_of(vertices, each) * (turn ? -1 : 1);
    if (area.z() > kEdgeOn * area.norm()) {
      facing.push_back({first[each[0]], first[each[turn ? 2 : 1]], first[each[turn ? 1 : 2]]});
    }
  }
  return facing;
}

/// The mean of the normals that meet at each vertex, each by its angle there.
std::vector<Vector3> vertex_normals(std::span<const Vector3> vertices, const std::vector<Corners>& triangles) {
  std::vector<Vector3> normals(vertices.size(), Vector3::Zero());
  for (const Corners& each : triangles) {
    const Vector3 normal = area_of(vertices, each).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 one = vertices[each[(k + 1) % 3]] - vertices[each[k]];
      const Vector3 other = vertices[each[(k + 2) % 3]] - vertices[each[k]];
      normals[each[k]] += std::atan2(one.cross(other).norm(), one.dot(other)) * normal;
    }
  }
  for (Vector3& normal : normals) {
    normal.normalize();
  }
  return normals;
}

class MeshSurface final : public Surface {
 public:
  MeshSurface(std::vector<Vector3> vertices, std::vector<Corners> triangles)
      : vertices_(std::move(vertices)),
        triangles_(std::move(triangles)),
        normals_(vertex_normals(vertices_, triangles_)),
        grid_(vertices_, triangles_) {}

  Result<void> project(std::span<const Vector2> plane_mm, std::span<SurfacePoint> out) const override {
    for (std::size_t i = 0; i < plane_mm.size(); ++i) {
      bool found = false;
      for (const std::uint32_t triangle : grid_.at(plane_mm[i])) {
        const std::optional<SurfacePoint> hit = point_on(triangles_[triangle], plane_mm[i]);
        if (!hit) {
          continue;
        }
        const double apart_mm = found ? std::abs(hit->position_mm.z() - out[i].position_mm.z()) : 0;
        constexpr double kSameSheet_mm = 1e-6;
        if (apart_mm > kSameSheet_mm) {
          return fold(plane_mm[i], out[i].position_mm.z(), hit->position_mm.z());
        }
        if (!found) {
          out[i] = *hit;
          found = true;
        }
      }
      if (!found) {
        return miss(plane_mm[i]);
      }
    }
    return {};
  }

 private:
  std::optional<SurfacePoint> point_on(const Corners& triangle, const Vector2& at) const {
    const Vector3& a = vertices_[triangle[0]];
    const Vector3& b = vertices_[triangle[1]];
    const Vector3& c = vertices_[triangle[2]];
    const auto twice_area = [&at](const Vector3& p, const Vector3& q) {
      return (p.x() - at.x()) * (q.y() - at.y()) - (p.y() - at.y()) * (q.x() - at.x());
    };
    const Vector3 share(twice_area(b, c), twice_area(c, a), twice_area(a, b));
    const double whole = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    constexpr double kEdge = 1e-9;  // of the area: points on an edge belong to both triangles
    if (share.minCoeff() < -kEdge * whole) {
      return std::nullopt;
    }
    const Vector3 weight = share / whole;
    return SurfacePoint{
        {at.x(), at.y(), weight.dot(Vector3(a.z(), b.z(), c.z()))},
        (weight[0] * normals_[triangle[0]] + weight[1] * normals_[triangle[1]] + weight[2] * normals_[triangle[2]])
            .normalized()};
  }
  static Error fold(const Vector2& at, double one_mm, double other_mm) {
    return {ErrorCode::out_of_range,
            fmt::format("mesh: folds at x = {} mm, y = {} mm: sheets at z = {} mm and z = {} mm face the head; cut "
                        "away what is not to be textured, or turn the workpiece",
                        at.x(), at.y(), std::min(one_mm, other_mm), std::max(one_mm, other_mm))};
  }
  Error miss(const Vector2& at) const {
    const Vector2& low = grid_.low_mm();
    const Vector2& high = grid_.high_mm();
    return {ErrorCode::out_of_range,
            fmt::format("mesh: the projection misses at x = {} mm, y = {} mm: no triangle there faces the head; those "
                        "that do lie from {} to {} mm in x and from {} to {} mm in y",
                        at.x(), at.y(), low.x(), high.x(), low.y(), high.y())};
  }

  std::vector<Vector3> vertices_;
  std::vector<Corners> triangles_;
  std::vector<Vector3> normals_;
  TriangleGrid grid_;
};

}  // namespace

Result<std::unique_ptr<Surface>> mesh_surface(std::span<const Vector3> vertices_mm,
                                              std::span<const Corners> triangles) {
  for (std::size_t i = 0; i < vertices_mm.size(); ++i) {
    if (!vertices_mm[i].allFinite()) {
      return Error{ErrorCode::bad_argument, fmt::format("mesh: corner {} is not finite", i)};
    }
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t most = *std::max_element(triangles[i].begin(), triangles[i].end());
    if (most >= vertices_mm.size()) {
      return Error{ErrorCode::bad_argument,
                   fmt::format("mesh: triangle {} has corner {}, there are {}", i, most, vertices_mm.size())};
    }
  }
  std::vector<Corners> facing = facing_head(vertices_mm, triangles);
  if (facing.empty()) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("mesh of {} triangles: none of them can be seen along z", triangles.size())};
  }
  return std::unique_ptr<Surface>(
      std::make_unique<MeshSurface>(std::vector<Vector3>(vertices_mm.begin(), vertices_mm.end()), std::move(facing)));
}

}  // namespace gravure::texture
