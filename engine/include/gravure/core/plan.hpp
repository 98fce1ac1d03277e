#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/exact.hpp"
#include "gravure/core/job.hpp"
#include "gravure/core/path_motion.hpp"

namespace gravure {

/// The exact integers of a job, and every figure that follows from them. Made only by make_plan() (sync), which
/// states what it guarantees; stored in the program as JSON by formats/plan. Ticks are FPGA ticks (j per seed pulse).

struct ClockPlan {
  std::int64_t seed_hz = 0;
  std::int64_t fpga_hz = 0;         ///< j * seed
  std::int64_t pulse_divider = 1;   ///< k
  Rational pulse_hz = 0;            ///< seed / k
  std::int64_t ticks_per_slot = 0;  ///< j * k
};

/// What the board counts of a line, 24 bits; the emulated board refuses more.
inline constexpr std::int64_t kMostSlotsPerLine = (std::int64_t{1} << 24) - 1;

struct LinePlan {
  std::int64_t pixels = 0;
  std::int64_t slots = 0;  ///< np: run-in + pixels + run-out, whole microvectors
  std::int64_t slots_per_microvector = 1;
  std::int64_t ticks = 0;  ///< np * ticks_per_slot
  bool bidirectional = true;
  /// First slot of the marking window of a line. The reverse line is the forward line run backwards in time, later by
  /// the whole slots of the bidirectional offset.
  std::int64_t forward_first_slot = 0;
  std::int64_t reverse_first_slot = 0;
  std::int64_t offset_slots = 0;            ///< bidirectional offset, whole slots, towards zero
  std::int64_t offset_remainder_ticks = 0;  ///< what is left of it, same sign; |remainder| < ticks_per_slot
  Rational rate_hz = 0;                     ///< lines per second
  Rational pixel_pitch_um = 0;
  Rational scan_speed_m_s = 0;  ///< pixel pitch * pulse rate
};

/// The cross-scan axis. In flat mode it is the stage: a revolution is a pass, the circumference its length, the surface
/// speed that of the stage.
struct RotaryPlan {
  std::int64_t lines_per_revolution = 0;  ///< nL
  Rational circumference_um = 0;          ///< as given, or pi (100 decimals) * diameter
  Rational line_pitch_um = 0;             ///< circumference / nL
  std::int64_t ticks_per_revolution = 0;
  Rational rpm = 0;  ///< 0 in flat mode
  Rational surface_speed_mm_s = 0;
  Rational encoder_pitch_um = 0;   ///< flat mode alone: travel of one encoder line
  std::int64_t encoder_lines = 0;  ///< 0 in flat mode
  int interpolation_bits = 0;
  std::int64_t gear_encoder_turns = 1;
  std::int64_t gear_workpiece_turns = 1;
  Rational edges_per_revolution = 0;  ///< A-B edges per workpiece revolution: 4 * 2^q * nenc * gear
};

/// [B] eqs 1 to 11 and equations 2.1 to 2.6. All drifts are against the wanted frequency; positive: the axis leads.
struct AbPlan {
  int counter_bits = 32;           ///< n
  std::uint64_t prescaler = 1;     ///< m >= 1
  std::uint64_t increment = 0;     ///< 1 <= increment + carry <= 2^(n-2)
  std::uint64_t fraction_num = 0;  ///< the second accumulator: num < den; 0/1 without it
  std::uint64_t fraction_den = 1;
  Rational wanted_increment = 0;  ///< X: counts per FPGA clock, [B] eq. 6
  Rational wanted_hz = 0;         ///< A-B periods per second at the interpolated encoder input, [B] eq. 5
  Rational output_hz = 0;         ///< emitted, [B] eq. 1
  std::int64_t max_output_hz = 0;
  bool exact = false;  ///< output == wanted: zero drift for ever
  Rational drift_lines_per_revolution = 0;
  Rational drift_um_per_revolution = 0;
  Rational seam_limit_um = 0;
  std::optional<Integer> lines_until_limit;  ///< first line at which |drift| reaches the limit; none: never
  std::optional<Integer> revolutions_until_limit;
  Integer bound_lines_until_limit = 0;  ///< the published worst case 1/(2 increment), [B] eq. 10
};

/// A stretch of a ramp as the board's schedule registers take it (schedule_increment, schedule_seeds).
struct SpinSegment {
  std::uint64_t increment = 0;  ///< of the counter; prescaler and fraction are those of marking
  std::int64_t seeds = 0;       ///< seed clocks it lasts: whole steps of the prescaler, but for one at rest

