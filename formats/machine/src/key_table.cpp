#include "src/key_table.hpp"

#include <array>

#include "gravure/formats/machine_file.hpp"

namespace gravure {
namespace machine_file {
namespace {

constexpr std::array<std::string_view, 2> kKinds = {"prismatic", "revolute"};
constexpr std::array<std::string_view, 2> kSides = {"workpiece", "tool"};
constexpr std::array<std::string_view, 2> kLenses = {"telecentric", "f_theta"};
constexpr std::string_view kRequired = "required";
constexpr std::string_view kNone = "not checked";
constexpr std::string_view kZero = "[0, 0, 0]";

constexpr KeySpec number(Owner owner, std::string_view key, std::string_view unit, std::string_view low,
                         std::string_view high, std::string_view fallback) {
  return {owner, key, Type::decimal, unit, low, high, {}, fallback};
}

constexpr KeySpec vector(Owner owner, std::string_view key, std::string_view unit, std::string_view fallback) {
  return {owner, key, Type::vector, unit, "-1_000_000", "1_000_000", {}, fallback};
}

constexpr KeySpec word(Owner owner, std::string_view key, std::span<const std::string_view> words) {
  return {owner, key, Type::word, "", "", "", words, kRequired};
}

constexpr std::array kTable = {
    KeySpec{Owner::machine, "title", Type::text, "", "", "", {}, "\"\""},
    KeySpec{Owner::machine, "joints", Type::names, "", "", "", {}, kRequired},

    word(Owner::joint, "kind", kKinds),
    word(Owner::joint, "carries", kSides),
    vector(Owner::joint, "axis", "", kRequired),
    vector(Owner::joint, "origin_mm", "mm", kZero),
    number(Owner::prismatic, "least_mm", "mm", "-1_000_000", "1_000_000", kNone),
    number(Owner::prismatic, "most_mm", "mm", "-1_000_000", "1_000_000", kNone),
    number(Owner::prismatic, "max_speed_mm_s", "mm/s", "0.000_001", "1e9", kNone),
    number(Owner::prismatic, "max_acceleration_mm_s2", "mm/s^2", "0.000_001", "1e12", kNone),
    number(Owner::prismatic, "max_jerk_mm_s3", "mm/s^3", "0.000_001", "1e18", kNone),
    number(Owner::revolute, "least_deg", "deg", "-1e9", "1e9", kNone),
    number(Owner::revolute, "most_deg", "deg", "-1e9", "1e9", kNone),
    number(Owner::revolute, "max_speed_deg_s", "deg/s", "0.000_001", "1e9", kNone),
    number(Owner::revolute, "max_acceleration_deg_s2", "deg/s^2", "0.000_001", "1e12", kNone),
    number(Owner::revolute, "max_jerk_deg_s3", "deg/s^3", "0.000_001", "1e18", kNone),

    word(Owner::head, "lens", kLenses),
    number(Owner::head, "tilt_deg_per_mm", "deg/mm", "0", "10", "required with f_theta"),
    number(Owner::head, "field_mm", "mm", "0.001", "10_000", kRequired),
    KeySpec{Owner::head, "resolution_bits", Type::integer, "bits", "8", "26", {}, kRequired},
    number(Owner::head, "lag_us", "us", "0", "1_000_000", "0"),
    number(Owner::head, "max_speed_mm_s", "mm/s", "0.000_001", "1e9", kNone),
    number(Owner::head, "max_acceleration_mm_s2", "mm/s^2", "0.000_001", "1e12", kNone),
    number(Owner::head, "max_jerk_mm_s3", "mm/s^3", "0.000_001", "1e18", kNone),
    vector(Owner::head, "origin_mm", "mm", kZero),
    vector(Owner::head, "u_axis", "", "[1, 0, 0]"),
    vector(Owner::head, "v_axis", "", "[0, 1, 0]"),
    vector(Owner::head, "beam_axis", "", "[0, 0, 1]"),
};

std::string section_of(Owner owner) {
  return owner == Owner::machine ? "machine" : owner == Owner::head ? "head" : "joint";
}

std::string type_name(Type type) {
  switch (type) {
    case Type::integer:
      return "integer";
    case Type::decimal:
      return "decimal";
    case Type::vector:
      return "three decimals";
    case Type::names:
      return "list of strings";
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

bool has_key(const KeySpec& spec, Owner kind) {
  const bool is_joint = kind == Owner::joint || kind == Owner::prismatic || kind == Owner::revolute;
  const bool is_of_any_joint = spec.owner == Owner::joint;
  const bool is_open = kind == Owner::joint && (spec.owner == Owner::prismatic || spec.owner == Owner::revolute);
  return spec.owner == kind || (is_joint && (is_of_any_joint || is_open));
}

std::string range_text(const KeySpec& spec) {
  switch (spec.type) {
    case Type::integer:
    case Type::decimal:
    case Type::vector:
      return std::string(spec.low) + " to " + std::string(spec.high);
    case Type::text:
      return "at most " + std::to_string(kMaxTextBytes) + " bytes, no control characters";
    case Type::names:
      return "up to " + std::to_string(kMaxJoints) + " different names of letters, digits and _, 1 to " +
             std::to_string(kMaxNameBytes) + " bytes";
    case Type::word:
      break;
  }
  return "\"" + std::string(spec.words[0]) + "\" or \"" + std::string(spec.words[1]) + "\"";
}

std::string expectation(const KeySpec& spec) {
  const std::string unit = spec.unit.empty() ? "" : " " + std::string(spec.unit);
  switch (spec.type) {
    case Type::integer:
      return "an integer from " + range_text(spec) + unit;
    case Type::decimal:
      return "a number from " + range_text(spec) + unit;
    case Type::vector:
      return "[x, y, z], three numbers from " + range_text(spec) + unit;
    case Type::text:
      return "a string of " + range_text(spec);
    case Type::names:
      return "a list such as [\"X\", \"C\"]: " + range_text(spec);
    case Type::word:
      break;
  }
  return range_text(spec);
}

}  // namespace machine_file

std::vector<MachineKey> machine_keys() {
  std::vector<MachineKey> keys;
  for (const machine_file::KeySpec& spec : machine_file::key_table()) {
    keys.push_back({machine_file::section_of(spec.owner), std::string(spec.key), machine_file::type_name(spec.type),
                    std::string(spec.unit), machine_file::range_text(spec), std::string(spec.fallback)});
  }
  return keys;
}

}  // namespace gravure
