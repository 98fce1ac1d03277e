#include "path_instants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "run_motion.hpp"

namespace gravure::texture {
namespace {

/// How far along runs the texture is, period by period: the profile of a run is made when it begins.
class RunCursor {
 public:
  RunCursor(const PathRuns& path, std::int64_t period) : path_(path), run_(path.run_at(period)), motion_(path, run()) {}
  /// Periods rise from call to call; before the start and behind the end the ends stand still.
  void go_to(std::int64_t period) {
    bool moved = false;
    while (run_ + 1 < path_.runs().size() && period >= path_.runs()[run_ + 1].start) {
      ++run_;
      moved = true;
    }
    if (moved) {
      motion_ = RunMotion(path_, run());
    }
    place_ = PathRuns::place(run(), motion_.at(std::max<std::int64_t>(period - run().start, 0)));
  }
  const PathRun& run() const { return path_.runs()[run_]; }
  const Place& place() const { return place_; }
  Vector3 position() {
    if (!segment_ || place_.index != segment_of_) {
      segment_ = path_.segment(place_.index);
      segment_of_ = place_.index;
    }
    return segment_->position(place_.share);
  }

 private:
  const PathRuns& path_;
  std::size_t run_;
  RunMotion motion_;
  Place place_;
  std::optional<SpotSegment> segment_;
  std::size_t segment_of_ = 0;
};

double between(const std::vector<double>& values, const Place& place) {
  const double from = values[place.index];
  const double to = values[place.index + 1];
  return place.share >= 1 ? to : from + place.share * (to - from);
}

Result<void> check_range(std::int64_t first, std::size_t size, std::int64_t instants) {
  if (first < 0 || first > instants || static_cast<std::int64_t>(size) > instants - first) {
    return Error{ErrorCode::out_of_range, fmt::format("instants {} to {} of a motion that has {}", first,
                                                      first + static_cast<std::int64_t>(size), instants)};
  }
  return {};
}

}  // namespace

SevenAxisMotion::SevenAxisMotion(PathRuns path, StageSpline stages, SmoothPlace place, std::vector<double> pulse_mm,
                                 const RotaryTable& table, bool focus_axis)
    : path_(std::move(path)),
      stages_(std::move(stages)),
      place_(std::move(place)),
      pulse_mm_(std::move(pulse_mm)),
      table_(table),
      focus_axis_(focus_axis) {}

Result<void> SevenAxisMotion::read(std::int64_t first, std::span<PathInstant> out) const {
  GRAVURE_CHECK(check_range(first, out.size(), instants()));
  RunCursor cursor(path_, first - lead());
  for (std::size_t k = 0; k < out.size(); ++k) {
    const std::int64_t period = first + static_cast<std::int64_t>(k) - lead();
    cursor.go_to(period);
    const StageValues stages = stages_.at(place_.at(period));
    const Vector3 spot = table_.turned(stages[3], stages[4], cursor.position());
    PathInstant& at = out[k];
    std::copy(stages.begin(), stages.end(), at.axes.begin());
    at.axes[5] = spot.x() - stages[0];
    at.axes[6] = spot.y() - stages[1];
    at.axes[kFocusAxis] = focus_axis_ ? spot.z() - stages[2] : 0;
    at.along_mm = between(pulse_mm_, cursor.place());
  }
  return {};
}

FiveAxisMotion::FiveAxisMotion(PathRuns path, StageSpline stages, std::vector<double> pulse_mm)
    : path_(std::move(path)), stages_(std::move(stages)), pulse_mm_(std::move(pulse_mm)) {}

Result<void> FiveAxisMotion::read(std::int64_t first, std::span<PathInstant> out) const {
  GRAVURE_CHECK(check_range(first, out.size(), instants()));
  RunCursor cursor(path_, first);
  for (std::size_t k = 0; k < out.size(); ++k) {
    cursor.go_to(first + static_cast<std::int64_t>(k));
    const StageValues stages = stages_.at(cursor.place());
    PathInstant& at = out[k];
    at = {};
    std::copy(stages.begin(), stages.end(), at.axes.begin());
    at.along_mm = between(pulse_mm_, cursor.place());
  }
  return {};
}

}  // namespace gravure::texture
