#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// The side of a triangle mesh that faces the head, by projection along z. Points lie on the triangles; normals are
/// interpolated between those of the corners (each the mean of the triangles that meet there, by angle), so that they
/// are continuous. Corners at one place are one corner. A sheet wound the other way is turned over; triangles that face
/// away from the head (the underside of a body) are left out.
///
/// bad_argument for corners that are not there or not finite, or where no triangle faces the head. project() fails with
/// out_of_range where there is no triangle, and where the mesh folds: where more than one sheet faces the head.
Result<std::unique_ptr<Surface>> mesh_surface(std::span<const Vector3> vertices_mm,
                                              std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace gravure::texture
