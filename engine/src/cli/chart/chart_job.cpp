#include "chart/chart_job.hpp"

#include <sstream>

namespace gravure::cli {
namespace {

std::string trimmed(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : line.substr(first);
}

/// "scanner" of "[scanner]  # ..."; empty where the line is no heading.
std::string section_of(const std::string& line) {
  const std::string text = trimmed(line);
  const std::size_t end = text.find(']');
  return text.empty() || text[0] != '[' || end == std::string::npos ? "" : trimmed(text.substr(1, end - 1));
}

/// "turn_slots" of "turn_slots = 1984"; empty where the line gives no key.
std::string key_of(const std::string& line) {
  const std::string text = trimmed(line);
  const std::size_t equals = text.find('=');
  return equals == std::string::npos ? "" : text.substr(0, text.find_first_of(" \t="));
}

bool is_kept(const std::string& section, const std::string& mode) {
  for (const char* dropped : {"", "job", "image", "repeat", "carriage"}) {
    if (section == dropped) {
      return false;
    }
  }
  return section != (mode == "flat" ? "rotary" : "stage");
}

}  // namespace

std::string chart_job_text(const std::string& base, const ChartJob& job) {
  std::string text = "# " + job.title + ", written by `gravure chart`; README.md beside it says how to read it.\n\n" +
                     "[job]\ntitle = \"" + job.title + "\"\nmode  = \"" + job.mode + "\"\n\n";
  std::istringstream lines(base);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    const std::string heading = section_of(line);
    if (!heading.empty()) {
      section = heading;
    }
    if (!is_kept(section, job.mode) || job.keys.count({section, key_of(line)}) != 0) {
      continue;
    }
    text += line + "\n";
    if (!heading.empty()) {
      for (const auto& [place, value] : job.keys) {
        text += place.first == heading ? place.second + " = " + value + "\n" : "";
      }
    }
  }
  return text + "\n[image]\n" + job.image;
}

}  // namespace gravure::cli
