#include "gravure/registration/refine_contours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "bend_contour.hpp"
#include "cad_surface.hpp"
#include "polish.hpp"

namespace gravure::registration {
namespace {

constexpr std::size_t kFewestScanPoints = 100;
constexpr std::size_t kBlended = 8;      // contours whose corrections count for one
constexpr double kFirstRadiusRms = 10;   // of the whole pose's rms: local bending is larger than noise
constexpr double kMostMovedCrops = 0.5;  // a contour that moves further has found something else

/// Points of the contour and between them, at most `step_mm` apart.
Vectors dense(const Contour& contour, double step_mm) {
  constexpr double kMostSteps = 1e5;
  Vectors all{vector(contour.points_mm.front())};
  for (std::size_t i = 1; i < contour.points_mm.size(); ++i) {
    const Eigen::Vector3d from = vector(contour.points_mm[i - 1]);
    const Eigen::Vector3d to = vector(contour.points_mm[i]);
    const double steps = std::clamp(std::ceil((to - from).norm() / step_mm), 1.0, kMostSteps);
    for (double k = 1; k <= steps; ++k) {
      all.push_back(from + (to - from) * (k / steps));
    }
  }
  return all;
}

ScanPoints brought_back(const PointSet& scan, const Similarity& cad_to_scan) {
  const Similarity back = cad_to_scan.inverse();
  ScanPoints placed{vectors(scan.points_mm), vectors(scan.normals)};
  for (Eigen::Vector3d& point : placed.points) {
    point = back.point(point);
  }
  for (Eigen::Vector3d& normal : placed.normals) {
    normal = back.direction(normal);
  }
  return placed;
}

/// Scan points as the pose of the whole part has them on the CAD.
struct Placed {
  explicit Placed(ScanPoints points) : scan(std::move(points)), tree(scan.points) {}
  ScanPoints scan;
  KdTree tree;
};

ScanPoints cropped(const Placed& placed, const Contour& contour, double crop_mm) {
  std::vector<std::size_t> near;
  for (const Eigen::Vector3d& place : dense(contour, crop_mm / 2)) {
    placed.tree.within(place, crop_mm, near);
    if (near.size() > 4 * placed.scan.points.size()) {
      std::sort(near.begin(), near.end());
      near.erase(std::unique(near.begin(), near.end()), near.end());
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  ScanPoints crop;
  for (const std::size_t i : near) {
    crop.points.push_back(placed.scan.points[i]);
    if (!placed.scan.normals.empty()) {
      crop.normals.push_back(placed.scan.normals[i]);
    }
  }
  return crop;
}

/// A contour's own correction, in the frame of the CAD: where the points of the CAD are, seen from the whole pose.
struct Correction {
  Similarity by;
  Vectors points;  ///< of the contour
  Vectors bends;   ///< what bending adds to each; empty for none
};

double most_moved(const Correction& correction) {
  double most = 0;
  for (const Eigen::Vector3d& point : correction.points) {
    most = std::max(most, (correction.by.point(point) - point).norm());
  }
  return most;
}

IcpSettings settings_for(const CadSurface& cad, const ScanPoints& crop, double whole_rms,
                         const ContourOptions& options) {
  IcpSettings settings;
  settings.radius_mm = std::min(options.crop_mm, std::max(kFirstRadiusRms * whole_rms, 2 * cad.spacing_mm));
  settings.with_scale = options.with_scale;
  settings.weak_share = options.weak_share;
  settings.least_step = 2e-5;  // few points: pairs go to and fro by more than those of the whole
  std::tie(settings.centre, settings.length_mm) = centre_and_radius(crop.points);
  return settings;
}

Correction correct(const CadSurface& cad, const Placed& placed, double whole_rms, const Contour& contour,
                   const ContourOptions& options, PlacedContour& result) {
  Correction correction{{}, vectors(contour.points_mm), {}};
  const ScanPoints crop = cropped(placed, contour, options.crop_mm);
  if (crop.points.size() < kFewestScanPoints) {
    return correction;
  }
  IcpSettings settings = settings_for(cad, crop, whole_rms, options);
  if (!(settings.length_mm > 0)) {
    return correction;
  }
  settings.with_scale = false;
  IcpState rough = icp(cad, crop, {}, settings);
  settings.with_scale = options.with_scale && rough.system.count() > 0 &&
                        rough.system.holds_scale(settings.weak_share);  // else as of the whole
  if (settings.with_scale) {
    rough = icp(cad, crop, rough.pose, settings);
  }
  std::vector<double> residuals;
  const IcpState state = polish(cad, crop, rough, settings, &residuals);
  correction.by = state.pose.inverse();
  result.scan_points = state.system.count();
  result.rms_mm = state.system.rms();
  result.refined = state.converged && most_moved(correction) <= kMostMovedCrops * options.crop_mm;
  if (!result.refined) {
    correction.by = {};
    return correction;
  }
  result.weak_directions =
      state.system.weak_directions(settings.with_scale ? kAllUnknowns : kRigidUnknowns, settings.weak_share);
  if (options.bend) {
    correction.bends = bend_contour(cad, crop, state.pose, residuals, correction.points, options);
  }
  return correction;
}

double nearest_distance(const Vectors& points, const Eigen::Vector3d& place) {
  double least2 = std::numeric_limits<double>::max();
  for (const Eigen::Vector3d& point : points) {
    least2 = std::min(least2, (point - place).squaredNorm());
  }
  return std::sqrt(least2);
}

/// The corrections of the contour and its neighbours, each the less the further it is from the place.
Eigen::Vector3d blended(const std::vector<Correction>& corrections, const std::vector<Neighbour>& near,
                        const Eigen::Vector3d& place, double length_mm) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0;
  for (const Neighbour& neighbour : near) {
    const Correction& other = corrections[static_cast<std::size_t>(neighbour.index)];
    const double away = nearest_distance(other.points, place) / length_mm;
    const double weight = std::exp(-away * away / 2);
    sum += weight * (other.by.point(place) - place);
    weights += weight;
  }
  return place + sum / weights;
}

void place(const Contour& contour, const std::vector<Correction>& corrections, const Correction& own,
           const std::vector<Neighbour>& near, const Similarity& cad_to_scan, const ContourOptions& options,
           PlacedContour& result) {
  result.contour = contour;
  for (std::size_t k = 0; k < own.points.size(); ++k) {
    Eigen::Vector3d there = blended(corrections, near, own.points[k], options.crop_mm);
    if (!own.bends.empty()) {
      there += own.bends[k];
    }
    result.moved_mm = std::max(result.moved_mm, (there - own.points[k]).norm());
    result.contour.points_mm[k] = point3(cad_to_scan.point(there));
  }
  result.contour.direction = point3(cad_to_scan.direction(own.by.direction(vector(contour.direction))));
}

Result<void> check(const ContourOptions& options) {
  for (const auto& [name, value] : {std::pair{"crop_mm", options.crop_mm}, {"bend_mm", options.bend_mm}}) {
    if (!(value >= ContourOptions::kLeastMm && value <= ContourOptions::kMostMm)) {
      return Error{ErrorCode::out_of_range, fmt::format("{} = {}: must be {} to {}", name, value,
                                                        ContourOptions::kLeastMm, ContourOptions::kMostMm)};
    }
  }
  return {};
}

}  // namespace

Result<std::vector<PlacedContour>> refine_contours(const CadModel& cad_model, const PointSet& scan,
                                                   const Registration& whole, std::span<const Contour> contours,
                                                   const ContourOptions& options) {
  GRAVURE_CHECK(check(options));
  GRAVURE_TRY(const CadSurface cad, make_cad_surface(cad_model));
  if (contours.empty() || scan.points_mm.empty()) {
    return std::vector<PlacedContour>{};
  }
  const Placed placed(brought_back(scan, whole.cad_to_scan));
  std::vector<PlacedContour> results(contours.size());
  std::vector<Correction> corrections;
  Vectors centres;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    corrections.push_back(correct(cad, placed, whole.rms_mm, contours[i], options, results[i]));
    centres.push_back(centre_and_radius(corrections.back().points).first);
    if (options.progress != nullptr) {
      options.progress->update(static_cast<std::int64_t>(i) + 1, static_cast<std::int64_t>(contours.size()));
    }
  }
  const KdTree tree_of_contours(centres);
  std::vector<Neighbour> near;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    tree_of_contours.nearest(centres[i], std::numeric_limits<double>::max(), kBlended, near);
    place(contours[i], corrections, corrections[i], near, whole.cad_to_scan, options, results[i]);
  }
  return results;
}

}  // namespace gravure::registration
