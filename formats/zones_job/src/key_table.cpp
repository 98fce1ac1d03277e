#include "src/key_table.hpp"

#include <algorithm>
#include <array>

#include "gravure/formats/zones_job.hpp"

namespace gravure {
namespace zones_job_file {
namespace {

constexpr std::array<std::string_view, 1> kModes = {"zones"};
constexpr std::array<std::string_view, 2> kMethods = {"cover", "kmeans"};
constexpr std::string_view kRequired = "required";

constexpr KeySpec number(std::string_view section, std::string_view key, std::string_view unit, std::string_view low,
                         std::string_view high, std::string_view fallback) {
  return {section, key, Type::decimal, unit, low, high, {}, fallback};
}

constexpr KeySpec integer(std::string_view section, std::string_view key, std::string_view unit, std::string_view low,
                          std::string_view high, std::string_view fallback) {
  return {section, key, Type::integer, unit, low, high, {}, fallback};
}

constexpr KeySpec text(std::string_view section, std::string_view key, std::string_view fallback) {
  return {section, key, Type::text, "", "", "", {}, fallback};
}

constexpr std::array kTable = {
    text("job", "title", "\"\""),
    KeySpec{"job", "mode", Type::word, "", "", "", kModes, kRequired},

    text("contours", "file", kRequired),
    text("contours", "transform", "contours lie where they are"),

    KeySpec{"zones", "method", Type::word, "", "", "", kMethods, "\"cover\""},
    number("zones", "max_incidence_deg", "deg", "0.001", "89", kRequired),
    number("zones", "layer_mm", "mm", "0.0001", "1_000_000", "by [beam] fluence_share"),
    integer("zones", "k", "", "1", "1_000_000", "the fewest that meet the limits"),
    KeySpec{"zones", "normalised", Type::boolean, "", "", "", {}, "true"},
    integer("zones", "seed", "", "0", "9_223_372_036_854_775_807", "1"),

    number("beam", "wavelength_um", "um", "0.01", "100", "required in [beam]"),
    number("beam", "m_squared", "", "1", "1000", "1"),
    number("beam", "diameter_mm", "mm", "0.001", "1000", "required in [beam]"),
    number("beam", "focal_length_mm", "mm", "0.1", "100_000", "required in [beam]"),
    number("beam", "fluence_share", "", "0.01", "0.9999", "[zones] layer_mm"),
    number("beam", "average_power_w", "W", "0.000_001", "1_000_000", "no line widths"),
    number("beam", "threshold_j_cm2", "J/cm^2", "0.000_001", "1_000_000", "no line widths"),

    integer("laser", "seed_hz", "Hz", "1", "1_000_000_000_000", kRequired),
    integer("laser", "pulse_divider", "", "1", "65_535", kRequired),
    integer("fpga", "clock_multiplier", "", "1", "16", "2"),

    number("marking", "pulse_pitch_um", "um", "0.000_001", "1_000_000", kRequired),
    number("marking", "mark_speed_mm_s", "mm/s", "0.000_001", "1_000_000", kRequired),
    number("marking", "jump_speed_mm_s", "mm/s", "0.000_001", "1_000_000", "as fast as the head can"),
    number("marking", "servo_us", "us", "1", "100_000", "50"),

    text("machine", "file", "the example of `gravure zones plan`"),
    number("machine", "field_mm", "mm", "0.001", "10_000", "the machine's"),

    number("limits", "landing_um", "um", "0.000_001", "1_000_000", "not judged"),
};

std::string type_name(Type type) {
  switch (type) {
    case Type::integer:
      return "integer";
    case Type::decimal:
      return "decimal";
    case Type::boolean:
      return "boolean";
    case Type::text:
    case Type::word:
      break;
  }
  return "string";
}

}  // namespace

std::span<const KeySpec> key_table() {
  return kTable;
}

const KeySpec* find_key(std::string_view section, std::string_view key) {
  const auto found = std::find_if(kTable.begin(), kTable.end(),
                                  [&](const KeySpec& spec) { return spec.section == section && spec.key == key; });
  return found == kTable.end() ? nullptr : &*found;
}

bool is_section(std::string_view name) {
  return std::any_of(kTable.begin(), kTable.end(), [&](const KeySpec& spec) { return spec.section == name; });
}

std::string range_text(const KeySpec& spec) {
  switch (spec.type) {
    case Type::integer:
    case Type::decimal:
      return std::string(spec.low) + " to " + std::string(spec.high);
    case Type::boolean:
      return "true or false";
    case Type::text:
      return "1 to " + std::to_string(kMaxTextBytes) + " bytes, no control characters";
    case Type::word:
      break;
  }
  std::string words;
  for (const std::string_view word : spec.words) {
    words += (words.empty() ? "\"" : " or \"") + std::string(word) + "\"";
  }
  return words;
}

std::string expectation(const KeySpec& spec) {
  const std::string unit = spec.unit.empty() ? "" : " " + std::string(spec.unit);
  switch (spec.type) {
    case Type::integer:
      return "an integer from " + range_text(spec) + unit;
    case Type::decimal:
      return "a number from " + range_text(spec) + unit;
    case Type::text:
      return "a string of " + range_text(spec);
    case Type::boolean:
    case Type::word:
      break;
  }
  return range_text(spec);
}

}  // namespace zones_job_file

std::vector<ZonesJobKey> zones_job_keys() {
  std::vector<ZonesJobKey> keys;
  for (const zones_job_file::KeySpec& spec : zones_job_file::key_table()) {
    keys.push_back({std::string(spec.section), std::string(spec.key), zones_job_file::type_name(spec.type),
                    std::string(spec.unit), zones_job_file::range_text(spec), std::string(spec.fallback)});
  }
  return keys;
}

}  // namespace gravure
