#include "gravure/scan/line_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mirror_turn.hpp"

namespace gravure::scan {
namespace {

using kinematics::FieldPoint;

constexpr double kStepSlots = 0.25;  ///< for the speed where a window ends, by differences

std::size_t index_of(Direction direction) noexcept {
  return direction == Direction::forward ? 0 : 1;
}

const char* name_of(Direction direction) noexcept {
  return direction == Direction::forward ? "forward" : "reverse";
}

double part(const FieldPoint& field, std::size_t axis) noexcept {
  return axis == 0 ? field.u_mm : field.v_mm;
}

MirrorLimits limits_of(const kinematics::ScanHead& head) noexcept {
  return {head.max_speed_mm_s, head.max_acceleration_mm_s2, head.max_jerk_mm_s3};
}

std::string text_of(const MirrorLimits& limits) {
  std::string text;
  const auto add = [&text](const char* name, const std::optional<double>& value) {
    if (value) {
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, *value);
    }
  };
  add("max_speed_mm_s", limits.max_speed_mm_s);
  add("max_acceleration_mm_s2", limits.max_acceleration_mm_s2);
  add("max_jerk_mm_s3", limits.max_jerk_mm_s3);
  return text.empty() ? "no limits" : text;
}

/// Where a mirror is on the line and how fast.
MirrorState state_of(const LinePath& path, Direction direction, double slot, std::size_t axis) {
  const double before = part(path.on_line(direction, slot - kStepSlots), axis);
  const double after = part(path.on_line(direction, slot + kStepSlots), axis);
  return {part(path.on_line(direction, slot), axis), (after - before) / (2 * kStepSlots * path.timing().slot_s())};
}

Result<void> check_speed(const LinePath& path, Direction direction, const LineTiming& timing) {
  const std::optional<double>& most = path.geometry().machine.head.max_speed_mm_s;
  const double middle = static_cast<double>(timing.first_slot(direction)) + static_cast<double>(timing.pixels) / 2;
  for (std::size_t axis = 0; most && axis < 2; ++axis) {
    const double speed = std::abs(state_of(path, direction, middle, axis).speed_mm_s);
    constexpr double kRounding = 1e-9;  // a speed equal to its limit, taken from differences of places
    if (speed > *most * (1 + kRounding)) {
      return Error{
          ErrorCode::out_of_range,
          fmt::format("scan: {} moves at {:.9g} mm/s while a line is marked: faster than max_speed_mm_s = {}; take "
                      "a smaller pixel pitch or fewer pulses a second",
                      axis == 0 ? "U" : "V", speed, *most)};
    }
  }
  return {};
}

/// Every pulse must be inside the field. Turns may swing further: what they take is LinePath::reach_mm().
Result<void> check_marking_field(const LinePath& path, Direction direction) {
  const LineTiming& timing = path.timing();
  const double field_mm = path.geometry().machine.head.field_mm;
  const double first = static_cast<double>(timing.first_slot(direction));
  for (const double slot : {first, first + static_cast<double>(timing.pixels - 1)}) {
    const FieldPoint field = path.on_line(direction, slot);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double from_centre = std::abs(part(field, axis));
      if (from_centre > field_mm / 2) {  // no number: plan_turn() says so
        return Error{
            ErrorCode::out_of_range,
            fmt::format("scan: while a line is marked {} comes {:.9g} mm from the centre: field_mm = {} allows {}; "
                        "it takes a field of {:.9g} mm, fewer pixels or less offset_deg",
                        axis == 0 ? "U" : "V", from_centre, field_mm, field_mm / 2, 2 * from_centre)};
      }
    }
  }
  return {};
}

}  // namespace

double LinePath::centre_slot() const noexcept {
  return static_cast<double>(timing_.forward_first_slot) + static_cast<double>(timing_.pixels - 1) / 2;
}

Direction LinePath::other(Direction direction) const noexcept {
  return timing_.bidirectional && direction == Direction::forward ? Direction::reverse : Direction::forward;
}

