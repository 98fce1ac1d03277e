#include "gravure/zones/zone_motion.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "check_positive.hpp"
#include "gravure/motion/synchronise.hpp"

namespace gravure::zones {
namespace {

constexpr std::size_t kStages = 5;
constexpr std::size_t kAxes = kFocusAxis;  // zones are marked without one
using Axes = std::array<double, kPathAxes.size()>;

struct Limits {
  double speed = 0;
  double acceleration = 0;
  double jerk = 0;
};

/// From rest to rest: all axes by their own profiles, or (a mark) the galvo along a straight line on the part.
struct Leg {
  std::int64_t first = 0;    ///< instant at which it begins
  std::int64_t periods = 0;  ///< until the next begins
  Axes from{};
  std::vector<motion::Profile> profiles;  ///< of each axis; of a mark one, of the way
  std::size_t layer = 0;                  ///< of a mark: number of the stop
  Vector3 begin_mm = Vector3::Zero();     ///< of a mark: on the part
  Vector3 step = Vector3::Zero();         ///< of a mark: its direction, length 1
  double along_mm = 0;                    ///< covered before it

  bool is_mark() const noexcept { return profiles.size() == 1; }
};

motion::JerkRequest request_of(double stroke, const Limits& limits) {
  return {{stroke, limits.speed, limits.acceleration, limits.acceleration, 0, 0}, limits.jerk, limits.jerk};
}

/// What moves from instant to instant by a cubic of its set-points may be faster than the motion itself by `beyond`
/// jerk period^2: so much room is left, at most `most` of the speed; the jerk is lowered where that would be more.
void leave_room(Limits& limits, double beyond, double most, double period_s) {
  const double squared = beyond * period_s * period_s;
  limits.jerk = std::min(limits.jerk, limits.speed * most / squared);
  limits.speed -= limits.jerk * squared;
}

/// The axes follow the cubic through four set-points: Peano's kernel. Its acceleration and jerk are means of those of
/// the motion.
constexpr double kBeyondOfAxes = 0.1587;
/// The path covered follows the monotone cubic of core/path_expand.hpp: 1/12, where the motion turns at its greatest
/// speed in the middle of a period with all the jerk there is.
constexpr double kBeyondOfPath = 0.0834;

/// Corners that a stroke turns at, its ends included.
std::vector<Vector3> turning_points(const std::vector<Vector3>& points) {
  constexpr double kStraight_rad = 1e-9;
  std::vector<Vector3> kept{points[0]};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i] == kept.back()) {
      continue;
    }
    if (kept.size() > 1 &&
        angle_between(kept.back() - kept[kept.size() - 2], points[i] - kept.back()) < kStraight_rad) {
      kept.pop_back();
    }
    kept.push_back(points[i]);
  }
  return kept;
}

}  // namespace

struct ZoneMotion::Data {
  Machine machine;
  std::array<std::size_t, kStages> joint_of{};  ///< of the machine, for X, Y, Z, A and C
  std::array<Limits, kAxes> limits{};
  Limits mark;
  double period_s = 0;
  ZoneMotionRequest request;
  std::vector<Leg> legs;
  std::vector<JointPositions> stops;
  std::int64_t instants = 1;
  Axes at{};
  double along_mm = 0;
  ZoneTimes times;
  std::vector<PathTarget> targets;

  Result<void> find_axes();
  Error too_long(const Leg& leg, double periods) const;
  Result<void> add_leg(Leg leg, double& time_s);
  Result<void> go_to(const Axes& to, double& time_s);
  Result<Axes> axes_at(std::size_t stop, const Vector3& part_mm) const;
  Result<void> mark_line(const Vector3& from, const Vector3& to);
  Result<void> add_layer(const PlannedZone& zone, const PlannedLayer& layer, const std::vector<Piece>& pieces);
  Result<PathInstant> instant(const Leg& leg, std::int64_t number) const;
};

Result<void> ZoneMotion::Data::find_axes() {
  if (machine.joints.size() != kStages) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("machine: has {} joints: zones are marked with X, Y, Z, A and C", machine.joints.size())};
  }
  GRAVURE_CHECK(check_limits(machine));
  for (std::size_t axis = 0; axis < kStages; ++axis) {
    GRAVURE_TRY(joint_of[axis], find_joint(machine, kPathAxes[axis]));
    const kinematics::JointLimits& joint = machine.joints[joint_of[axis]].limits;
    limits[axis] = {*joint.max_speed, *joint.max_acceleration, *joint.max_jerk};
  }
  const kinematics::ScanHead& head = machine.head;
  if (!head.max_speed_mm_s || !head.max_acceleration_mm_s2 || !head.max_jerk_mm_s3) {
    return Error{ErrorCode::bad_argument,
                 "machine: [head] needs max_speed_mm_s, max_acceleration_mm_s2 and max_jerk_mm_s3 to time the galvo"};
  }
  limits[kStages] = limits[kStages + 1] = {*head.max_speed_mm_s, *head.max_acceleration_mm_s2, *head.max_jerk_mm_s3};
  return {};
}

