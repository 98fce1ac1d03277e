#include "src/zones_keys.hpp"

#include <array>

#include "src/key_rows.hpp"

namespace gravure::zones_file {
namespace {

constexpr std::array kSections = std::to_array<std::string_view>(
    {"job", "contours", "zones", "beam", "laser", "fpga", "marking", "machine", "limits"});
constexpr std::array<std::string_view, 1> kModes = {"zones"};
constexpr std::array<std::string_view, 2> kMethods = {"cover", "kmeans"};

constexpr std::string_view kMost = "1_000_000";

constexpr auto integer = KeyRows<ZonesJob>::integer;
constexpr auto decimal = KeyRows<ZonesJob>::decimal;
constexpr auto word = KeyRows<ZonesJob>::word;
constexpr auto other = KeyRows<ZonesJob>::other;

/// Every job that has the section has the key.
constexpr Key always(Key key) {
  key.presence = Presence::required;
  return key;
}

/// The section is there as soon as one of its keys is.
ZonesBeam& beam_of(ZonesJob& job) {
  return job.beam ? *job.beam : job.beam.emplace();
}

constexpr std::array kTable = {
    other("job", "title", Type::title, "\"\"", [](ZonesJob& j, const Value& v) { j.job.title = v.text; }),
    word("job", "mode", kModes, kRequired, [](ZonesJob& j, const Value&) { j.job.mode = Mode::zones; }),

    other("contours", "file", Type::path, kRequired, [](ZonesJob& j, const Value& v) { j.contours = v.text; }),
    other("contours", "transform", Type::path, "contours lie where they are",
          [](ZonesJob& j, const Value& v) { j.transform = v.text; }),

    word("zones", "method", kMethods, "\"cover\"",
         [](ZonesJob& j, const Value& v) { j.by_kmeans = v.text == "kmeans"; }),
    decimal("zones", "max_incidence_deg", "deg", "0.001", "89", kRequired,
            [](ZonesJob& j, const Value& v) { j.max_incidence_deg = v.number; }),
    decimal("zones", "layer_mm", "mm", "0.0001", kMost, "by [beam] fluence_share",
            [](ZonesJob& j, const Value& v) { j.layer_mm = v.number; }),
    integer("zones", "k", "", "1", kMost, "the fewest that meet the limits",
            [](ZonesJob& j, const Value& v) { j.clusters = static_cast<std::size_t>(v.integer); }),
    other("zones", "normalised", Type::boolean, "true", [](ZonesJob& j, const Value& v) { j.normalised = v.boolean; }),
    integer("zones", "seed", "", "0", "9_223_372_036_854_775_807", "1",
            [](ZonesJob& j, const Value& v) { j.seed = static_cast<std::uint64_t>(v.integer); }),

    always(decimal("beam", "wavelength_um", "um", "0.01", "100", "required in [beam]",
                   [](ZonesJob& j, const Value& v) { beam_of(j).wavelength_um = v.number; })),
    decimal("beam", "m_squared", "", "1", "1000", "1",
            [](ZonesJob& j, const Value& v) { beam_of(j).m_squared = v.number; }),
    always(decimal("beam", "diameter_mm", "mm", "0.001", "1000", "required in [beam]",
                   [](ZonesJob& j, const Value& v) { beam_of(j).diameter_mm = v.number; })),
    always(decimal("beam", "focal_length_mm", "mm", "0.1", "100_000", "required in [beam]",
                   [](ZonesJob& j, const Value& v) { beam_of(j).focal_length_mm = v.number; })),
    decimal("beam", "fluence_share", "", "0.01", "0.9999", "[zones] layer_mm",
            [](ZonesJob& j, const Value& v) { beam_of(j).fluence_share = v.number; }),
    decimal("beam", "average_power_w", "W", kLeastAboveZero, kMost, "no line widths",
            [](ZonesJob& j, const Value& v) { beam_of(j).average_power_w = v.number; }),
    decimal("beam", "threshold_j_cm2", "J/cm^2", kLeastAboveZero, kMost, "no line widths",
            [](ZonesJob& j, const Value& v) { beam_of(j).threshold_j_cm2 = v.number; }),

    integer("laser", "seed_hz", "Hz", "1", "1_000_000_000_000", kRequired,
            [](ZonesJob& j, const Value& v) { j.job.laser.seed_hz = v.integer; }),
    integer("laser", "pulse_divider", "", "1", "65_535", kRequired,
            [](ZonesJob& j, const Value& v) { j.job.laser.pulse_divider = v.integer; }),
    integer("fpga", "clock_multiplier", "", "1", "16", "2",
            [](ZonesJob& j, const Value& v) { j.job.fpga.clock_multiplier = v.integer; }),

    decimal("marking", "pulse_pitch_um", "um", kLeastAboveZero, kMost, kRequired,
            [](ZonesJob& j, const Value& v) { j.pulse_pitch_um = v.number; }),
    decimal("marking", "mark_speed_mm_s", "mm/s", kLeastAboveZero, kMost, kRequired,
            [](ZonesJob& j, const Value& v) { j.mark_speed_mm_s = v.number; }),
    decimal("marking", "jump_speed_mm_s", "mm/s", kLeastAboveZero, kMost, "as fast as the head can",
            [](ZonesJob& j, const Value& v) { j.jump_speed_mm_s = v.number; }),
    decimal("marking", "servo_us", "us", "1", "100_000", "50",
            [](ZonesJob& j, const Value& v) { j.servo_us = v.number; }),

    other("machine", "file", Type::path, "the example of `gravure zones plan`",
          [](ZonesJob& j, const Value& v) { j.machine = v.text; }),
    decimal("machine", "field_mm", "mm", "0.001", "10_000", "the machine's",
            [](ZonesJob& j, const Value& v) { j.field_mm = v.number; }),

    decimal("limits", "landing_um", "um", kLeastAboveZero, kMost, "not judged",
            [](ZonesJob& j, const Value& v) { j.max_landing_um = v.number; }),
};

}  // namespace

std::span<const Key> key_table() {
  return kTable;
}

std::span<const std::string_view> section_names() {
  return kSections;
}

bool section_is_required(std::string_view section) {
  return section != "beam" && section != "fpga" && section != "machine" && section != "limits";
}

}  // namespace gravure::zones_file

namespace gravure {

std::vector<JobKey> zones_job_keys() {
  return job_file::documented(zones_file::key_table());
}

}  // namespace gravure
