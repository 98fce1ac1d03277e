#pragma once

#include <CLI/CLI.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "gravure/formats/motion_json.hpp"
#include "gravure/motion/plan_profile.hpp"
#include "gravure/motion/settling.hpp"
#include "text_output.hpp"

namespace gravure::cli {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr std::size_t kMostMotionBytes = std::size_t{1} << 30;  ///< of a file that a verb of motion reads

inline constexpr double kAnyNumber = std::numeric_limits<double>::max();
/// Refuses what is no decimal number from `least` to `most`; with kAnyNumber for `most` any finite one goes, its range
/// being checked with others'. Without it an option takes "nan", "0x10", and 1e-400 for 0.
CLI::Validator number_from(double least, double most);
template <class Number>
CLI::Option* add_number(CLI::App& verb, const std::string& name, Number& number, const std::string& text) {
  return verb.add_option(name, number, text)->check(number_from(-kAnyNumber, kAnyNumber));
}
/// The numbers of a list that --option was given, separated by commas; an error shows `form`.
Result<std::vector<double>> numbers_of(const std::string& option, const std::string& text, const std::string& form);

/// A move as it stands on the command line.
struct MoveOptions {
  double stroke_mm = 0;
  double v_max = 0;
  double a_up = 0;
  std::optional<double> a_down;  ///< as a_up
  std::optional<double> s_factor;
  std::optional<double> jerk_up;
  std::optional<double> jerk_down;  ///< as jerk_up
  double update_us = 250;
  double start_velocity = 0;
  double end_velocity = 0;
};

/// `required`: stroke, velocity and acceleration have to be there.
void add_move_options(CLI::App& verb, MoveOptions& options, bool required);
/// With the jerk limits, which must be there.
motion::JerkRequest jerk_request_of(const MoveOptions& options);
/// S factor or jerk limits, never both; S factor 0 (the trapezoid) when neither is given.
Result<motion::Profile> plan_move(const MoveOptions& options);

/// `--mode f_hz,zeta[,p]` as often as there are modes, and the band.
struct ModeOptions {
  std::vector<std::string> modes;
  std::optional<double> band_mm_s2;
  std::optional<double> band_mm;
};

void add_mode_options(CLI::App& verb, ModeOptions& options);
/// Shares of the last mass of a chain where no mode has one; bad_argument where only some do. Without any mode, two by
/// default: the published indexing table, with a warning, and its band of 840 mm/s^2.
Result<std::vector<motion::Mode>> modes_of(const ModeOptions& options);
Result<motion::Band> band_of(const ModeOptions& options);

/// Where results go beside standard output; empty for nowhere.
struct OutputOptions {
  std::string csv;
  std::string plot;
  std::string plot_title;  ///< in place of the verb's own
};

/// Position, velocity and acceleration over the time in ms.
std::vector<formats::Curve> profile_curves(const motion::Profile& profile);

void add_output_options(CLI::App& verb, OutputOptions& options);
/// Fails with bad_argument, before anything is computed, where two of the files to write are one, or one is an input.
Result<void> check_outputs(const OutputOptions& options, const std::vector<std::string>& inputs,
                           const std::string& program_output = {});
/// Writes what was asked for, all or nothing; `program` with it.
Result<void> write_outputs(const OutputOptions& options, const std::string& csv, const std::string& title,
                           const std::string& x_name, const std::vector<formats::Curve>& curves,
                           const TextFile& program = {});

}  // namespace gravure::cli
