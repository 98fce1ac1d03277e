#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/program.hpp"
#include "gravure/zones/plan_zones.hpp"

namespace gravure::zones {

struct ZoneMotionRequest {
  double servo_period_s = 0;   ///< > 0
  double mark_speed_mm_s = 0;  ///< > 0: of the spot along a contour, at most
  std::size_t most_moves = 1'000'000;
  double jump_speed_mm_s = std::numeric_limits<double>::infinity();  ///< > 0: of U and V in the dark, at most
  std::int64_t most_periods = std::int64_t{1} << 28U;                ///< of the servo: 3.7 h of 50 us
};

/// What happens when, in the order of a plan.
struct ZoneTimes {
  double stage_s = 0;  ///< stages move, dark
  double jump_s = 0;   ///< the galvo goes to the next stroke, dark
  double mark_s = 0;
  std::int64_t stops = 0;  ///< of the stages
  std::int64_t strokes = 0;
};

/// The motion that marks the zones of a plan, from all axes at 0 to the end of the last stroke.
///
/// Stages and galvo move together to the first stroke of a layer and stand; the galvo marks stroke after stroke with
/// dark jumps between them. A stroke is marked from corner to corner, at rest in each (corners that do not turn are
/// passed), so that the spot never leaves the contour. Every move is a synchronised jerk-limited profile from rest to
/// rest under the limits of joints and galvo (engine/motion), begins at an instant of the servo and ends at or before
/// one. Speeds stay so far below their limits that those of the cubics between set-points (core/path_expand.hpp) keep
/// to them, that of the spot along the path as well (but for the rounding of the path covered to 1 pm a set-point).
class ZoneMotion final : public PathMotion {
 public:
  /// The machine must have the joints X, Y, Z, A and C and no others, and limits of speed, acceleration and jerk for
  /// each and for the galvo: bad_argument names what is missing. out_of_range for settings that are not positive, and
  /// before it is reckoned out for more moves than most_moves or periods than most_periods; as kinematics::field_of().
  /// Keeps what it needs of plan and machine.
  static Result<std::unique_ptr<ZoneMotion>> create(const ZonePlan& plan, const Machine& machine,
                                                    const ZoneMotionRequest& request);
  ~ZoneMotion() override;

  std::int64_t instants() const noexcept override;
  Result<void> read(std::int64_t first, std::span<PathInstant> out) const override;

  double length_mm() const noexcept;  ///< of all strokes: along_mm of the last instant
  const ZoneTimes& times() const noexcept;
  /// The corners of all strokes in the order of marking, for the twin: where the light is wanted.
  const std::vector<PathTarget>& targets() const noexcept;

 private:
  struct Data;
  explicit ZoneMotion(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace gravure::zones
