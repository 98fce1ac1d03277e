#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/machine_file.hpp"
#include "gravure/formats/toml/edit_distance.hpp"
#include "gravure/formats/toml/violations.hpp"
#include "src/key_table.hpp"

namespace gravure {
namespace machine_file {
namespace {

using kinematics::Joint;
using kinematics::JointKind;
using kinematics::Machine;
using kinematics::Vector3;

constexpr double kRadians = 3.14159265358979323846 / 180;

std::string bracketed(std::string_view section) {
  return "[" + one_line(section) + "]";
}

bool is_number(const Value& value) {
  return (value.kind == Kind::integer || value.kind == Kind::decimal) && value.is_readable;
}

bool is_name(const std::string& text) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.size() <= kMaxNameBytes && std::all_of(text.begin(), text.end(), is_allowed) &&
         text != "machine" && text != "head";
}

class Reader {
 public:
  explicit Reader(const Document& document) : document_(document) {}

  Machine read() {
    read_machine_section();
    for (const Section& section : document_.sections) {
      check_section(section);
    }
    for (const std::string& name : names_) {
      if (const Section* section = needed(name, "joint of [machine] joints")) {
        machine_.joints.push_back(joint_of(*section));
      }
    }
    if (const Section* section = needed("head", "scan head")) {
      read_head(*section);
    }
    return std::move(machine_);
  }

  const Violations& violations() const { return violations_; }

 private:
  // --- what stands where ---

  const Section* needed(const std::string& name, const std::string& what) {
    const Section* section = document_.find(name);
    if (section == nullptr) {
      violations_.add(document_.end, "section " + bracketed(name) + " is missing: it describes the " + what);
    }
    return section != nullptr && section->is_table ? section : nullptr;
  }

  void read_machine_section() {
    const Section* section = needed("machine", "chain of joints: give title and joints");
    if (section == nullptr) {
      return;
    }
    if (const Value* title = value_of(*section, Owner::machine, "title")) {
      machine_.title = title->text;
    }
    if (const Value* joints = value_of(*section, Owner::machine, "joints")) {
      for (const Value& item : joints->items) {
        names_.push_back(item.text);
      }
    }
  }

  void check_section(const Section& section) {
    const bool is_joint = std::find(names_.begin(), names_.end(), section.name) != names_.end();
    if (!section.is_table) {
      violations_.add(section.at, one_line(section.name) + " = " + section.value.shown +
                                      ": stands outside every section; a machine file has [machine], [head] and a "
                                      "section for each joint");
    } else if (section.name == "machine") {
      check_keys(section, Owner::machine);
    } else if (section.name == "head") {
      check_keys(section, Owner::head);
    } else if (is_joint) {
      check_keys(section, kind_of(section));
    } else {
      violations_.add(section.at,
                      bracketed(section.name) + ": not one of [machine] joints" + section_advice(section.name).text);
    }
  }

  Suggestion section_advice(const std::string& wrong) const {
    std::vector<Candidate> candidates = {{"machine", "[machine]"}, {"head", "[head]"}};
    for (const std::string& name : names_) {
      candidates.push_back({name, bracketed(name)});
    }
    return violations_.is_full() ? Suggestion() : suggest(wrong, candidates);
  }

  /// Keys that the section may not have; what the others hold is checked where it is read.
  void check_keys(const Section& section, Owner owner) {
    for (const Entry& entry : section.entries) {
      const auto is_it = [&entry](const KeySpec& spec) { return spec.key == entry.key; };
      const auto known = std::find_if(key_table().begin(), key_table().end(),
                                      [&](const KeySpec& spec) { return is_it(spec) && has_key(spec, owner); });
      if (known != key_table().end() || violations_.is_full()) {
        continue;
      }
      const std::string what = bracketed(section.name) + " " + one_line(entry.key) + " = " + entry.value.shown;
      std::vector<Candidate> candidates;
      for (const KeySpec& spec : key_table()) {
        if (has_key(spec, owner)) {
          candidates.push_back({spec.key, std::string(spec.key)});
        }
      }
      violations_.add(entry.at, what + ": unknown key" + suggest(entry.key, candidates).text);
    }
  }

  Owner kind_of(const Section& section) const {
    const Entry* kind = section.find("kind");
    const std::string text = kind != nullptr ? kind->value.text : "";
    return text == "prismatic" ? Owner::prismatic : text == "revolute" ? Owner::revolute : Owner::joint;
  }

  // --- single values ---

