#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gravure/motion/identify.hpp"
#include "gravure/motion/profile.hpp"
#include "gravure/motion/rotary_rewrite.hpp"
#include "gravure/motion/search.hpp"
#include "gravure/motion/settling.hpp"
#include "gravure/motion/synchronise.hpp"
#include "gravure/motion/unreverse.hpp"

namespace gravure::formats {

/// The results of the motion commands as JSON, indented by 2, keys in a fixed order, the same bytes for the same
/// result. Times in s, lengths in mm; what is infinite (a vibration that never settles) is null.

/// times_s[8], velocity_constants[7], position_constants[7], acceleration_constants[7], jerk_constants[7],
/// access_time_s, stroke_mm, peak_*, reduced{velocity, acceleration, acceleration_up, acceleration_down}.
std::string profile_to_json(const motion::Profile& profile);

/// access_time_s, slowest_axis (from 0), axes[] as above.
std::string synchronised_to_json(const motion::SynchronisedMove& move);

/// What `respond` found out, of the move as planned and, where asked for, as a servo with updates makes it.
struct Response {
  std::vector<motion::Mode> modes;
  motion::Band band;
  motion::Settling settling;
  double residual = 0;   ///< envelope when the move ends, in the band's unit
  double update_us = 0;  ///< > 0: the input was quantised
  double delay_s = 0;
};

/// access_time_s, positioning_time_s, residual_after_s (how long the residual stays outside the band), envelope_time_s,
/// residual_at_access, band, modes.
std::string response_to_json(const Response& response);

/// best{v, a_up, a_down, s_factor, positioning_time_s}, evaluated, grids{symmetric{evaluated, best}, asymmetric{}} (or
/// null), alternatives, shortest, shortest_worst, verdict.
std::string search_to_json(const motion::SearchReport& report);

/// modes[{f_hz, f_sd_hz, zeta, zeta_sd, participation, participation_sd}], participation_is_absolute, offset, noise.
std::string identification_to_json(const motion::Identification& identification);

/// An axis of a path with its reversals removed.
struct UnreversedAxis {
  std::string name;  ///< "a" or "c"
  double tolerance_deg = 0;
  motion::Unreversed result;
  double shift_deg = 0;  ///< of the published rule
  motion::Shifted shifted{};
};

/// What became of the tool and of its program.
struct ToolPathSummary {
  std::optional<double> clearance_mm;  ///< where surfaces were given; infinite where no point of them was near
  std::size_t turned_blocks = 0;
  double largest_turn_deg = 0;
  std::optional<motion::Rewritten> rewritten;
};

/// axes[{name, reversals_before, reversals_after, control_points, largest_deviation_deg, rms_deviation_deg, turns,
/// published_shift{shift_deg, reversals_after, largest_deviation_deg, rms_deviation_deg}}];
/// with surfaces interference{clearance_mm, turned_blocks, largest_turn_deg}; with a new program
/// rewritten{changed_lines, largest_tilt_deg, largest_shift_mm, largest_error_mm}.
std::string unreversed_to_json(const std::vector<UnreversedAxis>& axes, const ToolPathSummary& tool = {});

/// CSV of samples: "time_s,position_mm,velocity_mm_s,acceleration_mm_s2,jerk_mm_s3".
std::string samples_to_csv(const std::vector<motion::Sample>& samples);
/// The same of several axes, one after another, with the axis (from 0) as the first column.
std::string samples_to_csv(const std::vector<std::vector<motion::Sample>>& axes);

/// One curve of a plot.
struct Curve {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  double band = 0;              ///< > 0: dashed lines at +-band
  std::vector<double> marks{};  ///< of x: dashed lines upright
};

/// A stand-alone SVG: curves over a common x axis, each in a panel of its own with its range at the side. Curves of
/// fewer than two points are left out.
std::string curves_to_svg(const std::string& title, const std::string& x_name, const std::vector<Curve>& curves);

}  // namespace gravure::formats
