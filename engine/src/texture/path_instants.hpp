#pragma once

#include <vector>

#include "gravure/texture/path_timing.hpp"
#include "path_runs.hpp"
#include "path_spline.hpp"
#include "smooth_place.hpp"

namespace gravure::texture {

/// Seven axes at any instant, and W where the head has it, from the runs and the stages' path.
class SevenAxisMotion final : public PathMotion {
 public:
  SevenAxisMotion(PathRuns path, StageSpline stages, SmoothPlace place, std::vector<double> pulse_mm,
                  const RotaryTable& table, bool focus_axis);
  std::int64_t instants() const noexcept override { return lead() + place_.end() + 1; }
  Result<void> read(std::int64_t first, std::span<PathInstant> out) const override;

  /// Periods before the spot leaves the first point, while the stages set out.
  std::int64_t lead() const noexcept { return SmoothPlace::kReach * place_.cell(); }
  const PathRuns& path() const noexcept { return path_; }
  const StageSpline& stages() const noexcept { return stages_; }
  const SmoothPlace& place() const noexcept { return place_; }

 private:
  PathRuns path_;
  StageSpline stages_;
  SmoothPlace place_;
  std::vector<double> pulse_mm_;
  RotaryTable table_;
  bool focus_axis_;
};

/// The stages alone, at rest at the end of every run.
class FiveAxisMotion final : public PathMotion {
 public:
  FiveAxisMotion(PathRuns path, StageSpline stages, std::vector<double> pulse_mm);
  std::int64_t instants() const noexcept override { return path_.periods() + 1; }
  Result<void> read(std::int64_t first, std::span<PathInstant> out) const override;
  const PathRuns& path() const noexcept { return path_; }
  const StageSpline& stages() const noexcept { return stages_; }

 private:
  PathRuns path_;
  StageSpline stages_;
  std::vector<double> pulse_mm_;
};

}  // namespace gravure::texture
