#include "motion/motion_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "program/program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

/// What `text` is as a decimal number; not finite where it is none, or one that a double does not hold.
double number_of(const std::string& text) {
  double value = 0;
  const char* const from = text.data() + (text.size() > 1 && text[0] == '+' ? 1 : 0);
  const char* const to = text.data() + text.size();
  const auto [end, error] = std::from_chars(from, to, value);
  return error == std::errc{} && end == to ? value : std::numeric_limits<double>::quiet_NaN();
}

/// The two modes and the band of the published indexing table [C1], fitted to its positioning times.
constexpr motion::FrequencyAndDamping kIndexingTable[] = {{36.206, 0.2249}, {86.748, 0.0331}};
constexpr double kIndexingBand_mm_s2 = 840;

motion::Move move_of(const MoveOptions& options) {
  return {options.stroke_mm,      options.v_max,       options.a_up, options.a_down.value_or(options.a_up),
          options.start_velocity, options.end_velocity};
}

}  // namespace

CLI::Validator number_from(double least, double most) {
  const bool bounded = most < std::numeric_limits<double>::max();
  const std::string range = bounded ? fmt::format("{:g} to {:g}", least, most) : "";
  const std::string wanted = bounded ? "a number from " + range : "a decimal number that a double can hold";
  return CLI::Validator(
      [least, most, wanted](std::string& text) {
        const double value = number_of(text);
        if (value >= least && value <= most) {
          return std::string();
        }
        constexpr std::size_t kShown = 40;
        return fmt::format("must be {}, not \"{}{}\"", wanted, text.substr(0, kShown),
                           text.size() > kShown ? "..." : "");
      },
      range, "number");
}

Result<std::vector<double>> numbers_of(const std::string& option, const std::string& text, const std::string& form) {
  std::vector<double> numbers;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    numbers.push_back(number_of(text.substr(from, to - from)));
    if (!std::isfinite(numbers.back())) {
      return Error{ErrorCode::bad_argument, fmt::format("{} {}: must be {}", option, text.substr(0, 80), form)};
    }
    from = to + 1;
  }
  return numbers;
}

void add_move_options(CLI::App& verb, MoveOptions& options, bool required) {
  add_number(verb, "--stroke-mm", options.stroke_mm, "Distance to the target")->required(required);
  add_number(verb, "--v-max", options.v_max, "Velocity limit in mm/s")->required(required);
  add_number(verb, "--a-up", options.a_up, "Acceleration limit along the move in mm/s^2")->required(required);
  add_number(verb, "--a-down", options.a_down, "Acceleration limit against the move in mm/s^2 (as --a-up)");
  auto* s_factor = add_number(verb, "--s-factor", options.s_factor, "Length of each jerk segment in updates (0)");
  add_number(verb, "--jerk-up", options.jerk_up, "Jerk limit along the move in mm/s^3, instead of --s-factor")
      ->excludes(s_factor);
  add_number(verb, "--jerk-down", options.jerk_down, "Jerk limit against the move in mm/s^3 (as --jerk-up)")
      ->needs("--jerk-up");
  add_number(verb, "--update-us", options.update_us, "Update time of the controller")->capture_default_str();
  add_number(verb, "--start-velocity", options.start_velocity, "Velocity at the start in mm/s")->capture_default_str();
  add_number(verb, "--end-velocity", options.end_velocity, "Velocity at the target in mm/s")->capture_default_str();
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
  verb.add_option("--mode", options.modes,
                  "f_hz,zeta[,participation]; once for each mode (the two of the published indexing table)")
      ->allow_extra_args(false);
  auto* acceleration =
      add_number(verb, "--band-mm-s2", options.band_mm_s2, "Done when the acceleration stays within this");
  add_number(verb, "--band-mm", options.band_mm, "Done when the position stays within this")->excludes(acceleration);
}

Result<std::vector<motion::Mode>> modes_of(const ModeOptions& options) {
  if (options.modes.empty()) {
    warn(
        "no --mode: the two of the published indexing table are taken, 36.206 and 86.748 Hz; `gravure motion identify` "
        "finds those of a machine");
    return motion::chain_modes(kIndexingTable);
  }
  std::vector<motion::Mode> modes;
  std::vector<motion::FrequencyAndDamping> chain;
  for (const std::string& text : options.modes) {
    const std::string form = "f_hz,zeta or f_hz,zeta,participation";
    GRAVURE_TRY(const std::vector<double> numbers, numbers_of("--mode", text, form));
    if (numbers.size() < 2 || numbers.size() > 3) {
      return Error{ErrorCode::bad_argument, fmt::format("--mode {}: must be {}", text.substr(0, 80), form)};
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
  if (options.modes.empty()) {
    return motion::Band{motion::BandOf::acceleration, kIndexingBand_mm_s2};
  }
  return Error{ErrorCode::bad_argument, "one of --band-mm-s2 and --band-mm is needed: it says when the move is done"};
}

void add_output_options(CLI::App& verb, OutputOptions& options) {
  verb.add_option("--csv", options.csv, "Write samples to this file");
  verb.add_option("--plot", options.plot, "Write a figure (SVG) to this file");
  verb.add_option("--plot-title", options.plot_title, "Title of the figure");
}

Result<void> check_outputs(const OutputOptions& options, const std::vector<std::string>& inputs,
                           const std::string& program_output) {
  return refuse_overwrite({{"--output", program_output}, {"--csv", options.csv}, {"--plot", options.plot}}, inputs);
}

Result<void> write_outputs(const OutputOptions& options, const std::string& csv, const std::string& title,
                           const std::string& x_name, const std::vector<formats::Curve>& curves,
                           const TextFile& program) {
  TextFile plot{options.plot, {}};
  if (!plot.path.empty()) {
    plot.text = formats::curves_to_svg(options.plot_title.empty() ? title : options.plot_title, x_name, curves);
  }
  return write_texts({program, {options.csv, csv}, std::move(plot)});
}

}  // namespace gravure::cli