/// With this leg it would be more than most_periods.
Error ZoneMotion::Data::too_long(const Leg& leg, double periods) const {
  const std::string most = fmt::format("a program has at most {} periods of servo_us, {:.3g} h", request.most_periods,
                                       static_cast<double>(request.most_periods) * period_s / 3600);
  const double leg_s = periods * period_s;
  if (times.mark_s + (leg.is_mark() ? leg_s : 0) > times.stage_s + times.jump_s + (leg.is_mark() ? 0 : leg_s)) {
    return {ErrorCode::out_of_range,
            fmt::format("mark_speed_mm_s = {:.6g}: after {:.3f} mm of the contours, {}: mark faster, or make servo_us "
                        "longer",
                        request.mark_speed_mm_s, along_mm, most)};
  }
  return {ErrorCode::out_of_range,
          fmt::format("servo_us = {:.6g}: moves in the dark take too long, {}: make it longer, or give the machine "
                      "faster axes",
                      period_s * 1e6, most)};
}

Result<void> ZoneMotion::Data::add_leg(Leg leg, double& time_s) {
  if (legs.size() >= request.most_moves) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("more than {} moves: thin the points of the contours", request.most_moves)};
  }
  leg.first = instants - 1;
  const double periods = std::max(1.0, std::ceil(leg.profiles[0].access_time_s() / period_s));
  if (!(static_cast<double>(instants) + periods <= static_cast<double>(request.most_periods))) {
    return too_long(leg, periods);
  }
  leg.periods = static_cast<std::int64_t>(periods);
  instants += leg.periods;
  time_s += static_cast<double>(leg.periods) * period_s;
  legs.push_back(std::move(leg));
  return {};
}

/// Dark, all axes together.
Result<void> ZoneMotion::Data::go_to(const Axes& to, double& time_s) {
  if (to == at) {
    return {};
  }
  std::vector<motion::JerkRequest> requests;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    requests.push_back(request_of(to[axis] - at[axis], limits[axis]));
  }
  GRAVURE_TRY(motion::SynchronisedMove move, motion::synchronise(requests));
  Leg leg;
  leg.from = at;
  leg.profiles = std::move(move.axes);
  leg.along_mm = along_mm;
  at = to;
  return add_leg(std::move(leg), time_s);
}

Result<Axes> ZoneMotion::Data::axes_at(std::size_t stop, const Vector3& part_mm) const {
  GRAVURE_TRY(const kinematics::FieldPoint field, field_of(machine, stops[stop], part_mm));
  Axes axes{};
  for (std::size_t axis = 0; axis < kStages; ++axis) {
    axes[axis] = stops[stop][joint_of[axis]];
  }
  axes[kStages] = field.u_mm;
  axes[kStages + 1] = field.v_mm;
  return axes;
}

Result<void> ZoneMotion::Data::mark_line(const Vector3& from, const Vector3& to) {
  const double length = (to - from).norm();
  GRAVURE_TRY(motion::Profile profile, motion::plan_profile(request_of(length, mark)));
  Leg leg;
  leg.from = at;
  leg.profiles.push_back(profile);
  leg.layer = stops.size() - 1;
  leg.begin_mm = from;
  leg.step = (to - from) / length;
  leg.along_mm = along_mm;
  along_mm += length;
  GRAVURE_TRY(at, axes_at(leg.layer, to));
  return add_leg(std::move(leg), times.mark_s);
}

