#include "motion_options.hpp"

#include <fmt/format.h>

#include <charconv>

#include "gravure/core/file_output.hpp"

namespace gravure::cli {
namespace {

Result<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (true) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || (next != end && *next != ',')) {
      return Error{ErrorCode::bad_argument, "--mode " + text + ": must be f_hz,zeta or f_hz,zeta,participation"};
    }
    numbers.push_back(value);
    if (next == end) {
      return numbers;
    }
    at = next + 1;
  }
}

motion::Move move_of(const MoveOptions& options) {
  return {options.stroke_mm,      options.v_max,       options.a_up, options.a_down.value_or(options.a_up),
          options.start_velocity, options.end_velocity};
}

}  // namespace

void add_move_options(CLI::App& verb, MoveOptions& options, bool required) {
  verb.add_option("--stroke-mm", options.stroke_mm, "Distance to the target")->required(required);
  verb.add_option("--v-max", options.v_max, "Velocity limit in mm/s")->required(required);
  verb.add_option("--a-up", options.a_up, "Acceleration limit along the move in mm/s^2")->required(required);
  verb.add_option("--a-down", options.a_down, "Acceleration limit against the move in mm/s^2 (as --a-up)");
  auto* s_factor = verb.add_option("--s-factor", options.s_factor, "Length of each jerk segment in updates (0)");
  verb.add_option("--jerk-up", options.jerk_up, "Jerk limit along the move in mm/s^3, instead of --s-factor")
      ->excludes(s_factor);
  verb.add_option("--jerk-down", options.jerk_down, "Jerk limit against the move in mm/s^3 (as --jerk-up)")
      ->needs("--jerk-up");
  verb.add_option("--update-us", options.update_us, "Update time of the controller")->capture_default_str();
  verb.add_option("--start-velocity", options.start_velocity, "Velocity at the start in mm/s")->capture_default_str();
  verb.add_option("--end-velocity", options.end_velocity, "Velocity at the target in mm/s")->capture_default_str();
}

motion::JerkRequest jerk_request_of(const MoveOptions& options) {
  const double jerk_up = options.jerk_up.value_or(0);
  return {move_of(options), jerk_up, options.jerk_down.value_or(jerk_up)};
}

Result<motion::Profile> plan_move(const MoveOptions& options) {
  if (options.jerk_up) {
    return motion::plan_profile(jerk_request_of(options));
  }
  return motion::plan_profile(
      motion::SFactorRequest{move_of(options), options.s_factor.value_or(0), options.update_us});
}

void add_mode_options(CLI::App& verb, ModeOptions& options) {
  verb.add_option("--mode", options.modes, "f_hz,zeta[,participation]; once for each mode")
      ->required()
      ->allow_extra_args(false);
  auto* acceleration =
      verb.add_option("--band-mm-s2", options.band_mm_s2, "Done when the acceleration stays within this");
  verb.add_option("--band-mm", options.band_mm, "Done when the position stays within this")->excludes(acceleration);
}

Result<std::vector<motion::Mode>> modes_of(const ModeOptions& options) {
  std::vector<motion::Mode> modes;
  std::vector<motion::FrequencyAndDamping> chain;
  for (const std::string& text : options.modes) {
    GRAVURE_TRY(const std::vector<double> numbers, numbers_of(text));
    if (numbers.size() < 2 || numbers.size() > 3) {
      return Error{ErrorCode::bad_argument, "--mode " + text + ": must be f_hz,zeta or f_hz,zeta,participation"};
    }
    if (numbers.size() == 3) {
      modes.push_back({numbers[0], numbers[1], numbers[2]});
    } else {
      chain.push_back({numbers[0], numbers[1]});
    }
  }
  if (!modes.empty() && !chain.empty()) {
    return Error{ErrorCode::bad_argument, "--mode: give every mode a participation, or none"};
  }
  if (modes.empty()) {
    return motion::chain_modes(chain);
  }
  GRAVURE_CHECK(motion::check_modes(modes));
  return modes;
}

Result<motion::Band> band_of(const ModeOptions& options) {
  if (options.band_mm) {
    return motion::Band{motion::BandOf::position, *options.band_mm};
  }
  if (options.band_mm_s2) {
    return motion::Band{motion::BandOf::acceleration, *options.band_mm_s2};
  }
  return Error{ErrorCode::bad_argument, "one of --band-mm-s2 and --band-mm is needed: it says when the move is done"};
}

void add_output_options(CLI::App& verb, OutputOptions& options) {
  verb.add_option("--csv", options.csv, "Write samples to this file");
  verb.add_option("--plot", options.plot, "Write a figure (SVG) to this file");
  verb.add_option("--plot-title", options.plot_title, "Title of the figure");
}

Result<void> write_outputs(const OutputOptions& options, const std::string& csv, const std::string& title,
                           const std::string& x_name, const std::vector<formats::Curve>& curves) {
  if (!options.csv.empty()) {
    GRAVURE_CHECK(write_file(options.csv, csv));
  }
  if (!options.plot.empty()) {
    GRAVURE_CHECK(write_file(
        options.plot, formats::curves_to_svg(options.plot_title.empty() ? title : options.plot_title, x_name, curves)));
  }
  return {};
}

}  // namespace gravure::cli
