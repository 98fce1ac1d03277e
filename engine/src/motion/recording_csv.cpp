#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "gravure/motion/identify.hpp"

namespace gravure::motion {
namespace {

constexpr std::size_t kMaxSamples = 10'000'000;

bool is_separator(char c) noexcept {
  return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

/// The next number of the line; false where there is none.
bool take_number(std::string_view& line, double& value) {
  while (!line.empty() && is_separator(line.front())) {
    line.remove_prefix(1);
  }
  if (!line.empty() && line.front() == '+') {
    line.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc{}) {
    return false;
  }
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return std::isfinite(value) && (line.empty() || is_separator(line.front()));
}

bool take_sample(std::string_view line, Recording& recording) {
  double time_s = 0;
  double acceleration = 0;
  if (!take_number(line, time_s) || !take_number(line, acceleration)) {
    return false;
  }
  recording.time_s.push_back(time_s);
  recording.acceleration_mm_s2.push_back(acceleration);
  return true;
}

bool is_blank_or_comment(std::string_view line) noexcept {
  for (const char c : line) {
    if (c == '#') {
      return true;
    }
    if (!is_separator(c)) {
      return false;
    }
  }
  return true;
}

}  // namespace

Result<Recording> parse_recording_csv(std::string_view text) {
  Recording recording;
  bool heading_allowed = true;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (is_blank_or_comment(line)) {
      continue;
    }
    if (!take_sample(line, recording) && !heading_allowed) {
      return Error{ErrorCode::bad_file,
                   fmt::format("recording: line {}: \"{}\": must be time in s and acceleration in mm/s^2, two numbers",
                               number, line.substr(0, 60))};
    }
    heading_allowed = false;
    if (recording.time_s.size() > kMaxSamples) {
      return Error{ErrorCode::bad_file,
                   fmt::format("recording: more than {} samples: shorten or thin it", kMaxSamples)};
    }
  }
  return recording;
}

}  // namespace gravure::motion
