#include "src/freeform_keys.hpp"

#include <numbers>

#include "src/key_rows.hpp"

namespace gravure::freeform_file {
namespace {

using Store = KeyRows<FreeformJob>::Store;
using Bound = std::optional<double> GivenBounds::*;

constexpr std::array kSections = std::to_array<std::string_view>(
    {"job", "laser", "fpga", "surface", "texture", "split", "limits", "clamping", "motion", "axis.X", "axis.Y",
     "axis.Z", "axis.A", "axis.C", "axis.U", "axis.V", "axis.W"});
constexpr std::array<std::string_view, 1> kParents = {"axis"};
constexpr std::array<std::string_view, 1> kModes = {"freeform"};
constexpr std::array<std::string_view, 2> kFires = {"white", "black"};

constexpr std::string_view kMostUm = "1_000_000_000";
constexpr std::string_view kMostMm = "1_000_000";
constexpr std::string_view kMostPlaceMm = "10_000";
constexpr std::string_view kOneSurface = "one of expression, height_field, mesh";
constexpr std::string_view kOneTexture = "one of hilbert_order, path, svg, bitmap";
constexpr std::string_view kTableOne = "that of [A] table 1";

constexpr auto integer = KeyRows<FreeformJob>::integer;
constexpr auto word = KeyRows<FreeformJob>::word;
constexpr auto other = KeyRows<FreeformJob>::other;

constexpr Key decimal(std::string_view section, std::string_view key, std::string_view unit, std::string_view high,
                      std::string_view fallback, Store store, std::string_view low = kLeastAboveZero) {
  return KeyRows<FreeformJob>::decimal(section, key, unit, low, high, fallback, store);
}

template <std::size_t axis, Bound bound>
void store_bound(FreeformJob& job, const Value& value) {
  const bool turns = kPathAxes[axis] == "A" || kPathAxes[axis] == "C";
  job.motion.limits[axis].*bound = to_double(value.number) * (turns ? std::numbers::pi / 180 : 1);
}

template <std::size_t axis, Bound bound>
constexpr Key axis_key(std::string_view section, std::string_view key, std::string_view unit, std::string_view most) {
  return decimal(section, key, unit, most, kTableOne, store_bound<axis, bound>);
}

/// Nobody has published limits of a focus axis: none are assumed.
template <Bound bound>
constexpr Key focus_key(std::string_view key, std::string_view unit, std::string_view most) {
  return decided(decimal("axis.W", key, unit, most, "required with focus_axis", store_bound<kFocusAxis, bound>));
}

using Loop = std::optional<double> GivenServo::*;

template <std::size_t axis, Loop loop>
void store_loop(FreeformJob& job, const Value& value) {
  job.motion.servos[axis].*loop = to_double(value.number);
}

constexpr Key servo_hz_key(std::string_view section, std::string_view assumed, Store store) {
  return decimal(section, "servo_hz", "Hz", "1_000_000", assumed, store);
}

constexpr Key servo_damping_key(std::string_view section, Store store) {
  return decimal(section, "servo_damping", "", "100", "0.7, assumed", store);
}

std::vector<double> numbers_of(const Value& value) {
  std::vector<double> numbers;
  for (const Value& item : value.items) {
    numbers.push_back(to_double(item.number));
  }
  return numbers;
}

constexpr Loop kHz = &GivenServo::natural_hz;
constexpr Loop kDamping = &GivenServo::damping;
constexpr Bound kSpeed = &GivenBounds::speed;
constexpr Bound kAcceleration = &GivenBounds::acceleration;
constexpr Bound kJerk = &GivenBounds::jerk;

constexpr std::array kTable = {
    other("job", "title", Type::title, "\"\"", [](FreeformJob& j, const Value& v) { j.job.title = v.text; }),
    word("job", "mode", kModes, kRequired, [](FreeformJob& j, const Value&) { j.job.mode = Mode::freeform; }),

    integer("laser", "seed_hz", "Hz", "1", kBiggestHz, kRequired,
            [](FreeformJob& j, const Value& v) { j.job.laser.seed_hz = v.integer; }),
    integer("laser", "pulse_divider", "seed pulses", "1", "65_535", kRequired,
            [](FreeformJob& j, const Value& v) { j.job.laser.pulse_divider = v.integer; }),
    integer("laser", "max_pulse_on_demand_hz", "Hz", "1", kBiggestHz, kRequired,
            [](FreeformJob& j, const Value& v) { j.job.laser.max_pulse_on_demand_hz = v.integer; }),

    integer("fpga", "clock_multiplier", "FPGA ticks per seed pulse", "1", "16", kRequired,
            [](FreeformJob& j, const Value& v) { j.job.fpga.clock_multiplier = v.integer; }),

    decided(other("surface", "expression", Type::text, kOneSurface,
                  [](FreeformJob& j, const Value& v) { j.texture.surface = v.text; })),
    decided(other("surface", "height_field", Type::path, kOneSurface,
                  [](FreeformJob& j, const Value& v) { j.texture.height_field = v.text; })),
    decided(other("surface", "mesh", Type::path, kOneSurface,
                  [](FreeformJob& j, const Value& v) { j.texture.mesh = v.text; })),
    decided(decimal("surface", "pixel_um", "um", kMostUm, "required with height_field",
                    [](FreeformJob& j, const Value& v) { j.texture.pixel_um = to_double(v.number); })),
    decimal("surface", "pixel_y_um", "um", kMostUm, "pixel_um",
            [](FreeformJob& j, const Value& v) { j.texture.pixel_y_um = to_double(v.number); }),
    Key{{"surface",
         "height_mm",
         Type::two_decimals,
         "mm",
         "-10_000",
         kMostPlaceMm,
         {},
         Presence::optional,
         "samples are mm (floats alone)"},
        [](FreeformJob& j, const Value& v) { j.texture.height_mm = numbers_of(v); }},
    decimal("surface", "max_slope_deg", "deg", "90", "80",
            [](FreeformJob& j, const Value& v) { j.texture.max_slope_deg = to_double(v.number); }),

    decided(integer("texture", "hilbert_order", "", "1", "10", kOneTexture,
                    [](FreeformJob& j, const Value& v) { j.texture.hilbert_order = static_cast<int>(v.integer); })),
    decided(other("texture", "path", Type::path, kOneTexture,
                  [](FreeformJob& j, const Value& v) { j.texture.path = v.text; })),
    decided(other("texture", "svg", Type::path, kOneTexture,
                  [](FreeformJob& j, const Value& v) { j.texture.svg = v.text; })),
    decided(other("texture", "bitmap", Type::path, kOneTexture,
                  [](FreeformJob& j, const Value& v) { j.texture.bitmap = v.text; })),
    decimal("texture", "pitch_um", "um", kMostUm, kRequired,
            [](FreeformJob& j, const Value& v) { j.texture.pitch_um = to_double(v.number); }),
    decimal("texture", "size_mm", "mm", kMostPlaceMm, "40",
            [](FreeformJob& j, const Value& v) { j.texture.size_mm = to_double(v.number); }),
    decided(decimal("texture", "step_um", "um", kMostUm, "required with path and svg, else 100",
                    [](FreeformJob& j, const Value& v) { j.texture.step_um = to_double(v.number); })),
    decimal("texture", "tolerance_um", "um", kMostMm, "1",
            [](FreeformJob& j, const Value& v) { j.texture.tolerance_um = to_double(v.number); }),
    decimal("texture", "line_pitch_um", "um", kMostUm, "pitch_um",
            [](FreeformJob& j, const Value& v) { j.texture.line_pitch_um = to_double(v.number); }),
    decimal(
        "texture", "run_out_um", "um", kMostUm, "500",
        [](FreeformJob& j, const Value& v) { j.texture.run_out_um = to_double(v.number); }, "0"),
    decided(word("texture", "fires", kFires, "required with bitmap",
                 [](FreeformJob& j, const Value& v) { j.texture.fires = v.text; })),
    integer("texture", "threshold", "", "0", "65_535", "none: the bitmap is bilevel",
            [](FreeformJob& j, const Value& v) { j.texture.threshold = v.integer; }),

    word("split", "method", kSplitMethods, "\"gaussian\"",
         [](FreeformJob& j, const Value& v) { j.split.method = v.text; }),
    decimal("split", "sigma_um", "um", kMostUm, "by rule",
            [](FreeformJob& j, const Value& v) { j.split.sigma_um = to_double(v.number); }),
    word("split", "rule", kSigmaRules, "\"time\"", [](FreeformJob& j, const Value& v) { j.split.rule = v.text; }),
    decimal(
        "split", "time_share_percent", "%", "1_000", "0.5",
        [](FreeformJob& j, const Value& v) { j.split.time_share_percent = to_double(v.number); }, "0"),
    decimal("split", "cut", "sigma", "38", "8",
            [](FreeformJob& j, const Value& v) { j.split.cut = to_double(v.number); }),
    Key{{"split", "focus_axis", Type::boolean, "", "", "", {}, Presence::optional, "false"},
        [](FreeformJob& j, const Value& v) { j.split.focus_axis = v.boolean; }},

    decimal("limits", "fod_um", "um", kMostUm, "100",
            [](FreeformJob& j, const Value& v) { j.split.fod_um = to_double(v.number); }),
    decimal("limits", "focus_mm", "mm", kMostMm, "not judged",
            [](FreeformJob& j, const Value& v) { j.split.focus_mm = to_double(v.number); }),
    decimal("limits", "bia_deg", "deg", "90", "10",
            [](FreeformJob& j, const Value& v) { j.split.bia_deg = to_double(v.number); }),
    decimal("limits", "displacement_mm", "mm", kMostMm, "5",
            [](FreeformJob& j, const Value& v) { j.split.displacement_mm = to_double(v.number); }),
    decimal("limits", "landing_um", "um", kMostMm, "not judged",
            [](FreeformJob& j, const Value& v) { j.split.landing_um = to_double(v.number); }),

    Key{{"clamping", "origin_mm", Type::three_decimals, "mm", "-1_000", "1_000", {}, Presence::optional, "[0, 0, 0]"},
        [](FreeformJob& j, const Value& v) { j.axes.origin_mm = numbers_of(v); }},
    Key{{"clamping", "tilt_deg", Type::two_decimals, "deg", "-180", "180", {}, Presence::optional, "[0, 0]"},
        [](FreeformJob& j, const Value& v) { j.axes.tilt_deg = numbers_of(v); }},

    word("motion", "signs", kSigns, "\"texturing\"", [](FreeformJob& j, const Value& v) { j.axes.signs = v.text; }),
    word("motion", "branch", kBranches, "\"positive\"", [](FreeformJob& j, const Value& v) { j.axes.branch = v.text; }),
    word("motion", "stops", kStops, "\"points\" of a Hilbert curve, else \"corners\"",
         [](FreeformJob& j, const Value& v) { j.motion.stops = v.text; }),
    decimal(
        "motion", "servo_us", "us", "100_000", "50",
        [](FreeformJob& j, const Value& v) { j.motion.servo_us = to_double(v.number); }, "1"),

    axis_key<0, kSpeed>("axis.X", "max_speed_mm_s", "mm/s", kMostSpeed),
    axis_key<0, kAcceleration>("axis.X", "max_acceleration_mm_s2", "mm/s^2", kMostAcceleration),
    axis_key<0, kJerk>("axis.X", "max_jerk_mm_s3", "mm/s^3", kMostJerk),
    servo_hz_key("axis.X", "50, assumed", store_loop<0, kHz>),
    servo_damping_key("axis.X", store_loop<0, kDamping>),
    axis_key<1, kSpeed>("axis.Y", "max_speed_mm_s", "mm/s", kMostSpeed),
    axis_key<1, kAcceleration>("axis.Y", "max_acceleration_mm_s2", "mm/s^2", kMostAcceleration),
    axis_key<1, kJerk>("axis.Y", "max_jerk_mm_s3", "mm/s^3", kMostJerk),
    servo_hz_key("axis.Y", "50, assumed", store_loop<1, kHz>),
    servo_damping_key("axis.Y", store_loop<1, kDamping>),
    axis_key<2, kSpeed>("axis.Z", "max_speed_mm_s", "mm/s", kMostSpeed),
    axis_key<2, kAcceleration>("axis.Z", "max_acceleration_mm_s2", "mm/s^2", kMostAcceleration),
    axis_key<2, kJerk>("axis.Z", "max_jerk_mm_s3", "mm/s^3", kMostJerk),
    servo_hz_key("axis.Z", "50, assumed", store_loop<2, kHz>),
    servo_damping_key("axis.Z", store_loop<2, kDamping>),
    axis_key<3, kSpeed>("axis.A", "max_speed_deg_s", "deg/s", kMostSpeed),
    axis_key<3, kAcceleration>("axis.A", "max_acceleration_deg_s2", "deg/s^2", kMostAcceleration),
    axis_key<3, kJerk>("axis.A", "max_jerk_deg_s3", "deg/s^3", kMostJerk),
    servo_hz_key("axis.A", "30, assumed", store_loop<3, kHz>),
    servo_damping_key("axis.A", store_loop<3, kDamping>),
    axis_key<4, kSpeed>("axis.C", "max_speed_deg_s", "deg/s", kMostSpeed),
    axis_key<4, kAcceleration>("axis.C", "max_acceleration_deg_s2", "deg/s^2", kMostAcceleration),
    axis_key<4, kJerk>("axis.C", "max_jerk_deg_s3", "deg/s^3", kMostJerk),
    servo_hz_key("axis.C", "30, assumed", store_loop<4, kHz>),
    servo_damping_key("axis.C", store_loop<4, kDamping>),
    axis_key<5, kSpeed>("axis.U", "max_speed_mm_s", "mm/s", kMostSpeed),
    axis_key<5, kAcceleration>("axis.U", "max_acceleration_mm_s2", "mm/s^2", kMostAcceleration),
    axis_key<5, kJerk>("axis.U", "max_jerk_mm_s3", "mm/s^3", kMostJerk),
    servo_hz_key("axis.U", "1_000, assumed", store_loop<5, kHz>),
    servo_damping_key("axis.U", store_loop<5, kDamping>),
    axis_key<6, kSpeed>("axis.V", "max_speed_mm_s", "mm/s", kMostSpeed),
    axis_key<6, kAcceleration>("axis.V", "max_acceleration_mm_s2", "mm/s^2", kMostAcceleration),
    axis_key<6, kJerk>("axis.V", "max_jerk_mm_s3", "mm/s^3", kMostJerk),
    servo_hz_key("axis.V", "1_000, assumed", store_loop<6, kHz>),
    servo_damping_key("axis.V", store_loop<6, kDamping>),
    focus_key<kSpeed>("max_speed_mm_s", "mm/s", kMostSpeed),
    focus_key<kAcceleration>("max_acceleration_mm_s2", "mm/s^2", kMostAcceleration),
    focus_key<kJerk>("max_jerk_mm_s3", "mm/s^3", kMostJerk),
    servo_hz_key("axis.W", "50, assumed", store_loop<kFocusAxis, kHz>),
    servo_damping_key("axis.W", store_loop<kFocusAxis, kDamping>),
};

}  // namespace

std::span<const Key> key_table() {
  return kTable;
}

std::span<const std::string_view> section_names() {
  return kSections;
}

std::span<const std::string_view> parent_names() {
  return kParents;
}

bool section_is_required(std::string_view section) {
  return section == "job" || section == "laser" || section == "fpga" || section == "surface" || section == "texture";
}

const Key* find_key(std::string_view section, std::string_view key) {
  return row_of(key_table(), section, key);
}

}  // namespace gravure::freeform_file

namespace gravure {

std::vector<JobKey> freeform_job_keys() {
  return job_file::documented(freeform_file::key_table());
}

}  // namespace gravure
