#include "gravure/scan/job_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "gravure/core/exposure_map.hpp"
#include "gravure/core/units.hpp"
#include "set_point_at.hpp"

namespace gravure::scan {
namespace {

using kinematics::FieldPoint;
using kinematics::JointPositions;
using kinematics::Vector3;

constexpr double kTurn = 2 * 3.14159265358979323846;

/// From 0 to 1, speed and acceleration 0 at both ends: 10 x^3 - 15 x^4 + 6 x^5.
double blend(double x) noexcept {
  const double share = std::clamp(x, 0.0, 1.0);
  return share * share * share * (10 + share * (-15 + 6 * share));
}

/// Along the beam to the cylinder about the x axis; in the dark, where no beam meets it, the focus.
Vector3 on_cylinder(const kinematics::Spot& spot, double radius_mm) {
  const Vector3& p = spot.position_mm;
  const Vector3& b = spot.towards_head;
  const double a = b.y() * b.y() + b.z() * b.z();
  const double half = p.y() * b.y() + p.z() * b.z();
  const double rest = p.y() * p.y() + p.z() * p.z() - radius_mm * radius_mm;
  const double square = half * half - a * rest;
  if (square < 0) {
    return p;
  }
  // The crossing nearer to the head; without cancellation where the focus lies on the surface.
  return p - rest / (half + std::sqrt(square)) * b;
}

}  // namespace

JobTrajectory::JobTrajectory(const Plan& plan)
    : plan_(plan), map_(plan), pitch_mm_(to_double(plan.line.pixel_pitch_um) / kUmPerMm) {
  if (plan.carriage) {
    const Rational step = plan.carriage->feed_pixels / Rational(plan.rotary.lines_per_revolution);
    feed_num_ = static_cast<std::int64_t>(numerator_of(step));  // fits: ExposureMap::fits()
    feed_den_ = static_cast<std::int64_t>(denominator_of(step));
  }
}

Result<JobTrajectory> JobTrajectory::make(const Plan& plan) {
  JobTrajectory job(plan);
  GRAVURE_TRY(LineTrajectory onwards, plan_trajectory(plan));
  job.sweeps_.push_back(std::move(onwards));
  if (plan.mode == Mode::flat && plan.job.revolutions > 1) {
    GRAVURE_TRY(LineTrajectory backwards, plan_trajectory(plan, Sweep::backwards));
    job.sweeps_.push_back(std::move(backwards));
  }
  return job;
}

const LineTrajectory& JobTrajectory::of_revolution(std::int64_t revolution) const noexcept {
  return sweeps_[sweeps_.size() > 1 && map_.runs_backwards(revolution) ? 1 : 0];
}

Direction JobTrajectory::direction_of(const LineNumber& number) const noexcept {
  return line_is_reverse(plan_, number.revolution, number.line) ? Direction::reverse : Direction::forward;
}

std::int64_t JobTrajectory::ordinal_of(const LineNumber& number) const noexcept {
  return number.revolution * plan_.rotary.lines_per_revolution + number.line;
}

LineNumber JobTrajectory::number_of(std::int64_t ordinal) const noexcept {
  const std::int64_t lines = plan_.rotary.lines_per_revolution;
  const std::int64_t revolution = ordinal >= 0 ? ordinal / lines : -((-ordinal + lines - 1) / lines);
  return {revolution, ordinal - revolution * lines};
}

/// What U takes up on a line: the window stands so far before the carriage.
double JobTrajectory::fraction_mm(std::int64_t ordinal) const noexcept {
  __extension__ using Wide = __int128;
  const std::int64_t steps = ordinal - plan_.carriage->layers * plan_.rotary.lines_per_revolution;
  const auto rest = static_cast<std::int64_t>(static_cast<Wide>(feed_num_) * steps % feed_den_);
  const std::int64_t numerator = rest < 0 ? rest + feed_den_ : rest;
  return -static_cast<double>(numerator) / static_cast<double>(feed_den_) * pitch_mm_;
}

double JobTrajectory::shift_mm(const LineNumber& number, double slot) const {
  if (!plan_.carriage) {
    return 0;
  }
  const LinePath& path = sweeps_.front().path;
  const auto slots = static_cast<double>(path.timing().slots);
  const double lines = std::floor(slot / slots);
  const std::int64_t ordinal = ordinal_of(number) + static_cast<std::int64_t>(lines);
  const double within = slot - lines * slots;
  const auto marks = [&](std::int64_t of) { return path.marking(direction_of(number_of(of))); };
  const LinePath::Window here = marks(ordinal);
  if (within >= here.begin && within <= here.end) {
    return fraction_mm(ordinal);
  }
  const std::int64_t before = within < here.begin ? ordinal - 1 : ordinal;
  const double begin = marks(before).end - (within < here.begin ? slots : 0);
  const double end = marks(before + 1).begin + (within < here.begin ? 0 : slots);
  const double from = fraction_mm(before);
  return from + (fraction_mm(before + 1) - from) * blend((within - begin) / (end - begin));
}

Result<SetPoint> JobTrajectory::set_point(std::int64_t ordinal, std::int64_t index) const {
  const LineNumber number = number_of(ordinal);
  const LineTrajectory& trajectory = of_revolution(number.revolution);
  const double slot = set_point_slot(trajectory.path.timing(), trajectory.lag_ticks, index);
  return set_point_at(trajectory, direction_of(number), slot, shift_mm(number, slot));
}

Result<std::vector<SetPoint>> JobTrajectory::set_points(const LineNumber& number) const {
  const LineTrajectory& trajectory = of_revolution(number.revolution);
  if (!plan_.carriage) {
    return trajectory.set_points(direction_of(number));
  }
  std::vector<SetPoint> points;
  points.reserve(trajectory.forward.size());
  for (std::size_t k = 0; k < trajectory.forward.size(); ++k) {
    GRAVURE_TRY(const SetPoint point, set_point(ordinal_of(number), static_cast<std::int64_t>(k)));
    points.push_back(point);
  }
  return points;
}

std::vector<LineSetPoints> JobTrajectory::stored_set_points() const {
  std::vector<LineSetPoints> kinds = kinds_of_lines(plan_);
  for (LineSetPoints& kind : kinds) {
    const LineTrajectory& trajectory = sweeps_[kind.backwards ? 1 : 0];
    for (const SetPoint& point : trajectory.set_points(kind.reverse ? Direction::reverse : Direction::forward)) {
      kind.u_counts.push_back(point.u_count);
      kind.v_counts.push_back(point.v_count);
    }
  }
  return kinds;
}

namespace {

Result<void> check_counts(const LineSetPoints& kind, const char* axis, const std::vector<std::int32_t>& stored,
                          const std::vector<std::int32_t>& planned) {
  const std::size_t count = std::min(stored.size(), planned.size());
  const auto wrong =
      std::mismatch(stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(count), planned.begin());
  const auto k = static_cast<std::size_t>(wrong.first - stored.begin());
  if (k == count && stored.size() == planned.size()) {
    return {};
  }
  const std::string lines =
      std::string(kind.reverse ? "reverse" : "forward") + " lines" + (kind.backwards ? " of the passes back" : "");
  return Error{ErrorCode::bad_file, k == count
                                        ? "the " + lines + " have " + std::to_string(stored.size()) +
                                              " set-points, their plan gives " + std::to_string(planned.size()) +
                                              ": compile the job again"
                                        : "set-point " + std::to_string(k) + " of " + lines + " is stored as " + axis +
                                              " = " + std::to_string(stored[k]) + " counts, its plan gives " +
                                              std::to_string(planned[k]) + ": compile the job again"};
}

}  // namespace

Result<void> JobTrajectory::check_stored(const std::vector<LineSetPoints>& stored) const {
  if (stored.empty()) {
    return {};
  }
  const std::vector<LineSetPoints> planned = stored_set_points();
  if (stored.size() != planned.size()) {
    return Error{ErrorCode::bad_file, "there are set-points of " + std::to_string(stored.size()) +
                                          " kinds of lines, the plan has " + std::to_string(planned.size()) +
                                          ": compile the job again"};
  }
  for (std::size_t row = 0; row < stored.size(); ++row) {
    GRAVURE_CHECK(check_counts(planned[row], "U", stored[row].u_counts, planned[row].u_counts));
    GRAVURE_CHECK(check_counts(planned[row], "V", stored[row].v_counts, planned[row].v_counts));
  }
  return {};
}

Result<FieldPoint> JobTrajectory::mirrors_at(std::int64_t ordinal, double slot, const LandingModel& model) const {
  const LineTrajectory& trajectory = of_revolution(number_of(ordinal).revolution);
  const LineTiming& timing = trajectory.path.timing();
  const double followed = slot - model.lag_us * 1e-6 / timing.slot_s();
  if (!model.microvectors) {
    const double early = static_cast<double>(trajectory.lag_ticks) / static_cast<double>(timing.ticks_per_slot);
    const LineNumber number = number_of(ordinal);
    FieldPoint wanted = trajectory.path.at(direction_of(number), followed + early);
    wanted.u_mm += shift_mm(number, followed + early);
    return model.rounding ? rounded(wanted, trajectory.resolution_mm) : FieldPoint{wanted.u_mm, wanted.v_mm, 0};
  }
  const auto slots = static_cast<double>(timing.slots);
  const double lines = std::floor(followed / slots);
  const std::int64_t here = ordinal + static_cast<std::int64_t>(lines);
  const double microvectors = (followed - lines * slots) / static_cast<double>(timing.slots_per_microvector);
  const std::int64_t count = timing.slots / timing.slots_per_microvector;
  const std::int64_t index = std::min(static_cast<std::int64_t>(microvectors), count - 1);
  GRAVURE_TRY(const SetPoint a, set_point(here, index));
  GRAVURE_TRY(const SetPoint b, index + 1 < count ? set_point(here, index + 1) : set_point(here + 1, 0));
  return between(trajectory, a, b, microvectors - static_cast<double>(index), model.rounding);
}

/// Where the head stands along the workpiece at the middle of a forward window.
double JobTrajectory::head_mm(const LineNumber& number) const {
  const Rational to_centre = ratio(plan_.line.pixels - 1, 2);
  Rational columns = 0;
  if (plan_.carriage) {
    const HelicalWindow window = helical_window(plan_, number.revolution, number.line);
    columns = Rational(window.first_column) + window.fraction;
  } else {
    columns = Rational(number.revolution / revolutions_per_band(plan_) * plan_.line.pixels);
  }
  return to_double((columns + to_centre) * plan_.line.pixel_pitch_um) / kUmPerMm;
}

JointPositions JobTrajectory::joints_at(const LineNumber& number, double slot, bool turns_counted) const {
  const LineTrajectory& trajectory = of_revolution(number.revolution);
  JointPositions joints = trajectory.path.joints_at(slot);
  const auto lines = static_cast<double>(plan_.rotary.lines_per_revolution);
  if (plan_.mode == Mode::flat) {
    const std::int64_t line = map_.image_line(number.revolution, number.line);
    joints[0] += head_mm(number);
    joints[1] += static_cast<double>(line) * to_double(plan_.rotary.line_pitch_um) / kUmPerMm;
    return joints;
  }
  joints[0] += kTurn * static_cast<double>(number.line) / lines;
  joints[0] += turns_counted ? kTurn * static_cast<double>(number.revolution) : 0;
  joints[1] += head_mm(number);
  return joints;
}

Result<SlotState> JobTrajectory::at(const LineNumber& number, std::int64_t slot, const LandingModel& model) const {
  const LineTrajectory& trajectory = of_revolution(number.revolution);
  const LineGeometry& geometry = trajectory.path.geometry();
  const LineTiming& timing = trajectory.path.timing();
  const Direction direction = direction_of(number);
  const double time = timing.pulse_at(direction, slot);
  SlotState state;
  const std::int64_t ordinal = ordinal_of(number);
  state.tick = (ordinal * timing.slots + slot) * timing.ticks_per_slot +
               (direction == Direction::reverse ? timing.offset_remainder_ticks : 0);
  GRAVURE_TRY(state.mirrors, mirrors_at(ordinal, time, model));
  state.joints = joints_at(number, time, true);
  const auto spot = kinematics::forward(geometry.machine, joints_at(number, time, false), state.mirrors);
  state.spot_mm = plan_.mode == Mode::flat
                      ? Vector3(spot.position_mm - spot.position_mm.z() / spot.towards_head.z() * spot.towards_head)
                      : on_cylinder(spot, to_double(plan_.rotary.circumference_um) / kUmPerMm / kTurn);
  return state;
}

Vector3 JobTrajectory::target_of(const LineNumber& number, std::int64_t pixel) const {
  const std::int64_t first = plan_.carriage ? helical_window(plan_, number.revolution, number.line).first_column
                                            : number.revolution / revolutions_per_band(plan_) * plan_.line.pixels;
  const double x = static_cast<double>(first + pixel) * pitch_mm_;
  const auto line = static_cast<double>(map_.image_line(number.revolution, number.line));
  if (plan_.mode == Mode::flat) {
    return {x, line * to_double(plan_.rotary.line_pitch_um) / kUmPerMm, 0};
  }
  const double radius = to_double(plan_.rotary.circumference_um) / kUmPerMm / kTurn;
  const double angle = kTurn * line / static_cast<double>(plan_.rotary.lines_per_revolution) +
                       to_double(plan_.scanner->offset_deg) * kTurn / 360;
  return {x, radius * std::sin(angle), radius * std::cos(angle)};
}

}  // namespace gravure::scan
