#include "gravure/texture/split.hpp"

#include <fmt/format.h>

#include <numbers>

#include "gravure/texture/splitter.hpp"
#include "splitters.hpp"

namespace gravure::texture {
namespace {

constexpr double kFirstSigma_mm = 30;
constexpr double kNextSigma = 0.95;
constexpr double kDegrees = 180 / std::numbers::pi;

bool within(const DeviationSummary& most, const DeviationLimits& limits) {
  return most.max_focus_mm <= limits.focus_mm && most.max_incidence_rad <= limits.incidence_rad &&
         most.max_displacement_mm <= limits.displacement_mm;
}

/// Says whose points they are where the surface has none.
Result<void> project_stages(const Surface& surface, const std::vector<Vector2>& slow, std::span<SurfacePoint> out) {
  Result<void> projected = surface.project(slow, out);
  if (!projected) {
    return Error{projected.error().code, "the stages' path: " + projected.error().message};
  }
  return projected;
}

/// Every sixteenth point: where these are beyond a limit already, the others need no look.
class Sample {
 public:
  explicit Sample(const std::vector<SurfacePoint>& targets) {
    for (std::size_t i = 0; i < targets.size(); i += kStride) {
      targets_.push_back(targets[i]);
    }
    stages_.resize(targets_.size());
  }
  Result<DeviationSummary> look(const Surface& surface, const std::vector<Vector2>& slow) {
    std::vector<Vector2> some;
    for (std::size_t i = 0; i < slow.size(); i += kStride) {
      some.push_back(slow[i]);
    }
    GRAVURE_CHECK(project_stages(surface, some, stages_));
    return summarise(targets_, stages_);
  }

 private:
  static constexpr std::size_t kStride = 16;
  std::vector<SurfacePoint> targets_;
  std::vector<SurfacePoint> stages_;
};

}  // namespace

std::vector<double> pulse_lengths_mm(const TexturePath& path, std::span<const SurfacePoint> targets) {
  if (!path.pulse_mm.empty()) {
    return path.pulse_mm;
  }
  std::vector<double> lengths(targets.size());
  for (std::size_t i = 1; i < targets.size(); ++i) {
    const bool dark = !path.dark.empty() && path.dark[i];
    lengths[i] = lengths[i - 1] + (dark ? 0 : (targets[i].position_mm - targets[i - 1].position_mm).norm());
  }
  return lengths;
}

Result<Split> split_path(const Splitter& splitter, const Surface& surface, const TexturePath& path,
                         const DeviationLimits& limits, double sigma_mm, const CancelToken& cancel) {
  Split split;
  split.sigma_mm = sigma_mm;
  split.targets.resize(path.points_mm.size());
  split.stages.resize(path.points_mm.size());
  GRAVURE_CHECK(surface.project(path.points_mm, split.targets));
  GRAVURE_TRY(const std::vector<Vector2> slow,
              splitter.stages_mm({surface, path, split.targets, sigma_mm, limits}, cancel));
  GRAVURE_CHECK(project_stages(surface, slow, split.stages));
  split.most = summarise(split.targets, split.stages);
  return split;
}

Result<Split> split_path(const Surface& surface, const TexturePath& path, const GaussianFilter& filter) {
  return split_path(*gaussian_splitter(filter), surface, path, {}, filter.sigma_mm, CancelToken());
}

Result<Split> split_by_published_rule(const Surface& surface, const TexturePath& path, const DeviationLimits& limits,
                                      GaussianFilter filter, const CancelToken& cancel) {
  return split_by_published_rule(*gaussian_splitter(filter), surface, path, limits, cancel);
}

Result<Split> split_by_published_rule(const Splitter& splitter, const Surface& surface, const TexturePath& path,
                                      const DeviationLimits& limits, const CancelToken& cancel) {
  if (splitter.keeps_limits()) {
    return split_path(splitter, surface, path, limits, kFirstSigma_mm, cancel);
  }
  Split split;
  split.targets.resize(path.points_mm.size());
  split.stages.resize(path.points_mm.size());
  GRAVURE_CHECK(surface.project(path.points_mm, split.targets));
  Sample sample(split.targets);
  split.tries = 0;
  for (double sigma_mm = kFirstSigma_mm; sigma_mm >= path.step_mm; sigma_mm *= kNextSigma) {
    if (cancel.cancelled()) {
      return Error{ErrorCode::cancelled, "stopped while sigma was sought"};
    }
    ++split.tries;
    split.sigma_mm = sigma_mm;
    GRAVURE_TRY(const std::vector<Vector2> slow,
                splitter.stages_mm({surface, path, split.targets, sigma_mm, limits}, cancel));
    GRAVURE_TRY(split.most, sample.look(surface, slow));
    if (!within(split.most, limits)) {
      continue;
    }
    GRAVURE_CHECK(project_stages(surface, slow, split.stages));
    split.most = summarise(split.targets, split.stages);
    if (within(split.most, limits)) {
      return split;
    }
  }
  std::string broken;
  for (const std::string& each : violations(split.most, limits)) {
    broken += (broken.empty() ? "" : ", ") + each;
  }
  return Error{
      ErrorCode::out_of_range,
      fmt::format(
          "no sigma from {:.6g} um down to the step of the path, {:.6g} um, meets the limits; the last one leaves "
          "{}: widen them, or take a smoother surface or a finer path",
          kFirstSigma_mm * 1000, path.step_mm * 1000, broken)};
}

std::vector<std::string> violations(const DeviationSummary& most, const DeviationLimits& limits) {
  std::vector<std::string> found;
  if (most.max_focus_mm > limits.focus_mm) {
    found.push_back(
        fmt::format("focus offset {:.6g} um, allowed {:.6g} um", most.max_focus_mm * 1000, limits.focus_mm * 1000));
  }
  if (most.max_incidence_rad > limits.incidence_rad) {
    found.push_back(fmt::format("incidence {:.6g} deg, allowed {:.6g} deg", most.max_incidence_rad * kDegrees,
                                limits.incidence_rad * kDegrees));
  }
  if (most.max_displacement_mm > limits.displacement_mm) {
    found.push_back(
        fmt::format("displacement {:.6g} mm, allowed {:.6g} mm", most.max_displacement_mm, limits.displacement_mm));
  }
  return found;
}

}  // namespace gravure::texture
