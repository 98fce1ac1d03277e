#include "gravure/registration/register_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cad_surface.hpp"
#include "keep_start.hpp"
#include "morton.hpp"
#include "polish.hpp"
#include "start_search.hpp"
#include "weak_directions.hpp"

namespace gravure::registration {
namespace {

constexpr std::size_t kFewPoints = 5000;
constexpr double kWidestFit = 0.05;  // of the CAD's radius: points spread further from the surface are of another part
constexpr double kEstimatedWeakShare = 1e-3;  // what estimated normals are off by holds no direction

Error out(const std::string& field, double value, const std::string& allowed) {
  return {ErrorCode::bad_argument, fmt::format("{} = {}: must be {}", field, value, allowed)};
}

Result<void> check_options(const RegistrationOptions& options) {
  if (!(options.most_scale > 1 && options.most_scale <= 10)) {
    return out("most_scale", options.most_scale, "above 1, at most 10");
  }
  if (!(options.scale_deviation > 0 && options.scale_deviation <= 1e6)) {
    return out("scale_deviation", options.scale_deviation, "above 0, at most 1e6");
  }
  if (!(options.weak_share > 0 && options.weak_share < 0.1)) {
    return out("weak_share", options.weak_share, "above 0 and below 0.1");
  }
  if (options.most_iterations < 1) {
    return out("most_iterations", options.most_iterations, "1 or more");
  }
  const Eigen::Matrix4d start = options.start.matrix();
  if (!start.allFinite() || !(options.start.scale > 0) ||
      !(options.start.rotation * options.start.rotation.transpose()).isIdentity(1e-9)) {
    return Error{ErrorCode::bad_argument, "start: must be a rotation, a shift and a scale above 0"};
  }
  return {};
}

Result<void> check_scan(const PointSet& scan) {
  if (scan.points_mm.size() < kFewestPoints || scan.points_mm.size() > kMostPoints) {
    return Error{ErrorCode::bad_argument,
                 "scan: " + std::to_string(scan.points_mm.size()) + " points: must be 30 to 20 million"};
  }
  if (!scan.normals.empty() && scan.normals.size() != scan.points_mm.size()) {
    return Error{ErrorCode::bad_argument, "scan: " + std::to_string(scan.normals.size()) + " normals for " +
                                              std::to_string(scan.points_mm.size()) +
                                              " points: must be none or as many"};
  }
  for (std::size_t i = 0; i < scan.points_mm.size(); ++i) {
    if (!vector(scan.points_mm[i]).allFinite()) {
      return Error{ErrorCode::bad_argument, "scan: point " + std::to_string(i) + " is not finite: leave it out"};
    }
  }
  return {};
}

ScanPoints in_order(const PointSet& scan, const std::vector<std::uint32_t>& order) {
  ScanPoints sorted;
  sorted.points.reserve(order.size());
  for (const std::uint32_t i : order) {
    sorted.points.push_back(vector(scan.points_mm[i]));
    if (!scan.normals.empty()) {
      sorted.normals.push_back(vector(scan.normals[i]));
    }
  }
  return sorted;
}

/// Of scale 1; `place` comes where it did.
Similarity unscaled(Similarity pose, const Eigen::Vector3d& place) {
  pose.translation_mm += (pose.scale - 1) * (pose.rotation * place);
  pose.scale = 1;
  return pose;
}

/// Rigid, then with scale where it is asked for and held.
IcpState pose_of_few(const CadSurface& cad, const ScanPoints& few, const FoundStart& start, IcpSettings& settings,
                     Registration& result) {
  settings.radius_mm = start.radius_mm;
  const bool with_scale = settings.with_scale;
  settings.with_scale = false;
  IcpState state = icp(cad, few, start.pose, settings);
  result.iterations = start.iterations + state.iterations;
  if (!with_scale || state.system.count() == 0) {
    return state;
  }
  result.scale_refused = !state.system.holds_scale(settings.weak_share);
  if (result.scale_refused) {  // nor may it keep the scale that the search has tried
    settings.radius_mm = 3 * state.radius_mm;
    state = icp(cad, few, unscaled(state.pose, centre_and_radius(few.points).first), settings);
    result.iterations += state.iterations;
    return state;
  }
  settings.with_scale = true;
  settings.radius_mm = 3 * state.radius_mm;
  state = icp(cad, few, state.pose, settings);
  result.iterations += state.iterations;
  return state;
}

void describe(const CadSurface& cad, const IcpState& state, const IcpSettings& settings, Registration& result) {
  result.cad_to_scan = state.pose.inverse();
  result.rms_mm = state.system.rms();
  result.converged = state.converged && state.radius_mm < kWidestFit * cad.radius_mm;
  const int unknowns = settings.with_scale ? kAllUnknowns : kRigidUnknowns;
  describe_weak_directions(state.system, unknowns, cad.centre, cad.radius_mm, settings.weak_share, result);
  result.degenerate = !result.weak_directions.empty();
}

}  // namespace

Result<Registration> register_scan(const CadModel& cad_model, const PointSet& scan,
                                   const RegistrationOptions& options) {
  GRAVURE_CHECK(check_options(options));
  GRAVURE_CHECK(check_scan(scan));
  const auto done = [&options](int steps) {
    if (options.progress != nullptr) {
      options.progress->update(steps, kRegistrationSteps);
    }
  };
  done(0);
  GRAVURE_TRY(const CadSurface cad, make_cad_surface(cad_model));
  done(1);
  const std::vector<std::uint32_t> order = morton_order(vectors(scan.points_mm));
  const ScanPoints points = in_order(scan, order);
  const ScanPoints few = thinned(points, std::max<std::size_t>(1, points.points.size() / kFewPoints));

  Registration result;
  IcpSettings settings;
  settings.with_scale = options.with_scale;
  settings.weak_share =
      cad.facing == Facing::oriented ? options.weak_share : std::max(options.weak_share, kEstimatedWeakShare);
  settings.most_scale = options.most_scale;
  settings.scale_deviation = options.scale_deviation;
  settings.most_iterations = options.most_iterations;
  const FoundStart start = search_start(cad, points, options.start.inverse(), options.with_scale);
  result.ambiguous = start.ambiguous;
  done(2);
  const IcpState rough = pose_of_few(cad, few, start, settings, result);
  done(3);
  std::vector<double> residuals;
  IcpState state = polish(cad, points, rough, settings, &residuals);
  result.kept_as_started = keep_start(cad, points, options.start.inverse(), settings, state, residuals);
  done(kRegistrationSteps);
  result.iterations += state.iterations - rough.iterations;
  result.scan_points = static_cast<std::int64_t>(points.points.size());
  result.residuals_mm.assign(points.points.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    result.residuals_mm[order[i]] = residuals[i];
    result.inliers += std::isfinite(residuals[i]) ? 1 : 0;
  }
  if (result.inliers < static_cast<std::int64_t>(kFewestPairs)) {
    return Error{ErrorCode::out_of_range,
                 "scan: " + std::to_string(result.inliers) + " of " + std::to_string(result.scan_points) +
                     " points come to lie on the CAD from any start: are both in mm, and of the same part?"};
  }
  describe(cad, state, settings, result);
  return result;
}

}  // namespace gravure::registration
