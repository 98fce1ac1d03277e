#include "src/key_table.hpp"

#include <algorithm>
#include <array>

#include "src/key_rows.hpp"

namespace gravure::job_file {
namespace {

constexpr std::array kSections = std::to_array<std::string_view>({"job",
                                                                  "machine",
                                                                  "laser",
                                                                  "fpga",
                                                                  "scanner",
                                                                  "rotary",
                                                                  "carriage",
                                                                  "stage",
                                                                  "image",
                                                                  "repeat",
                                                                  "limits",
                                                                  "twin.drift",
                                                                  "twin.ab_step",
                                                                  "twin.galvo_resolution",
                                                                  "twin.microvectors",
                                                                  "twin.cross_scan",
                                                                  "twin.lag",
                                                                  "twin.defocus",
                                                                  "twin.servo",
                                                                  "twin.run_out",
                                                                  "twin.thermal"});
constexpr std::array<std::string_view, 1> kParents = {"twin"};
constexpr std::array<std::string_view, 3> kModes = {"rotary", "helical", "flat"};  // as Mode counts them
constexpr std::array<std::string_view, 2> kOtherModes = {"freeform", "zones"};
constexpr std::array<std::string_view, 2> kFires = {"white", "black"};
constexpr std::array<std::string_view, 2> kLinesAlong = {"rows", "columns"};
constexpr std::array<std::string_view, 3> kOrders = {"sequence", "cycle", "hold"};

constexpr auto integer = KeyRows<Job>::integer;
constexpr auto decimal = KeyRows<Job>::decimal;
constexpr auto word = KeyRows<Job>::word;
constexpr auto other = KeyRows<Job>::other;

constexpr Key on_off(std::string_view section, std::string_view fallback, KeyRows<Job>::Store store) {
  return other(section, "enabled", Type::boolean, fallback, store);
}

constexpr std::string_view kOneOfSizes = "one of diameter_mm, circumference_mm";
constexpr std::string_view kOneOfPitches = "one of line_pitch_um, lines_per_revolution";
constexpr std::string_view kOneOfImages = "one of files, depth_map";
constexpr std::string_view kUnchecked = "not checked";
constexpr std::string_view kNoRelief = "none: relief in pulses";

// Bounds keep every figure physical and every tick count far inside 64 bits where they are multiplied one by one;
// make_plan() checks the products.
constexpr std::array kTable = {
    other("job", "title", Type::title, "\"\"", [](Job& j, const Value& v) { j.title = v.text; }),
    word("job", "mode", kModes, kRequired, [](Job& j, const Value& v) { j.mode = enum_of<Mode>(kModes, v); }),

    other("machine", "file", Type::path, "none", [](Job& j, const Value& v) { j.machine.file = v.text; }),

    integer("laser", "seed_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.laser.seed_hz = v.integer; }),
    integer("laser", "pulse_divider", "seed pulses", "1", "65_535", kRequired,
            [](Job& j, const Value& v) { j.laser.pulse_divider = v.integer; }),
    integer("laser", "max_pulse_on_demand_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.laser.max_pulse_on_demand_hz = v.integer; }),
    decimal("laser", "spot_um", "um", "0.01", "10_000", kNoRelief,
            [](Job& j, const Value& v) { j.laser.spot_um = v.number; }),
    decimal("laser", "fluence_j_cm2", "J/cm^2", kLeastAboveZero, "1_000_000", kNoRelief,
            [](Job& j, const Value& v) { j.laser.fluence_j_cm2 = v.number; }),
    decimal("laser", "threshold_j_cm2", "J/cm^2", kLeastAboveZero, "1_000_000", kNoRelief,
            [](Job& j, const Value& v) { j.laser.threshold_j_cm2 = v.number; }),
    decimal("laser", "penetration_nm", "nm", "0.001", "1_000_000", kNoRelief,
            [](Job& j, const Value& v) { j.laser.penetration_nm = v.number; }),

    integer("fpga", "clock_multiplier", "FPGA ticks per seed pulse", "1", "16", kRequired,
            [](Job& j, const Value& v) { j.fpga.clock_multiplier = v.integer; }),
    integer("fpga", "counter_bits", "bits", "8", "64", kRequired,
            [](Job& j, const Value& v) { j.fpga.counter_bits = static_cast<int>(v.integer); }),
    other("fpga", "fractional", Type::boolean, "false", [](Job& j, const Value& v) { j.fpga.fractional = v.boolean; }),
    integer("fpga", "max_prescaler", "FPGA ticks", "1", "9_223_372_036_854_775_807", "4_294_967_295",
            [](Job& j, const Value& v) { j.fpga.max_prescaler = static_cast<std::uint64_t>(v.integer); }),

    decimal("scanner", "pixel_pitch_um", "um", "0.001", "10_000", kRequired,
            [](Job& j, const Value& v) { j.scanner.pixel_pitch_um = v.number; }),
    integer("scanner", "slots_per_microvector", "pulse slots", "1", "1_000_000", "1",
            [](Job& j, const Value& v) { j.scanner.slots_per_microvector = v.integer; }),
    integer("scanner", "turn_slots", "pulse slots", "0", "10_000_000", kRequired,
            [](Job& j, const Value& v) { j.scanner.turn_slots = v.integer; }),
    integer("scanner", "max_extra_slots", "pulse slots", "0", "100_000", "0",
            [](Job& j, const Value& v) { j.scanner.max_extra_slots = v.integer; }),
    other("scanner", "bidirectional", Type::boolean, "true",
          [](Job& j, const Value& v) { j.scanner.bidirectional = v.boolean; }),
    integer("scanner", "bidirectional_offset_ticks", "FPGA ticks", "-1_000_000_000", "1_000_000_000", "0",
            [](Job& j, const Value& v) { j.scanner.bidirectional_offset_ticks = v.integer; }),
    decimal("scanner", "field_mm", "mm", "0.001", "10_000", "none: the image fits",
            [](Job& j, const Value& v) { j.scanner.field_mm = v.number; }),
    integer("scanner", "resolution_bits", "bits", "8", "26", "20",
            [](Job& j, const Value& v) { j.scanner.resolution_bits = static_cast<int>(v.integer); }),
    decimal("scanner", "lag_us", "us", "0", "1_000_000", "0",
            [](Job& j, const Value& v) { j.scanner.lag_us = v.number; }),
    other("scanner", "compensate_lag", Type::boolean, "true",
          [](Job& j, const Value& v) { j.scanner.compensate_lag = v.boolean; }),
    decimal("scanner", "max_speed_mm_s", "mm/s", kLeastAboveZero, kMostSpeed, kUnchecked,
            [](Job& j, const Value& v) { j.scanner.max_speed_mm_s = v.number; }),
    decimal("scanner", "max_acceleration_mm_s2", "mm/s^2", kLeastAboveZero, kMostAcceleration, kUnchecked,
            [](Job& j, const Value& v) { j.scanner.max_acceleration_mm_s2 = v.number; }),
    decimal("scanner", "max_jerk_mm_s3", "mm/s^3", kLeastAboveZero, kMostJerk, kUnchecked,
            [](Job& j, const Value& v) { j.scanner.max_jerk_mm_s3 = v.number; }),
    other("scanner", "cross_scan_correction", Type::boolean, "true",
          [](Job& j, const Value& v) { j.scanner.cross_scan_correction = v.boolean; }),
    decimal("scanner", "offset_deg", "deg", "-85", "85", "0",
            [](Job& j, const Value& v) { j.scanner.offset_deg = v.number; }),
    decimal("scanner", "tilt_deg_per_mm", "deg/mm", "0", "10", "0: telecentric",
            [](Job& j, const Value& v) { j.scanner.tilt_deg_per_mm = v.number; }),
    other("scanner", "field_grid", Type::path, "none: no distortion",
          [](Job& j, const Value& v) { j.scanner.field_grid = v.text; }),

    decided(decimal("rotary", "diameter_mm", "mm", "0.01", "10_000", kOneOfSizes,
                    [](Job& j, const Value& v) { j.rotary.diameter_mm = v.number; })),
    decided(decimal("rotary", "circumference_mm", "mm", "0.03", "32_000", kOneOfSizes,
                    [](Job& j, const Value& v) { j.rotary.circumference_mm = v.number; })),
    decided(decimal("rotary", "line_pitch_um", "um", "0.001", "10_000", kOneOfPitches,
                    [](Job& j, const Value& v) { j.rotary.line_pitch_um = v.number; })),
    decided(integer("rotary", "lines_per_revolution", "lines", "1", "1_000_000_000", kOneOfPitches,
                    [](Job& j, const Value& v) { j.rotary.lines_per_revolution = v.integer; })),
    integer("rotary", "encoder_lines", "lines per encoder turn", "1", "1_000_000_000", kRequired,
            [](Job& j, const Value& v) { j.rotary.encoder_lines = v.integer; }),
    integer("rotary", "interpolation_bits", "bits", "0", "32", kRequired,
            [](Job& j, const Value& v) { j.rotary.interpolation_bits = static_cast<int>(v.integer); }),
    Key{{"rotary", "gear", Type::two_integers, "turns", "1", "1_000_000", {}, Presence::optional, "[1, 1]"},
        [](Job& j, const Value& v) {
          j.rotary.gear_encoder_turns = v.items[0].integer;
          j.rotary.gear_workpiece_turns = v.items[1].integer;
        }},
    integer("rotary", "max_ab_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.rotary.max_ab_hz = v.integer; }),
    decimal("rotary", "start_angle_deg", "deg", "-360", "360", "0",
            [](Job& j, const Value& v) { j.rotary.start_angle_deg = v.number; }),
    decimal("rotary", "max_speed_deg_s", "deg/s", kLeastAboveZero, kMostSpeed, kUnchecked,
            [](Job& j, const Value& v) { j.rotary.limits.max_speed = v.number; }),
    decimal("rotary", "max_acceleration_deg_s2", "deg/s^2", kLeastAboveZero, kMostAcceleration, kUnchecked,
            [](Job& j, const Value& v) { j.rotary.limits.max_acceleration = v.number; }),
    decimal("rotary", "max_jerk_deg_s3", "deg/s^3", kLeastAboveZero, kMostJerk, kUnchecked,
            [](Job& j, const Value& v) { j.rotary.limits.max_jerk = v.number; }),

    decimal("carriage", "feed_pixels", "columns per turn", "0.001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.carriage.feed_pixels = v.number; }),
    integer("carriage", "layers", "layers", "1", "65_536", kRequired,
            [](Job& j, const Value& v) { j.carriage.layers = v.integer; }),
    decimal("carriage", "encoder_pitch_um", "um", "0.001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.carriage.encoder_pitch_um = v.number; }),
    integer("carriage", "interpolation_bits", "bits", "0", "32", kRequired,
            [](Job& j, const Value& v) { j.carriage.interpolation_bits = static_cast<int>(v.integer); }),
    integer("carriage", "max_ab_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.carriage.max_ab_hz = v.integer; }),
    decimal("carriage", "max_speed_mm_s", "mm/s", kLeastAboveZero, kMostSpeed, kUnchecked,
            [](Job& j, const Value& v) { j.carriage.limits.max_speed = v.number; }),
    decimal("carriage", "max_acceleration_mm_s2", "mm/s^2", kLeastAboveZero, kMostAcceleration, kUnchecked,
            [](Job& j, const Value& v) { j.carriage.limits.max_acceleration = v.number; }),
    decimal("carriage", "max_jerk_mm_s3", "mm/s^3", kLeastAboveZero, kMostJerk, kUnchecked,
            [](Job& j, const Value& v) { j.carriage.limits.max_jerk = v.number; }),

    integer("stage", "lines", "lines", "1", "1_000_000_000", kRequired,
            [](Job& j, const Value& v) { j.stage.lines = v.integer; }),
    decimal("stage", "line_pitch_um", "um", "0.001", "10_000", kRequired,
            [](Job& j, const Value& v) { j.stage.line_pitch_um = v.number; }),
    decimal("stage", "encoder_pitch_um", "um", "0.001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.stage.encoder_pitch_um = v.number; }),
    integer("stage", "interpolation_bits", "bits", "0", "32", kRequired,
            [](Job& j, const Value& v) { j.stage.interpolation_bits = static_cast<int>(v.integer); }),
    integer("stage", "max_ab_hz", "Hz", "1", kBiggestHz, kRequired,
            [](Job& j, const Value& v) { j.stage.max_ab_hz = v.integer; }),
    decimal("stage", "max_speed_mm_s", "mm/s", kLeastAboveZero, kMostSpeed, kUnchecked,
            [](Job& j, const Value& v) { j.stage.limits.max_speed = v.number; }),
    decimal("stage", "max_acceleration_mm_s2", "mm/s^2", kLeastAboveZero, kMostAcceleration, kUnchecked,
            [](Job& j, const Value& v) { j.stage.limits.max_acceleration = v.number; }),
    decimal("stage", "max_jerk_mm_s3", "mm/s^3", kLeastAboveZero, kMostJerk, kUnchecked,
            [](Job& j, const Value& v) { j.stage.limits.max_jerk = v.number; }),

    decided(other("image", "files", Type::paths, kOneOfImages,
                  [](Job& j, const Value& v) {
                    for (const Value& item : v.items) {
                      j.image.files.push_back(item.text);
                    }
                  })),
    decided(other("image", "depth_map", Type::path, kOneOfImages,
                  [](Job& j, const Value& v) { j.image.depth_map = v.text; })),
    decided(integer("image", "levels", "layers", "1", "65_536", "required with depth_map",
                    [](Job& j, const Value& v) { j.image.levels = v.integer; })),
    decimal("image", "depth_min", "", "-1_000_000_000_000", "1_000_000_000_000", "0",
            [](Job& j, const Value& v) { j.image.depth_min = v.number; }),
    decimal("image", "depth_max", "", "-1_000_000_000_000", "1_000_000_000_000", "1, or the largest integer sample",
            [](Job& j, const Value& v) { j.image.depth_max = v.number; }),
    integer("image", "threshold", "", "1", "65_535", "none: layers are bilevel",
            [](Job& j, const Value& v) { j.image.threshold = v.integer; }),
    word("image", "fires", kFires, kRequired,
         [](Job& j, const Value& v) { j.image.fires = enum_of<Fires>(kFires, v); }),
    word("image", "lines_along", kLinesAlong, "\"rows\"",
         [](Job& j, const Value& v) { j.image.lines_along = enum_of<LinesAlong>(kLinesAlong, v); }),
    integer("image", "revolutions", "turns", "1", "1_000_000", "one per layer",
            [](Job& j, const Value& v) { j.image.revolutions = v.integer; }),
    word("image", "order", kOrders, "\"sequence\"",
         [](Job& j, const Value& v) { j.image.order = enum_of<LayerOrder>(kOrders, v); }),
    decided(integer("image", "pixels_per_line", "pixels", "1", "1_000_000_000", "from the images",
                    [](Job& j, const Value& v) { j.image.pixels_per_line = v.integer; })),

    integer("repeat", "around", "tiles", "1", "1_000_000", "1",
            [](Job& j, const Value& v) { j.repeat.around = v.integer; }),
    integer("repeat", "along", "tiles", "1", "1_000_000", "1",
            [](Job& j, const Value& v) { j.repeat.along = v.integer; }),
    other("repeat", "mirror_around", Type::boolean, "false",
          [](Job& j, const Value& v) { j.repeat.mirror_around = v.boolean; }),
    other("repeat", "mirror_along", Type::boolean, "false",
          [](Job& j, const Value& v) { j.repeat.mirror_along = v.boolean; }),

    decimal("limits", "seam_um", "um", "0.000_001", "1_000_000", kRequired,
            [](Job& j, const Value& v) { j.limits.seam_um = v.number; }),
    decimal("limits", "landing_um", "um", "0.000_001", "1_000_000", "not judged",
            [](Job& j, const Value& v) { j.limits.landing_um = v.number; }),
    decimal("limits", "defocus_um", "um", "0.000_001", "1_000_000", "not judged",
            [](Job& j, const Value& v) { j.limits.defocus_um = v.number; }),

    on_off("twin.drift", "true", [](Job& j, const Value& v) { j.twin.drift = v.boolean; }),
    on_off("twin.ab_step", "true", [](Job& j, const Value& v) { j.twin.ab_step = v.boolean; }),
    on_off("twin.galvo_resolution", "true", [](Job& j, const Value& v) { j.twin.galvo_resolution = v.boolean; }),
    on_off("twin.microvectors", "true", [](Job& j, const Value& v) { j.twin.microvectors = v.boolean; }),
    on_off("twin.cross_scan", "true", [](Job& j, const Value& v) { j.twin.cross_scan = v.boolean; }),
    on_off("twin.lag", "true", [](Job& j, const Value& v) { j.twin.lag = v.boolean; }),
    on_off("twin.defocus", "true", [](Job& j, const Value& v) { j.twin.defocus = v.boolean; }),
    on_off("twin.servo", "false", [](Job& j, const Value& v) { j.twin.servo.enabled = v.boolean; }),
    decided(decimal("twin.servo", "bandwidth_hz", "Hz", "0.001", "1_000_000", "required with enabled = true",
                    [](Job& j, const Value& v) { j.twin.servo.bandwidth_hz = v.number; })),
    decimal("twin.servo", "damping", "", "0.01", "10", "0.7",
            [](Job& j, const Value& v) { j.twin.servo.damping = v.number; }),
    on_off("twin.run_out", "false", [](Job& j, const Value& v) { j.twin.run_out.enabled = v.boolean; }),
    decimal("twin.run_out", "eccentricity_um", "um", "0", "10_000", "0",
            [](Job& j, const Value& v) { j.twin.run_out.eccentricity_um = v.number; }),
    decimal("twin.run_out", "angle_deg", "deg", "-360", "360", "0",
            [](Job& j, const Value& v) { j.twin.run_out.angle_deg = v.number; }),
    on_off("twin.thermal", "false", [](Job& j, const Value& v) { j.twin.thermal.enabled = v.boolean; }),
    decimal("twin.thermal", "temperature_change_k", "K", "-1_000", "1_000", "0",
            [](Job& j, const Value& v) { j.twin.thermal.temperature_change_k = v.number; }),
    decimal("twin.thermal", "expansion_um_per_m_k", "um/(m K)", "0", "1_000", "0",
            [](Job& j, const Value& v) { j.twin.thermal.expansion_um_per_m_k = v.number; }),
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

bool section_is_optional(std::string_view section) {
  return section == "machine" || section == "repeat" || section.substr(0, 5) == "twin.";
}

std::span<const std::string_view> other_modes() {
  return kOtherModes;
}

std::optional<Mode> mode_of(std::string_view name) {
  const auto found = std::find(kModes.begin(), kModes.end(), name);
  return found == kModes.end() ? std::nullopt : std::optional(static_cast<Mode>(found - kModes.begin()));
}

bool section_is_of(std::string_view section, Mode mode) {
  if (section == "carriage") {
    return mode == Mode::helical;
  }
  return section == "stage" ? mode == Mode::flat : section != "rotary" || mode != Mode::flat;
}

const Key* find_key(std::string_view section, std::string_view key) {
  return row_of(key_table(), section, key);
}

}  // namespace gravure::job_file
