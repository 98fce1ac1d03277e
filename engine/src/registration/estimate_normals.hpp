#pragma once

#include "kd_tree.hpp"
#include "vectors.hpp"

namespace gravure::registration {

struct EstimatedNormals {
  Vectors normals;  ///< of length 1, either way round; 0 where the neighbours are on one line or place
  /// Mean share of the spread of a point's neighbours that is out of their plane: 0 a surface, 1/3 a cloud.
  double roughness = 0;
};

/// The direction in which each point's 12 nearest neighbours spread least.
EstimatedNormals estimate_normals(const Vectors& points, const KdTree& tree);

}  // namespace gravure::registration
