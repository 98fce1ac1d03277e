#pragma once

#include "icp.hpp"

namespace gravure::registration {

struct FoundStart {
  Similarity pose;         ///< scan to CAD
  double radius_mm = 0;    ///< within which the next iterations should look
  bool ambiguous = false;  ///< another pose fits nearly as well
  int iterations = 0;
};

/// Tries `given` and the frames of the principal axes, each turned every way that the axes leave open, by short
/// iterations on few points; the best by truncated squares of distances, normals that face the other way counting as
/// far off. A pose found from `given` wins unless another fits clearly better. `with_scale`: the scan may be of
/// another size.
FoundStart search_start(const CadSurface& cad, const ScanPoints& scan, const Similarity& given, bool with_scale);

}  // namespace gravure::registration
