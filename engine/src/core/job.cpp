#include "gravure/core/job.hpp"

namespace gravure {

std::string_view mode_name(Mode mode) {
  switch (mode) {
    case Mode::rotary:
      return "rotary";
    case Mode::helical:
      return "helical";
    case Mode::flat:
      return "flat";
    case Mode::freeform:
      return "freeform";
    case Mode::zones:
      return "zones";
  }
  return "";
}

std::string Job::place_of(std::string_view key) const {
  auto found = places.find(key);
  if (found == places.end()) {
    found = places.find(key.substr(0, key.find('.')));
  }
  if (found == places.end()) {
    return path.empty() ? "" : path + ": ";
  }
  return path + ":" + std::to_string(found->second.line) + ":" + std::to_string(found->second.column) + ": ";
}

}  // namespace gravure
