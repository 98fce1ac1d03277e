#include "start_search.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace gravure::registration {
namespace {

constexpr std::size_t kStartPoints = 300;
constexpr std::size_t kGivenPoints = 800;  // a near start is tried with care: little of the scan may be on the CAD
constexpr std::size_t kMorePoints = 1500;
constexpr int kShortIterations = 12;
constexpr int kLongIterations = 40;
constexpr std::size_t kKept = 3;
// Shares of the CAD's radius.
constexpr double kWideRadius = 0.35;
constexpr double kMiddleRadius = 0.08;
constexpr double kNarrowRadius = 0.02;
constexpr double kRoughDistance = 0.05;
constexpr double kFineDistance = 0.01;
constexpr double kAlike = 0.8;        // ratio of spreads from which two axes may be taken for each other
constexpr double kHopeless = 0.5;     // of the best pose's fit: not worth more iterations
constexpr double kSameShare = 0.97;   // of the best pose's inliers: the part has another pose
constexpr double kGivenCounts = 1.1;  // what lies near the start given wins between poses that fit alike
constexpr double kAnotherTurn = 0.1;  // rad

struct Candidate {
  Similarity pose;
  double radius_mm = 0;
  bool from_given = false;
  double misfit = 1;
};

struct PrincipalFrame {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;  ///< columns, least spread first, right-handed
  Eigen::Vector3d spread;
};

PrincipalFrame principal_frame(const Vectors& points) {
  PrincipalFrame frame;
  frame.centre = centre_and_radius(points).first;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    sum += (point - frame.centre) * (point - frame.centre).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  frame.axes = solver.eigenvectors();
  frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  frame.spread = solver.eigenvalues();
  return frame;
}

/// Turns by which one principal frame may differ from another: by half a turn about each axis, and by every 30 degrees
/// about an axis across which the points spread alike.
std::vector<Eigen::Matrix3d> open_turns(const Eigen::Vector3d& spread) {
  constexpr int kSteps = 6;
  std::vector<Eigen::Matrix3d> turns;
  for (const Eigen::Vector3d& signs :
       {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, -1), Eigen::Vector3d(-1, 1, -1), Eigen::Vector3d(-1, -1, 1)}) {
    turns.emplace_back(signs.asDiagonal());
  }
  const auto turn_about = [&](int axis) {
    const std::vector<Eigen::Matrix3d> before = turns;
    for (int step = 1; step < kSteps; ++step) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(std::numbers::pi / kSteps * step, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
      for (const Eigen::Matrix3d& other : before) {
        turns.emplace_back(other * turn);
      }
    }
  };
  if (spread[0] > kAlike * spread[1]) {
    turn_about(2);
  }
  if (spread[1] > kAlike * spread[2]) {
    turn_about(0);
  }
  return turns;
}

std::vector<Candidate> candidates(const CadSurface& cad, const ScanPoints& scan, const Similarity& given) {
  std::vector<Candidate> all;
  for (const double radius : {kNarrowRadius, kMiddleRadius, kWideRadius}) {
    all.push_back({given, radius * cad.radius_mm, true});
  }
  const PrincipalFrame from = principal_frame(scan.points);
  const PrincipalFrame to = principal_frame(cad.points);
  for (const Eigen::Matrix3d& turn : open_turns(from.spread)) {
    Similarity pose;
    pose.rotation = to.axes * turn * from.axes.transpose();
    pose.translation_mm = to.centre - pose.rotation * from.centre;
    all.push_back({pose, kWideRadius * cad.radius_mm});
  }
  return all;
}

/// Mean over all points of the squared distance as a share of that at `far`, 1 for those further off.
double misfit(const CadSurface& cad, const ScanPoints& scan, const Similarity& pose, double far) {
  double sum = static_cast<double>(scan.points.size());
  for (const Pair& pair : find_pairs(cad, scan, pose, far)) {
    sum -= 1 - pair.distance * pair.distance / (far * far);
  }
  return sum / static_cast<double>(scan.points.size());
}

int improve(const CadSurface& cad, const ScanPoints& scan, IcpSettings settings, double far, Candidate& candidate) {
  settings.radius_mm = candidate.radius_mm;
  const IcpState state = icp(cad, scan, candidate.pose, settings);
  candidate.pose = state.pose;
  candidate.radius_mm = state.radius_mm;
  candidate.misfit = misfit(cad, scan, state.pose, far);
  return state.iterations;
}

bool is_another(const CadSurface& cad, const Similarity& a, const Similarity& b) {
  const Similarity between = composed(a, b.inverse());
  return Eigen::AngleAxisd(between.rotation).angle() > kAnotherTurn ||
         (between.point(cad.centre) - cad.centre).norm() > kAnotherTurn * cad.radius_mm;
}

void best_first(std::vector<Candidate>& all) {
  const auto fit = [](const Candidate& one) { return (1 - one.misfit) * (one.from_given ? kGivenCounts : 1); };
  std::stable_sort(all.begin(), all.end(), [&](const Candidate& a, const Candidate& b) { return fit(a) > fit(b); });
}

ScanPoints about(const ScanPoints& scan, std::size_t count) {
  return thinned(scan, std::max<std::size_t>(1, scan.points.size() / count));
}

/// The best few that are different poses.
std::vector<Candidate> best_poses(const CadSurface& cad, std::vector<Candidate>& all) {
  best_first(all);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : all) {
    const bool known = std::any_of(
        kept.begin(), kept.end(), [&](const Candidate& other) { return !is_another(cad, candidate.pose, other.pose); });
    const bool hopeless = 1 - candidate.misfit < kHopeless * (1 - all.front().misfit);
    if (!known && !hopeless && kept.size() < kKept) {
      kept.push_back(candidate);
    }
  }
  return kept;
}

}  // namespace

FoundStart search_start(const CadSurface& cad, const ScanPoints& scan, const Similarity& given, bool with_scale) {
  FoundStart found;
  IcpSettings settings;
  settings.least_step = 1e-4;
  settings.most_iterations = kShortIterations;
  const ScanPoints few = about(scan, kStartPoints);
  std::vector<Candidate> all = candidates(cad, few, given);
  const ScanPoints for_given = about(scan, kGivenPoints);
  for (Candidate& candidate : all) {
    found.iterations +=
        improve(cad, candidate.from_given ? for_given : few, settings, kRoughDistance * cad.radius_mm, candidate);
  }
  std::vector<Candidate> kept = best_poses(cad, all);
  settings.most_iterations = kLongIterations;
  const ScanPoints more = about(scan, kMorePoints);
  for (Candidate& candidate : kept) {
    candidate.radius_mm = std::max(candidate.radius_mm, kMiddleRadius * cad.radius_mm);
    found.iterations += improve(cad, more, settings, kFineDistance * cad.radius_mm, candidate);
  }
  if (with_scale) {
    best_first(kept);
    const double best = 1 - kept.front().misfit;
    settings.with_scale = true;
    for (Candidate& candidate : kept) {
      if (1 - candidate.misfit < kHopeless * best) {
        continue;
      }
      candidate.radius_mm *= 2;
      found.iterations += improve(cad, more, settings, kFineDistance * cad.radius_mm, candidate);
    }
  }
  best_first(kept);
  found.pose = kept.front().pose;
  found.radius_mm = kept.front().radius_mm;
  for (std::size_t i = 1; i < kept.size(); ++i) {
    found.ambiguous = found.ambiguous || (is_another(cad, kept[i].pose, found.pose) &&
                                          1 - kept[i].misfit > kSameShare * (1 - kept.front().misfit));
  }
  return found;
}

}  // namespace gravure::registration
