#include "plan_spins.hpp"

#include <algorithm>
#include <utility>

#include "gravure/core/board_runs.hpp"
#include "spin_ramp.hpp"

namespace gravure::sync_plan {
namespace {

constexpr std::int64_t kMostSeedsToTick = 4'294'967'295;  // from go to the first tick: the board's first_tick
constexpr std::size_t kMostSegments = 256;                // of the board's list

/// An axis of the plan with its section of the job.
struct Axis {
  std::string section;
  const char* unit;
  SpinRequest request;
  std::optional<AxisSpin>& spin;
};

bool has_all(const AxisLimits& limits) {
  return limits.max_speed && limits.max_acceleration && limits.max_jerk;
}

std::vector<Axis> axes_of(const Job& job, Plan& plan) {
  const std::int64_t fpga_hz = plan.clock.fpga_hz;
  const std::int64_t per_seed = job.fpga.clock_multiplier;
  const Rational per_mm = Rational(1000) / plan.rotary.circumference_um;
  const std::int64_t run_ticks = run_with(plan, 0).ticks;
  std::vector<Axis> axes;
  if (plan.mode == Mode::flat) {
    axes.push_back({"stage",
                    "mm",
                    {plan.ab,
                     fpga_hz,
                     per_seed,
                     plan.rotary.edges_per_revolution * per_mm,
                     job.stage.limits,
                     {},
                     run_ticks,
                     plan.rotary.edges_per_revolution,
                     Rest::turn_back},
                    plan.spin});
    return axes;
  }
  axes.push_back({"rotary",
                  "deg",
                  {plan.ab, fpga_hz, per_seed, plan.rotary.edges_per_revolution / Rational(360), job.rotary.limits,
                   job.rotary.start_angle_deg, run_ticks, plan.rotary.edges_per_revolution,
                   plan.bands ? Rest::whole_turns : Rest::next_period},
                  plan.spin});
  if (plan.carriage) {
    CarriagePlan& carriage = *plan.carriage;
    axes.push_back({"carriage",
                    "mm",
                    {carriage.ab,
                     fpga_hz,
                     per_seed,
                     carriage.edges_per_revolution * Rational(1000) / carriage.feed_um,
                     job.carriage.limits,
                     {},
                     run_ticks,
                     carriage.edges_per_revolution},
                    carriage.spin});
  }
  return axes;
}

void check_speed(const Axis& axis, Violations& violations) {
  const std::optional<Rational>& most = axis.request.limits.max_speed;
  const Rational speed = marking_speed(axis.request);
  if (most && speed > *most) {
    violations.conflict(ErrorCode::out_of_range, axis.section + ".max_speed_" + axis.unit + "_s", number_text(*most),
                        "marking moves the axis at " + number_text(speed) + " " + axis.unit +
                            "/s; lines that take longer (scanner.turn_slots, laser.pulse_divider) would fit, " +
                            number_text(Rational(speed / *most)) + " times as long");
  }
}

std::int64_t seeds_of(const SpinPlan& spin, const SpinRequest& request) {
  return spin.ticks / request.ticks_per_seed;
}

/// The board counts the seed clocks to the first line in a register.
void check_length(const Axis& axis, const AxisSpin& spin, Violations& violations) {
  if (spin.up.segments.size() > kMostSegments || spin.down.segments.size() > kMostSegments) {
    violations.conflict(ErrorCode::out_of_range, axis.section + ".max_acceleration_" + std::string(axis.unit) + "_s2",
                        number_text(*axis.request.limits.max_acceleration),
                        "the ramps take " + std::to_string(spin.up.segments.size()) + " and " +
                            std::to_string(spin.down.segments.size()) + " segments, and the board lists " +
                            std::to_string(kMostSegments));
  }
  if (seeds_of(spin.up, axis.request) <= kMostSeedsToTick) {
    return;
  }
  const Rational speed = marking_speed(axis.request);
  const Rational most_s =
      Rational(kMostSeedsToTick) * Rational(axis.request.ticks_per_seed) / Rational(axis.request.fpga_hz);
  const Rational late_deg = (spin.up.duration_s - most_s) * speed;
  const bool waits = axis.request.start_deg && late_deg < Rational(360);
  const std::string key =
      axis.section + (waits ? ".start_angle_deg" : ".max_acceleration_" + std::string(axis.unit) + "_s2");
  violations.conflict(ErrorCode::out_of_range, key,
                      number_text(waits ? *axis.request.start_deg : *axis.request.limits.max_acceleration),
                      "the spin-up takes " + number_text(spin.up.duration_s) + " s from rest at the encoder index, " +
                          "and the board counts " + number_text(most_s) + " s to the first line" +
                          (waits ? "; an angle smaller by " + number_text(late_deg) + " deg or more would fit" : ""));
}

/// Every axis begins with the same go and is at its marking speed at tick 0: who needs less waits at rest.
Result<void> spin_together(const std::vector<Axis>& axes) {
  std::vector<Staircase> stairs;
  std::vector<std::int64_t> rest(axes.size(), 0);
  for (const Axis& axis : axes) {
    GRAVURE_TRY(Staircase staircase, make_staircase(axis.request));
    stairs.push_back(std::move(staircase));
  }
  bool together = false;
  // A rest lets a fraction gather counts, which may change the spin-up by a step; then the others wait for that.
  for (int attempt = 0; attempt < 100 && !together; ++attempt) {
    std::int64_t longest = 0;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      GRAVURE_TRY(axes[i].spin, make_spin_up(axes[i].request, stairs[i], rest[i]));
      longest = std::max(longest, seeds_of(axes[i].spin->up, axes[i].request));
    }
    together = true;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const std::int64_t early = longest - seeds_of(axes[i].spin->up, axes[i].request);
      together = together && early == 0;
      rest[i] += early;
    }
  }
  if (!together) {
    return Error{ErrorCode::out_of_range, "no spin-up ends all axes at once"};
  }
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].spin->down = make_spin_down(axes[i].request, stairs[i], axes[i].spin->up);
  }
  return {};
}

}  // namespace

Result<void> plan_spins(const Job& job, Plan& plan, Violations& violations) {
  std::vector<Axis> spinning;
  for (const Axis& axis : axes_of(job, plan)) {
    check_speed(axis, violations);
    if (has_all(axis.request.limits)) {
      spinning.push_back(axis);
    }
  }
  if (spinning.empty() || !violations.none()) {
    return {};
  }
  GRAVURE_CHECK(spin_together(spinning));
  const std::int64_t runs = plan.job.revolutions / run_with(plan, 0).revolutions;
  for (const Axis& axis : spinning) {
    axis.spin->total_s = plan.job.duration_s + (axis.spin->up.duration_s + axis.spin->down.duration_s) * Rational(runs);
    check_length(axis, *axis.spin, violations);
  }
  return {};
}

}  // namespace gravure::sync_plan
