#include <algorithm>
#include <vector>

#include "src/freeform_keys.hpp"
#include "src/value_check.hpp"

namespace gravure::freeform_file {
namespace {

std::string named(const Section& section, const Entry& entry) {
  return bracketed(section.name) + " " + one_line(entry.key) + " = " + entry.value.shown;
}

/// A key that has a meaning only with some of the kinds of its section.
struct Belonging {
  std::string_view key;
  std::string_view kinds;  ///< "path or svg"
  bool required = false;   ///< with the first of the kinds
};

constexpr Belonging kOfSurfaces[] = {
    {"pixel_um", "height_field", true}, {"pixel_y_um", "height_field"}, {"height_mm", "height_field"}};
constexpr Belonging kOfTextures[] = {{"size_mm", "hilbert_order"}, {"step_um", "path, svg or bitmap"},
                                     {"tolerance_um", "svg"},      {"line_pitch_um", "bitmap"},
                                     {"run_out_um", "bitmap"},     {"fires", "bitmap", true},
                                     {"threshold", "bitmap"}};

/// The one of `kinds` that the section gives, told where there is none or more than one; null then.
const Entry* the_one(const Section& section, std::span<const std::string_view> kinds, Violations& violations) {
  std::string all;
  for (const std::string_view kind : kinds) {
    all += (all.empty() ? "" : kind == kinds.back() ? " or " : ", ") + std::string(kind);
  }
  std::vector<const Entry*> given;
  for (const std::string_view kind : kinds) {
    if (const Entry* entry = section.find(kind)) {
      given.push_back(entry);
    }
  }
  std::sort(given.begin(), given.end(), [](const Entry* a, const Entry* b) { return a->at < b->at; });
  if (given.empty()) {
    violations.add(section.at, bracketed(section.name) + " " + all + " is missing: give one of them");
  }
  for (std::size_t i = 1; i < given.size(); ++i) {
    violations.add(given[i]->at, named(section, *given[i]) + ": contradicts " + one_line(given[0]->key) + " = " +
                                     given[0]->value.shown + " (line " + std::to_string(given[0]->at.line) +
                                     "); give one of " + all);
  }
  return given.size() == 1 ? given[0] : nullptr;
}

/// Is `kind` one of the names in "path, svg or bitmap"?
bool is_among(std::string_view kinds, std::string_view kind) {
  for (std::size_t at = 0; at < kinds.size();) {
    const std::size_t end = std::min(kinds.find_first_of(", ", at), kinds.size());
    if (kinds.substr(at, end - at) == kind) {
      return true;
    }
    at = end + 1;
  }
  return false;
}

void check_belongings(const Section& section, const Entry& kind, std::span<const Belonging> belongings,
                      Violations& violations) {
  for (const Belonging& each : belongings) {
    const Entry* entry = section.find(each.key);
    const bool belongs = is_among(each.kinds, kind.key);
    if (entry != nullptr && !belongs) {
      violations.add(entry->at,
                     named(section, *entry) + ": has a meaning only with " + std::string(each.kinds) + "; take it out");
    } else if (entry == nullptr && belongs && each.required) {
      violations.add(section.at, bracketed(section.name) + " " + std::string(each.key) +
                                     " is missing: " + std::string(kind.key) + " needs " +
                                     expectation(*find_key(section.name, each.key)));
    }
  }
}

const Section* table_of(const Document& document, std::string_view name) {
  const Section* section = document.find(name);
  return section != nullptr && section->is_table ? section : nullptr;
}

/// W has no limits but its own, and they are nothing without it.
void check_focus_axis(const Document& document, Violations& violations) {
  const Section* split = table_of(document, "split");
  const Entry* wanted = split != nullptr ? split->find("focus_axis") : nullptr;
  const Section* axis = table_of(document, "axis.W");
  if (wanted != nullptr && wanted->value.boolean) {
    for (const char* key : {"max_speed_mm_s", "max_acceleration_mm_s2", "max_jerk_mm_s3"}) {
      if (axis == nullptr || axis->find(key) == nullptr) {
        violations.add(
            axis != nullptr ? axis->at : wanted->at,
            "[axis.W] " + std::string(key) + " is missing: focus_axis needs " + expectation(*find_key("axis.W", key)));
      }
    }
    return;
  }
  if (axis != nullptr) {
    violations.add(axis->at, "[axis.W]: has a meaning only with [split] focus_axis = true; take it out");
  }
  const Section* limits = table_of(document, "limits");
  if (const Entry* reach = limits != nullptr ? limits->find("focus_mm") : nullptr) {
    violations.add(reach->at,
                   named(*limits, *reach) + ": has a meaning only with [split] focus_axis = true; take it out");
  }
}

}  // namespace

void check_rules(const Document& document, Violations& violations) {
  constexpr std::array<std::string_view, 3> kSurfaces = {"expression", "height_field", "mesh"};
  constexpr std::array<std::string_view, 4> kTextures = {"hilbert_order", "path", "svg", "bitmap"};
  if (const Section* surface = table_of(document, "surface")) {
    if (const Entry* kind = the_one(*surface, kSurfaces, violations)) {
      check_belongings(*surface, *kind, kOfSurfaces, violations);
    }
  }
  const Section* texture = table_of(document, "texture");
  if (const Entry* kind = texture != nullptr ? the_one(*texture, kTextures, violations) : nullptr) {
    check_belongings(*texture, *kind, kOfTextures, violations);
    if ((kind->key == "path" || kind->key == "svg") && texture->find("step_um") == nullptr) {
      violations.add(texture->at, "[texture] step_um is missing: " + kind->key + " needs " +
                                      expectation(*find_key("texture", "step_um")));
    }
  }
  check_focus_axis(document, violations);
  const Section* split = table_of(document, "split");
  if (split != nullptr && split->find("sigma_um") != nullptr) {
    for (const char* key : {"rule", "time_share_percent"}) {
      if (const Entry* entry = split->find(key)) {
        violations.add(entry->at, named(*split, *entry) + ": has no meaning with sigma_um (line " +
                                      std::to_string(split->find("sigma_um")->at.line) + "); take one of them out");
      }
    }
  }
}

}  // namespace gravure::freeform_file