  /// The key's value where it is there and right; every flaw is told once, for each key is read once.
  const Value* value_of(const Section& section, Owner owner, std::string_view key) {
    const auto spec = std::find_if(key_table().begin(), key_table().end(), [&](const KeySpec& candidate) {
      return candidate.key == key && has_key(candidate, owner);
    });
    const Entry* entry = section.find(key);
    if (entry == nullptr) {
      if (spec->is_required()) {
        violations_.add(section.at,
                        bracketed(section.name) + " " + std::string(key) + " is missing: give " + expectation(*spec));
      }
      return nullptr;
    }
    return is_right(section, *spec, entry->value) ? &entry->value : nullptr;
  }

  bool is_right(const Section& section, const KeySpec& spec, const Value& value) {
    const std::string text =
        bracketed(section.name) + " " + std::string(spec.key) + " = " + value.shown + ": must be " + expectation(spec);
    if (!has_type(spec, value)) {
      violations_.add(value.at, text);
      return false;
    }
    const bool is_vector = spec.type == Type::vector;
    const bool is_inside = is_vector ? std::all_of(value.items.begin(), value.items.end(),
                                                   [&](const Value& v) { return in_range(spec, v); })
                                     : in_range(spec, value);
    if (!is_inside) {
      violations_.add_range(value.at, text);
    }
    return is_inside;
  }

  static bool in_range(const KeySpec& spec, const Value& value) {
    return spec.low.empty() ||
           (value.number >= parse_decimal(spec.low).value() && value.number <= parse_decimal(spec.high).value());
  }

  static bool has_type(const KeySpec& spec, const Value& value) {
    switch (spec.type) {
      case Type::integer:
        return value.kind == Kind::integer;
      case Type::decimal:
        return is_number(value);
      case Type::vector:
        return value.kind == Kind::array && value.items.size() == 3 &&
               std::all_of(value.items.begin(), value.items.end(), is_number);
      case Type::text:
        return value.kind == Kind::text && value.text.size() <= kMaxTextBytes &&
               std::none_of(value.text.begin(), value.text.end(),
                            [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; });
      case Type::names:
        return is_list_of_names(value);
      case Type::word:
        break;
    }
    return value.kind == Kind::text && std::find(spec.words.begin(), spec.words.end(), value.text) != spec.words.end();
  }

  static bool is_list_of_names(const Value& value) {
    std::set<std::string> names;
    return value.kind == Kind::array && value.items.size() <= kMaxJoints &&
           std::all_of(value.items.begin(), value.items.end(), [&names](const Value& item) {
             return item.kind == Kind::text && is_name(item.text) && names.insert(item.text).second;
           });
  }

  std::optional<double> number_of(const Section& section, Owner owner, std::string_view key, double factor = 1) {
    const Value* value = value_of(section, owner, key);
    return value != nullptr ? std::optional(to_double(value->number) * factor) : std::nullopt;
  }

  Vector3 vector_of(const Section& section, Owner owner, std::string_view key, const Vector3& fallback) {
    const Value* value = value_of(section, owner, key);
    return value == nullptr ? fallback
                            : Vector3(to_double(value->items[0].number), to_double(value->items[1].number),
                                      to_double(value->items[2].number));
  }

  /// Of any length above 0; made 1.
  Vector3 direction_of(const Section& section, Owner owner, std::string_view key, const Vector3& fallback) {
    const Vector3 vector = vector_of(section, owner, key, fallback);
    if (vector.cwiseAbs().maxCoeff() > 0) {
      return vector.stableNormalized();
    }
    violations_.add(section.find(key)->value.at,
                    bracketed(section.name) + " " + std::string(key) + " = [0, 0, 0]: has no direction");
    return fallback;
  }

  // --- joints and head ---

  Joint joint_of(const Section& section) {
    Joint joint;
    joint.name = section.name;
    const Owner owner = kind_of(section);
    value_of(section, owner, "kind");
    joint.kind = owner == Owner::revolute ? JointKind::revolute : JointKind::prismatic;
    if (const Value* side = value_of(section, owner, "carries")) {
      joint.side = side->text == "tool" ? kinematics::Side::tool : kinematics::Side::workpiece;
    }
    joint.axis = direction_of(section, owner, "axis", Vector3::UnitX());
    joint.origin_mm = vector_of(section, owner, "origin_mm", Vector3::Zero());
    if (owner == Owner::revolute) {
      joint.limits = {number_of(section, owner, "least_deg", kRadians), number_of(section, owner, "most_deg", kRadians),
                      number_of(section, owner, "max_speed_deg_s", kRadians),
                      number_of(section, owner, "max_acceleration_deg_s2", kRadians),
                      number_of(section, owner, "max_jerk_deg_s3", kRadians)};
    } else if (owner == Owner::prismatic) {
      joint.limits = {number_of(section, owner, "least_mm"), number_of(section, owner, "most_mm"),
                      number_of(section, owner, "max_speed_mm_s"), number_of(section, owner, "max_acceleration_mm_s2"),
                      number_of(section, owner, "max_jerk_mm_s3")};
    }
    if (joint.limits.least && joint.limits.most && *joint.limits.least > *joint.limits.most) {
      violations_.add(section.at, bracketed(section.name) + ": its least position is beyond its most: swap them");
    }
    return joint;
  }