Result<void> ZoneMotion::Data::add_layer(const PlannedZone& zone, const PlannedLayer& layer,
                                         const std::vector<Piece>& pieces) {
  stops.push_back(layer.joints);
  ++times.stops;
  for (std::size_t s = 0; s < layer.strokes.size(); ++s) {
    std::vector<Vector3> corners = turning_points(layer.strokes[s].points_mm);
    if (corners.size() < 2) {
      continue;  // no length
    }
    for (Vector3& corner : corners) {
      corner = zone.frame.to_part(corner);
    }
    const Vector3& normal = pieces[layer.strokes[s].piece].direction;
    GRAVURE_TRY(const Axes begin, axes_at(stops.size() - 1, corners[0]));
    GRAVURE_CHECK(go_to(begin, s == 0 ? times.stage_s : times.jump_s));
    ++times.strokes;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (i > 0) {
        GRAVURE_CHECK(mark_line(corners[i - 1], corners[i]));
      }
      targets.push_back(
          {along_mm, {corners[i].x(), corners[i].y(), corners[i].z()}, {normal.x(), normal.y(), normal.z()}});
    }
  }
  return {};
}

Result<PathInstant> ZoneMotion::Data::instant(const Leg& leg, std::int64_t number) const {
  const double time_s = static_cast<double>(number - leg.first) * period_s;
  PathInstant instant;
  instant.along_mm = leg.along_mm;
  if (leg.is_mark()) {
    const double way = std::clamp(leg.profiles[0].at(time_s).position_mm, 0.0, leg.profiles[0].stroke_mm);
    GRAVURE_TRY(instant.axes, axes_at(leg.layer, leg.begin_mm + way * leg.step));
    instant.along_mm += way;
    return instant;
  }
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    instant.axes[axis] = leg.from[axis] + leg.profiles[axis].at(time_s).position_mm;
  }
  return instant;
}

ZoneMotion::ZoneMotion(std::unique_ptr<Data> data) : data_(std::move(data)) {}
ZoneMotion::~ZoneMotion() = default;

Result<std::unique_ptr<ZoneMotion>> ZoneMotion::create(const ZonePlan& plan, const Machine& machine,
                                                       const ZoneMotionRequest& request) {
  GRAVURE_CHECK(check_positive("servo_period_s", request.servo_period_s));
  GRAVURE_CHECK(check_positive("mark_speed_mm_s", request.mark_speed_mm_s));
  if (!(request.jump_speed_mm_s > 0)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("jump_speed_mm_s = {}: must be greater than 0", request.jump_speed_mm_s)};
  }
  auto data = std::make_unique<Data>();
  data->machine = machine;
  data->period_s = request.servo_period_s;
  data->request = request;
  GRAVURE_CHECK(data->find_axes());
  for (const std::size_t galvo : {kStages, kStages + 1}) {
    data->limits[galvo].speed = std::min(data->limits[galvo].speed, request.jump_speed_mm_s);
  }
  for (Limits& limits : data->limits) {
    leave_room(limits, kBeyondOfAxes, 0.5, request.servo_period_s);
  }
  // U and V are no faster than the spot on the part: the beam sees the way shortened.
  data->mark = data->limits[kStages];
  data->mark.speed = std::min(data->mark.speed, request.mark_speed_mm_s);
  leave_room(data->mark, kBeyondOfPath, 0.05, request.servo_period_s);
  for (const PlannedZone& zone : plan.zones) {
    for (const PlannedLayer& layer : zone.layers) {
      GRAVURE_CHECK(data->add_layer(zone, layer, plan.pieces));
    }
  }
  if (data->legs.empty()) {
    return Error{ErrorCode::bad_argument, "the plan of zones has nothing to mark"};
  }
  return std::unique_ptr<ZoneMotion>(new ZoneMotion(std::move(data)));
}

std::int64_t ZoneMotion::instants() const noexcept {
  return data_->instants;
}

Result<void> ZoneMotion::read(std::int64_t first, std::span<PathInstant> out) const {
  if (first < 0 || first + static_cast<std::int64_t>(out.size()) > data_->instants) {
    return Error{ErrorCode::bad_argument, "instants beyond the motion"};
  }
  const std::vector<Leg>& legs = data_->legs;
  auto leg = std::upper_bound(legs.begin(), legs.end(), first,
                              [](std::int64_t number, const Leg& other) { return number < other.first; });
  leg -= leg == legs.begin() ? 0 : 1;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::int64_t number = first + static_cast<std::int64_t>(i);
    while (leg + 1 != legs.end() && number >= (leg + 1)->first) {
      ++leg;
    }
    GRAVURE_TRY(out[i], data_->instant(*leg, number));
  }
  return {};
}

double ZoneMotion::length_mm() const noexcept {
  return data_->along_mm;
}

const ZoneTimes& ZoneMotion::times() const noexcept {
  return data_->times;
}

const std::vector<PathTarget>& ZoneMotion::targets() const noexcept {
  return data_->targets;
}

}  // namespace gravure::zones
