#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gravure/core/contour.hpp"
#include "gravure/core/error.hpp"
#include "gravure/registration/register_scan.hpp"

namespace gravure::registration {

struct ContourOptions {
  bool with_scale = false;
  static constexpr double kLeastMm = 0.01;  ///< of crop_mm and bend_mm
  static constexpr double kMostMm = 10'000;
  double crop_mm = 5;            ///< scan points so near a contour say where it lies
  bool bend = false;             ///< also shift each point of a contour out of the surface, as the scan does around it
  double bend_mm = 5;            ///< bending shorter than this is smoothed away
  double weak_share = 1e-2;      ///< as of RegistrationOptions; what is weak here is kept from the pose of the whole
  Progress* progress = nullptr;  ///< told after each contour
};

/// A contour brought from the CAD onto the scan.
struct PlacedContour {
  Contour contour;               ///< in the frame of the scan; directions are turned, not stretched
  bool refined = false;          ///< false: too few points around it, or no agreement; it lies as the whole pose has it
  std::int64_t scan_points = 0;  ///< around it, that lie on the surface
  double rms_mm = 0;             ///< of their distances
  double moved_mm = 0;           ///< how far its points are from where the whole pose has them, at most
  int weak_directions = 0;       ///< kept from the whole pose
};

/// Lays each contour on the scan by the points within crop_mm of it alone, starting from the pose of the whole part;
/// between contours that lie near each other corrections go over smoothly, weighted by exp(-(distance / crop_mm)^2 /
/// 2). bad_argument as of register_scan(), and for lengths that are not above 0.
Result<std::vector<PlacedContour>> refine_contours(const CadModel& cad, const PointSet& scan, const Registration& whole,
                                                   std::span<const Contour> contours, const ContourOptions& options);

}  // namespace gravure::registration
