#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

/// A complete job for the tests to bend: the embossing roller.
inline const std::string& sample_job() {
  static const std::string text = R"([job]
title = "honeycomb embossing roller"
mode  = "rotary"

[laser]
seed_hz       = 82_000_000
pulse_divider = 41            # k: every k-th seed pulse is amplified (2 MHz)
max_pulse_on_demand_hz = 16_400_000   # faster than the gate can switch single pulses: error

[fpga]
clock_multiplier = 2          # j: FPGA clock = j * seed
counter_bits     = 32         # n, 8..64
fractional       = false      # the counter has the second accumulator
max_prescaler    = 4_294_967_295   # largest m

[scanner]
pixel_pitch_um       = 8.0
slots_per_microvector = 20    # one scanner set-point every 20 pulse slots; a line is a whole number of them
turn_slots           = 1800   # least run-out + run-in between lines
max_extra_slots      = 0      # how many more slots the planner may add to a line to improve the seam
bidirectional        = true
bidirectional_offset_ticks = 0   # delay of right-to-left lines, may be negative

[rotary]
diameter_mm        = 70.0     # or circumference_mm
line_pitch_um      = 8.0      # or lines_per_revolution = 27489
encoder_lines      = 11840
interpolation_bits = 13       # q
gear               = [1, 1]   # encoder turns : workpiece turns, integers
max_ab_hz          = 2_000_000

[image]
files        = ["layers/*.tif"]   # natural order; a multi-page file gives its pages in order
fires        = "white"            # or "black"; no default: saying it is required
lines_along  = "rows"             # image row = scan line; "columns" = image column = scan line
revolutions  = 100                # default: one per layer
order        = "sequence"         # layer r on revolution r | "cycle" | "hold" (repeat the last)

[limits]
seam_um = 0.5
)";
  return text;
}

/// `text` without the one line that starts with `key`.
inline std::string without_line(const std::string& text, std::string_view key) {
  const std::size_t found = text.find("\n" + std::string(key));
  EXPECT_NE(found, std::string::npos) << key;
  EXPECT_EQ(text.find("\n" + std::string(key), found + 1), std::string::npos) << key << " stands twice";
  const std::size_t end = text.find('\n', found + 1);
  return text.substr(0, found) + text.substr(end);
}

/// `text` without the line of a key of one section.
inline std::string without_key(const std::string& text, const std::string& section, const std::string& key) {
  const std::size_t start = text.find("[" + section + "]");
  const std::size_t found = text.find("\n" + key + " ", start);
  EXPECT_LT(found, text.find("\n[", start)) << key;
  return text.substr(0, found) + text.substr(text.find('\n', found + 1));
}

/// The sample with one piece of text, which it must contain exactly once, replaced.
inline std::string sample_with(std::string_view from, std::string_view to) {
  std::string text = sample_job();
  const std::size_t found = text.find(from);
  EXPECT_NE(found, std::string::npos) << from;
  EXPECT_EQ(text.find(from, found + 1), std::string::npos) << from << " stands twice";
  return text.replace(found, from.size(), to);
}

/// "line:column" of the first place where `piece` stands in `text`; both count from 1.
inline std::string place_of(std::string_view text, std::string_view piece) {
  const std::size_t found = text.find(piece);
  EXPECT_NE(found, std::string_view::npos) << piece;
  const std::string_view before = text.substr(0, found);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return std::to_string(line) + ":" + std::to_string(found - line_start + 1);
}