  friend bool operator==(const SpinSegment&, const SpinSegment&) = default;
};

/// An axis between rest and its marking speed: a staircase of increments along a jerk-limited ramp. Lengths are degrees
/// of the workpiece (rotary axis) or mm (stage, carriage).
struct SpinPlan {
  std::vector<SpinSegment> segments;
  std::int64_t ticks = 0;         ///< of all segments; a spin-up ends, a spin-down begins with the marking
  Integer counts = 0;             ///< the counter puts out in them, exactly; 2^(n-2) are an A-B edge
  Rational travel = 0;            ///< of the axis, exactly
  Rational duration_s = 0;        ///< exactly
  Rational max_acceleration = 0;  ///< of the ramp
  Rational max_jerk = 0;          ///< of the ramp
  Rational speed_error = 0;       ///< largest difference of staircase and ramp, a second
};

/// Both ends of a job, where all three limits of an axis are given.
struct AxisSpin {
  SpinPlan up;
  SpinPlan down;
  /// Rotary axis: line 0 lies at this angle from the encoder index, where the axis stood before, whole turns included,
  /// and travel - start_deg is what an A-B edge is too coarse for.
  Rational start_deg = 0;
  Rational start_error_deg = 0;
  Rational total_s = 0;  ///< of the job: spin-up, marking and spin-down; in flat mode every pass has its own
};

/// Helical mode: what the carriage does while the workpiece turns. With h columns a revolution, nL lines and L layers,
/// segment s (0 trails, L - 1 leads) of line l of revolution R covers the columns from floor(h (R - L + s + l / nL)) up
/// to the start of the next segment, and exposes layer L - 1 - s: over all revolutions each segment covers each column
/// once, so every column gets every layer once, the first layer first.
struct CarriagePlan {
  Rational feed_pixels = 0;         ///< h
  Rational feed_um = 0;             ///< h * pixel pitch, along the axis in a revolution
  std::int64_t layers = 0;          ///< L
  std::int64_t columns = 0;         ///< of the images
  std::int64_t window_columns = 0;  ///< most columns a line exposes, ceil(L h): the pixels of the line
  /// L of run-in, in which the leading segments come to the first column, and ceil(columns / h).
  std::int64_t revolutions = 0;
  Rational travel_mm = 0;  ///< of the carriage over the job
  Rational speed_mm_s = 0;
  Rational encoder_pitch_um = 0;
  int interpolation_bits = 0;
  Rational edges_per_revolution = 0;  ///< A-B edges per workpiece revolution: 4 * 2^q * feed / encoder pitch
  AbPlan ab;                          ///< the second channel; its lines and um are those of the carriage's travel
  std::optional<AxisSpin> spin;       ///< none: it moves already at tick 0 and goes on at the end
};

/// An image wider than the scan field, exposed in strips: band b starts at column b * line.pixels, and has all its
/// revolutions (passes) before the next band begins.
struct BandsPlan {
  std::int64_t count = 0;
  std::int64_t columns = 0;  ///< of the images; the last band may hold fewer than the others, the rest stays dark
  std::int64_t revolutions_per_band = 0;
  Rational step_mm = 0;  ///< what the stage along the axis moves from a band to the next: the pixels of a line
};

/// The scanner as the job or its machine file describes it: what is needed, with the rest of the plan, to say where
/// both mirrors stand on every tick and what the light does (scan: plan_trajectory()).
struct ScannerPlan {
  Rational field_mm = 0;     ///< side of the square field; the marking windows lie in it
  int resolution_bits = 20;  ///< set-points are integers of so many bits over the field
  Rational lag_us = 0;       ///< the mirrors follow their set-points so much later
  bool compensate_lag = true;
  std::optional<Rational> max_speed_mm_s;  ///< of each mirror; absent limits are not checked
  std::optional<Rational> max_acceleration_mm_s2;
  std::optional<Rational> max_jerk_mm_s3;
  bool cross_scan_correction = true;  ///< V follows the moving surface
  Rational offset_deg = 0;            ///< where round the circumference the lines lie, 0 at the top
  Rational tilt_deg_per_mm = 0;  ///< f-theta lens: tilt of the beam a mm of distance from the centre; 0: telecentric
  std::string field_grid;        ///< text of the scanner's distortion (docs/formats/field_grid.md); empty: none
};

/// A field grid in a plan has at most so many bytes: a program carries it.
inline constexpr std::size_t kMostPlanGridBytes = std::size_t{1} << 19U;

/// An axis of a path program. Set-points are integers: counts = position * counts_per_unit, rounded, with positions in
/// mm and, for A and C, rad. Limits and range are mm and degrees, as everywhere.
struct PathAxisPlan {
  Rational counts_per_unit = 0;
  AxisLimits limits;
  std::optional<Rational> least;  ///< travel; absent: not checked. U, V: the scan field
  std::optional<Rational> most;
};

/// A bitmap whose pixels are the pulses of the path, in order: row after row, even rows left to right, odd ones back.
struct PathPicture {
  std::int64_t width = 0;
  std::int64_t height = 0;
};

/// A program that follows a path (freeform, zones): one revolution whose lines are the servo periods, line.slots pulse
/// slots each, all of them in the marking window, all run the same way. There is a set-point of all axes at the start
/// of every line and one at the end of the last, between which axes move as cubic_between() (core/path_expand.hpp)
/// says. line.pixel_pitch_um is the pitch of the pulses along the path. No A-B axis turns: of `rotary` there are
/// lines_per_revolution and ticks_per_revolution alone, and nothing of `ab`.
struct PathPlan {
  /// In the order of kPathAxes; with the focus axis one more.
  std::vector<PathAxisPlan> axes = std::vector<PathAxisPlan>(kFocusAxis);
  bool has_focus_axis() const { return axes.size() > kFocusAxis; }
  Rational along_counts_per_mm = 0;  ///< of the length of path covered, stored beside the axes
  std::int64_t pulses = 0;           ///< along the path, fired or not
  std::int64_t targets = 0;          ///< points of the wanted path that the program stores; 0: none
  std::optional<PathPicture> picture;
  std::optional<Rational> max_focus_offset_um;  ///< of every fired pulse; absent: not judged
  std::optional<Rational> max_incidence_deg;
  std::optional<Rational> max_displacement_mm;  ///< of the galvo from the centre of its field
  std::optional<Rational> max_landing_um;       ///< from the point on the wanted path where the pulse belongs
  std::string machine;  ///< signs of A and C: "texturing" or "post_processor" (docs/kinematics.md)
  std::array<Rational, 3> rotary_centre_mm{};  ///< where A and C meet, in the frame of the workpiece
  std::string surface;                         ///< what the job says of it, for people
  std::string texture;
};

struct JobPlan {
  std::int64_t revolutions = 0;
  std::int64_t ticks = 0;
  Rational duration_s = 0;
};

struct Plan {
  std::string title;
  Mode mode = Mode::rotary;
  ClockPlan clock;
  LinePlan line;
  RotaryPlan rotary;
  AbPlan ab;
  std::optional<AxisSpin> spin;          ///< of the cross-scan axis; none: it turns already at tick 0 and goes on
  std::optional<CarriagePlan> carriage;  ///< helical mode
  std::optional<BandsPlan> bands;        ///< none: the image fits the field
  std::optional<ScannerPlan> scanner;    ///< none: the job does not say how large the field is
  std::optional<PathPlan> path;          ///< freeform and zones
  JobPlan job;
  std::vector<std::string> warnings;
};

/// Columns of the images the plan was made for.
inline std::int64_t image_columns(const Plan& plan) {
  return plan.carriage ? plan.carriage->columns : plan.bands ? plan.bands->columns : plan.line.pixels;
}

/// Revolutions (passes) of each band; of the job, where there is one band.
inline std::int64_t revolutions_per_band(const Plan& plan) {
  return plan.bands ? plan.bands->revolutions_per_band : plan.job.revolutions;
}

/// A line runs right to left? The scanner alternates without a break from the first line of the job to the last, so
/// with an odd number of lines per revolution the same line of the next revolution runs the other way.
inline bool line_is_reverse(const Plan& plan, std::int64_t revolution, std::int64_t line) {
  return plan.line.bidirectional && (((revolution & plan.rotary.lines_per_revolution) ^ line) & 1) != 0;
}

}  // namespace gravure