  void read_head(const Section& section) {
    kinematics::ScanHead& head = machine_.head;
    const Value* lens = value_of(section, Owner::head, "lens");
    const std::optional<double> tilt = number_of(section, Owner::head, "tilt_deg_per_mm", kRadians);
    if (lens != nullptr && lens->text == "f_theta") {
      head.lens = kinematics::Lens::f_theta;
      head.tilt_rad_per_mm = tilt.value_or(0);
      if (section.find("tilt_deg_per_mm") == nullptr) {
        violations_.add(section.at, "[head] tilt_deg_per_mm is missing: an f_theta lens needs it");
      }
    } else if (lens != nullptr && section.find("tilt_deg_per_mm") != nullptr) {
      violations_.add(section.find("tilt_deg_per_mm")->at,
                      "[head] tilt_deg_per_mm: a telecentric lens has none; take it out, or set lens = \"f_theta\"");
    }
    head.field_mm = number_of(section, Owner::head, "field_mm").value_or(1);
    if (const Value* bits = value_of(section, Owner::head, "resolution_bits")) {
      head.resolution_bits = static_cast<int>(bits->integer);
    }
    if (const Value* lag = value_of(section, Owner::head, "lag_us")) {
      head.lag_us = lag->number;
    }
    head.max_speed_mm_s = number_of(section, Owner::head, "max_speed_mm_s");
    head.max_acceleration_mm_s2 = number_of(section, Owner::head, "max_acceleration_mm_s2");
    head.max_jerk_mm_s3 = number_of(section, Owner::head, "max_jerk_mm_s3");
    head.origin_mm = vector_of(section, Owner::head, "origin_mm", Vector3::Zero());
    head.u_axis = direction_of(section, Owner::head, "u_axis", Vector3::UnitX());
    head.v_axis = direction_of(section, Owner::head, "v_axis", Vector3::UnitY());
    head.beam_axis = direction_of(section, Owner::head, "beam_axis", Vector3::UnitZ());
  }

  const Document& document_;
  Machine machine_;
  std::vector<std::string> names_;
  Violations violations_;
};

std::map<std::string, Rational, std::less<>> numbers_of(const Document& document) {
  std::map<std::string, Rational, std::less<>> numbers;
  for (const Section& section : document.sections) {
    for (const Entry& entry : section.entries) {
      if (is_number(entry.value)) {
        numbers.emplace(section.name + "." + entry.key, entry.value.number);
      }
    }
  }
  return numbers;
}

}  // namespace
}  // namespace machine_file

Result<MachineFile> parse_machine_file(std::string_view text, const std::string& path) {
  using namespace machine_file;
  GRAVURE_TRY(const Document document, read_document(text, path, "a machine file", kMaxMachineBytes));
  Reader reader(document);
  kinematics::Machine machine = reader.read();
  if (!reader.violations().empty()) {
    return reader.violations().to_error(path);
  }
  // What is left to be wrong is how the values of the head go together.
  if (const auto checked = kinematics::check_machine(machine); !checked) {
    return Error{checked.error().code, place(path, document.find("head")->at) + checked.error().message};
  }
  return MachineFile{std::move(machine), numbers_of(document)};
}

Result<kinematics::Machine> parse_machine(std::string_view text, const std::string& path) {
  GRAVURE_TRY(MachineFile file, parse_machine_file(text, path));
  return std::move(file.machine);
}

Result<MachineFile> read_machine_file(const std::string& path) {
  GRAVURE_TRY(const std::string text, read_file(path, kMaxMachineBytes));
  return parse_machine_file(text, path);
}

Result<kinematics::Machine> read_machine(const std::string& path) {
  GRAVURE_TRY(MachineFile file, read_machine_file(path));
  return std::move(file.machine);
}

}  // namespace gravure
