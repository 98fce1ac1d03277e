#pragma once

#include <optional>
#include <string_view>

#include "gravure/scan/line_path.hpp"

namespace gravure::scan {

/// What a mirror does where a marking window ends or begins.
struct MirrorState {
  double position_mm = 0;
  double speed_mm_s = 0;
};

struct MirrorLimits {
  std::optional<double> max_speed_mm_s;
  std::optional<double> max_acceleration_mm_s2;
  std::optional<double> max_jerk_mm_s3;
};

/// The turn from one state to the other in `lasts_s` that needs the smallest share of the limits (motion's
/// jerk-limited profile under limits scaled down until it lasts that long). Where only one of acceleration and jerk is
/// limited, or none, the jerk segments are made a quarter of the turn long, shorter if the acceleration asks for it.
/// `shortest_s` is set even where lasts_s is less, in which case there is no profile: lasts_s < shortest_s tells.
Result<MirrorTurn> plan_mirror_turn(const MirrorState& from, const MirrorState& to, double lasts_s,
                                    const MirrorLimits& limits);

}  // namespace gravure::scan
