#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "gravure/registration/register_scan.hpp"
#include "kd_tree.hpp"
#include "vectors.hpp"

namespace gravure::registration {

enum class Facing : std::uint8_t {
  oriented,    ///< normals point out of the material
  unoriented,  ///< either way round: estimated
  none,        ///< neighbours make no surface: distances are those of points
};

/// Samples of the CAD surface with what registration asks about them.
struct CadSurface {
  Vectors points;
  Vectors normals;
  std::unique_ptr<KdTree> tree;
  Facing facing = Facing::oriented;
  bool flat_facets = false;  ///< normals are those of triangles: planes are exact
  double spacing_mm = 0;     ///< side of the square that a sample stands for, where they are sparse
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_mm = 0;  ///< rms distance from the centre

  /// Distance of `place` from the surface at its nearest sample, and how far beside that sample it is.
  struct Offset {
    double along_normal = 0;
    double beside = 0;
  };
  Offset offset(const Eigen::Vector3d& place, std::size_t sample) const;
};

Result<CadSurface> make_cad_surface(const CadModel& cad);

/// Mean and rms distance from it.
std::pair<Eigen::Vector3d, double> centre_and_radius(const Vectors& points);

}  // namespace gravure::registration