/// Half a slot beyond the first and the last pulse and on to the next set-point, for between set-points the mirrors
/// move straight. The pulses of reverse lines may be later than the path by the offset; the speed is constant for both.
LinePath::Window LinePath::marking(Direction direction) const noexcept {
  const auto last = static_cast<double>(timing_.pixels - 1);
  const double pulses = timing_.pulse_at(direction, timing_.first_slot(direction));
  const auto first = static_cast<double>(timing_.first_slot(direction));
  const double path = direction == Direction::forward ? first : first - static_cast<double>(timing_.offset_slots);
  const double begin = std::min(pulses, path);
  const double end = std::max(pulses, path) + last;
  const auto microvector = static_cast<double>(timing_.slots_per_microvector);
  const double before = lead_slots_ + microvector * std::floor((begin - lead_slots_) / microvector);
  const double after = lead_slots_ + microvector * std::ceil((end - lead_slots_) / microvector);
  return {std::min(begin - 0.5, before), std::max(end + 0.5, after)};
}

double LinePath::turn_slots(Direction before) const noexcept {
  return static_cast<double>(timing_.slots) - marking(before).end + marking(other(before)).begin;
}

bool LinePath::is_long_enough(Direction before) const noexcept {
  const auto& turns = turn_after(before);
  return turns[0].lasts_s > 0 && turns[0].lasts_s >= std::max(turns[0].shortest_s, turns[1].shortest_s);
}

/// The least turn_slots with which both turns are long enough, lines rounded up and windows placed as the planner does:
/// tried one after the other, for where the set-points fall decides as well; all that round up to one line are alike.
std::int64_t LinePath::enough_turn_slots() const {
  LinePath trial = *this;
  const Direction back = other(Direction::forward);
  const std::int64_t step = timing_.slots_per_microvector;
  double shortest_s = 0;
  for (const MirrorTurn& turn : {turns_[0][0], turns_[0][1], turns_[1][0], turns_[1][1]}) {
    shortest_s = std::max(shortest_s, turn.shortest_s);
  }
  auto turn = std::max<std::int64_t>(0, static_cast<std::int64_t>(shortest_s / timing_.slot_s()) - 4 * step);
  for (;; turn = trial.timing_.slots - trial.timing_.pixels + 1) {
    LineTiming& timing = trial.timing_;
    timing.slots = (timing.pixels + turn + step - 1) / step * step;
    timing.forward_first_slot = (timing.slots - timing.pixels) / 2;
    timing.reverse_first_slot = timing.slots - timing.pixels - timing.forward_first_slot + timing.offset_slots;
    if (!trial.plan_turn(Direction::forward) || !trial.plan_turn(back) ||
        (trial.is_long_enough(Direction::forward) && trial.is_long_enough(back))) {
      return turn;
    }
  }
}

kinematics::JointPositions LinePath::joints_at(double slot) const {
  kinematics::JointPositions joints = geometry_.at_centre;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] += geometry_.per_slot[i] * (slot - centre_slot());
  }
  return joints;
}

kinematics::Vector3 LinePath::target(double pixel) const {
  const double u =
      geometry_.centre_u_mm + (pixel - static_cast<double>(timing_.pixels - 1) / 2) * geometry_.pixel_pitch_mm;
  return kinematics::forward(geometry_.machine, geometry_.at_centre, {u, geometry_.centre_v_mm, 0}).position_mm;
}

FieldPoint LinePath::on_line(Direction direction, double slot) const {
  const double since_first =
      slot - static_cast<double>(direction == Direction::forward ? timing_.forward_first_slot
                                                                 : timing_.reverse_first_slot - timing_.offset_slots);
  const double pixel =
      direction == Direction::forward ? since_first : static_cast<double>(timing_.pixels - 1) - since_first;
  const auto field = kinematics::field_of(geometry_.machine, joints_at(slot), target(pixel));
  if (!field) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone, kNone};  // plan() refuses such a path
  }
  FieldPoint result = field.value();
  if (!cross_scan_correction_) {
    result.v_mm = geometry_.centre_v_mm;
  }
  return result;
}

