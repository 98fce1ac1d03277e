#pragma once

#include <vector>

#include "gravure/registration/refine_contours.hpp"
#include "icp.hpp"

namespace gravure::registration {

/// How far each point of a contour is to be shifted along the surface's normal, after its pose: the mean distance of
/// the scan points around it, smoothed along the contour by a penalty on second differences, so that points without
/// scan around them follow their neighbours. Distance along the surface is not observable and stays.
Vectors bend_contour(const CadSurface& cad, const ScanPoints& crop, const Similarity& pose,
                     const std::vector<double>& residuals, const Vectors& contour, const ContourOptions& options);

}  // namespace gravure::registration