FieldPoint LinePath::in_turn(Direction before, double slot_after_window) const {
  const auto& turns = turns_[index_of(before)];
  const double time_s = slot_after_window * timing_.slot_s();
  const auto position = [time_s](const MirrorTurn& turn) {
    return turn.start_mm + turn.profile.at(time_s).position_mm;
  };
  return {position(turns[0]), position(turns[1]), 0};
}

FieldPoint LinePath::at(Direction direction, double slot) const {
  const auto slots = static_cast<double>(timing_.slots);
  const double lines = std::floor(slot / slots);
  const double within = slot - lines * slots;
  const Direction here = std::fmod(lines, 2) == 0 ? direction : other(direction);
  const Window marks = marking(here);
  if (within < marks.begin) {
    return in_turn(other(here), slots - marking(other(here)).end + within);
  }
  return within > marks.end ? in_turn(here, within - marks.end) : on_line(here, within);
}

Result<void> LinePath::plan_turn(Direction before) {
  const Direction after = other(before);
  const double begin = marking(before).end;
  const double end = marking(after).begin;
  const double slots = turn_slots(before);
  const MirrorLimits limits = limits_of(geometry_.machine.head);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const MirrorState from = state_of(*this, before, begin, axis);
    const MirrorState to = state_of(*this, after, end, axis);
    if (!std::isfinite(from.position_mm) || !std::isfinite(to.position_mm)) {
      return Error{ErrorCode::out_of_range,
                   "scan: no beam of the lens reaches the ends of the line; take fewer pixels or less offset_deg"};
    }
    MirrorTurn& turn = turns_[index_of(before)][axis];
    GRAVURE_TRY(turn, plan_mirror_turn(from, to, slots * timing_.slot_s(), limits));
  }
  return {};
}

Result<void> LinePath::check_turn(Direction before) const {
  const char* const names[] = {"U", "V"};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const MirrorTurn& turn = turn_after(before)[axis];
    if (!(turn.lasts_s > 0) || turn.lasts_s < turn.shortest_s) {
      return Error{
          ErrorCode::out_of_range,
          fmt::format(
              "scan: {} slots are left for the turn after {} lines: {} takes {:.9g} us at least, {} slots, from {:.6g} "
              "to {:.6g} mm/s under {}; make turn_slots {} or more",
              turn_slots(before), name_of(before), names[axis], turn.shortest_s * 1e6,
              std::max(1.0, std::ceil(turn.shortest_s / timing_.slot_s())), turn.start_mm_s, turn.end_mm_s,
              text_of(limits_of(geometry_.machine.head)), enough_turn_slots())};
    }
  }
  return {};
}

double LinePath::reach_mm() const noexcept {
  double reach = 0;
  for (const Direction before : {Direction::forward, other(Direction::forward)}) {
    for (const MirrorTurn& turn : turn_after(before)) {
      reach = std::max({reach, -turn.least_mm, turn.most_mm});
    }
  }
  return reach;
}

Result<LinePath> LinePath::plan(const LineTiming& timing, const LineGeometry& geometry, bool cross_scan_correction,
                                std::int64_t lead_ticks) {
  LinePath path(timing, geometry, cross_scan_correction, lead_ticks);
  GRAVURE_CHECK(check_speed(path, Direction::forward, timing));
  const Direction back = path.other(Direction::forward);  // forward again where all lines run forward
  GRAVURE_CHECK(check_marking_field(path, Direction::forward));
  GRAVURE_CHECK(check_marking_field(path, back));
  GRAVURE_CHECK(path.plan_turn(Direction::forward));
  GRAVURE_CHECK(path.plan_turn(back));
  GRAVURE_CHECK(path.check_turn(Direction::forward));
  GRAVURE_CHECK(path.check_turn(back));
  return path;
}

}  // namespace gravure::scan
