#include "motion_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "gravure/motion/search.hpp"
#include "gravure/motion/shaper.hpp"
#include "motion_options.hpp"

namespace gravure::cli {
namespace {

using motion::Profile;

/// Update time of the samples that are written; plots take at most a few thousand.
struct ProfileOptions {
  MoveOptions move;
  std::optional<double> target_velocity;
  OutputOptions output;
};

/// To a target that stands, or to one that moves.
Result<Profile> plan_to_target(const ProfileOptions& options) {
  if (!options.target_velocity) {
    return plan_move(options.move);
  }
  if (!options.move.jerk_up) {
    return Error{ErrorCode::bad_argument, "--target-velocity: needs jerk limits (--jerk-up), not an S factor"};
  }
  return motion::plan_rendezvous(jerk_request_of(options.move), *options.target_velocity);
}

std::string profile_text(const Profile& profile) {
  std::string text = fmt::format("access time   {:.6f} ms\n", profile.access_time_s() * 1e3);
  text += fmt::format("peak          {:.6g} mm/s, up {:.6g} and down {:.6g} mm/s^2\n", profile.peak_velocity_mm_s,
                      profile.peak_acceleration_up_mm_s2, profile.peak_acceleration_down_mm_s2);
  const auto& reduced = profile.reduced;
  if (reduced.velocity || reduced.acceleration()) {
    text += fmt::format("not reached  {}{}{}\n", reduced.velocity ? " velocity" : "",
                        reduced.acceleration_up ? " acceleration_up" : "",
                        reduced.acceleration_down ? " acceleration_down" : "");
  }
  text +=
      fmt::format("{:>8} {:>14} {:>16} {:>14} {:>14}\n", "segment", "from ms", "acceleration", "velocity", "position");
  for (std::size_t k = 0; k < 7; ++k) {
    text += fmt::format("{:>8} {:>14.6f} {:>16.6f} {:>14.6f} {:>14.9f}\n", k + 1, profile.times_s[k] * 1e3,
                        profile.acceleration_mm_s2[k], profile.velocity_mm_s[k], profile.position_mm[k]);
  }
  return text;
}

std::vector<formats::Curve> profile_curves(const Profile& profile, int points) {
  std::vector<formats::Curve> curves{
      {"position mm", {}, {}}, {"velocity mm/s", {}, {}}, {"acceleration mm/s^2", {}, {}}};
  for (int i = 0; i <= points; ++i) {
    const double time_s = profile.access_time_s() * i / points;
    const motion::State state = profile.at(time_s);
    const double values[] = {state.position_mm, state.velocity_mm_s, state.acceleration_mm_s2};
    for (std::size_t c = 0; c < curves.size(); ++c) {
      curves[c].x.push_back(time_s * 1e3);
      curves[c].y.push_back(values[c]);
    }
  }
  return curves;
}

Result<int> run_profile(const ProfileOptions& options, bool json) {
  GRAVURE_TRY(const Profile profile, plan_to_target(options));
  std::string csv;
  if (!options.output.csv.empty()) {
    GRAVURE_TRY(const auto samples, motion::sample_profile(profile, options.move.update_us));
    csv = formats::samples_to_csv(samples);
  }
  GRAVURE_CHECK(write_outputs(options.output, csv, "Motion profile", "ms", profile_curves(profile, 1000)));
  print(json ? formats::profile_to_json(profile) : profile_text(profile));
  return kDone;
}

void add_profile(CLI::App& parent, Command& command) {
  CLI::App* verb = add_verb(parent, command, "profile", "Plan a jerk-limited move");
  const auto options = std::make_shared<ProfileOptions>();
  add_move_options(*verb, options->move, true);
  verb->add_option("--target-velocity", options->target_velocity,
                   "The target moves at this velocity in mm/s; the stroke is its distance at the start");
  add_output_options(*verb, options->output);
  verb->callback(
      [&command, options] { command.run = [&command, options] { return run_profile(*options, command.json); }; });
}

struct RespondOptions {
  MoveOptions move;
  ModeOptions modes;
  OutputOptions output;
  bool quantised = false;
  double delay_us = 0;
  std::optional<double> until_ms;  ///< of CSV and figure
  std::string shaper;
};

Result<std::vector<motion::InputJump>> respond_input(const RespondOptions& options,
                                                     const std::vector<motion::Mode>& modes) {
  GRAVURE_TRY(const Profile profile, plan_move(options.move));
  std::vector<motion::InputJump> input = motion::input_of(profile);
  if (options.quantised) {
    GRAVURE_TRY(input, motion::quantised_input_of(profile, options.move.update_us));
  }
  if (!(options.delay_us >= 0 && options.delay_us <= 1e9)) {
    return Error{ErrorCode::out_of_range, fmt::format("--delay-us {}: must be from 0 to 1e9", options.delay_us)};
  }
  if (!options.shaper.empty()) {
    const auto kind = options.shaper == "zv" ? motion::ShaperKind::zv : motion::ShaperKind::zvd;
    GRAVURE_TRY(const auto shaper, motion::make_shaper(kind, modes));
    input = motion::shape_input(input, shaper);
  }
  return motion::delayed(std::move(input), options.delay_us * 1e-6);
}

/// CSV and figure of what is carried, a little beyond the positioning time unless told otherwise.
Result<void> write_response(const RespondOptions& options, const std::vector<motion::Mode>& modes,
                            const std::vector<motion::InputJump>& input, const formats::Response& response) {
  const motion::Settling& settling = response.settling;
  const double until_s = options.until_ms
                             ? *options.until_ms * 1e-3
                             : 1.5 * std::min(settling.positioning_time_s, 4 * settling.access_time_s) + 1e-6;
  if (!(until_s > 0 && until_s <= 1e9)) {
    return Error{ErrorCode::out_of_range, fmt::format("--until-ms {}: must be above 0, to 1e12", until_s * 1e3)};
  }
  std::vector<formats::Curve> curves(2);
  curves[0].name = "carried acceleration mm/s^2";
  curves[1].name = "deviation mm";
  curves[response.band.of == motion::BandOf::acceleration ? 0 : 1].band = response.band.tolerance;
  std::string csv = "time_s,acceleration_mm_s2,deviation_mm\n";
  constexpr int kPoints = 2000;
  for (int i = 0; i <= kPoints; ++i) {
    const double time_s = until_s * i / kPoints;
    const motion::CarriedState state = motion::carried_at(modes, input, time_s);
    csv += fmt::format("{},{},{}\n", time_s, state.acceleration_mm_s2, state.deviation_mm);
    for (std::size_t c = 0; c < 2; ++c) {
      curves[c].x.push_back(time_s * 1e3);
      curves[c].y.push_back(c == 0 ? state.acceleration_mm_s2 : state.deviation_mm);
    }
  }
  for (formats::Curve& curve : curves) {
    curve.marks = {settling.access_time_s * 1e3, settling.positioning_time_s * 1e3};
  }
  return write_outputs(options.output, csv, "Residual vibration", "ms", curves);
}

Result<int> run_respond(const RespondOptions& options, bool json) {
  GRAVURE_TRY(const std::vector<motion::Mode> modes, modes_of(options.modes));
  GRAVURE_TRY(const motion::Band band, band_of(options.modes));
  GRAVURE_TRY(const auto input, respond_input(options, modes));
  GRAVURE_TRY(const motion::Settling settling, motion::settle(modes, input, band));
  const double residual = motion::residual_of(modes, input, band.of).envelope(0);
  const formats::Response response{
      modes, band, settling, residual, options.quantised ? options.move.update_us : 0, options.delay_us * 1e-6};
  if (!options.output.csv.empty() || !options.output.plot.empty()) {
    GRAVURE_CHECK(write_response(options, modes, input, response));
  }
  print(json ? formats::response_to_json(response)
             : fmt::format("access time       {:.6f} ms\npositioning time  {:.6f} ms\nresidual after    {:.6f} ms\n"
                           "envelope settles  {:.6f} ms\n",
                           settling.access_time_s * 1e3, settling.positioning_time_s * 1e3,
                           settling.residual_after_s() * 1e3, settling.envelope_time_s * 1e3));
  return kDone;
}

void add_respond(CLI::App& parent, Command& command) {
  CLI::App* verb = add_verb(parent, command, "respond", "How what the axis carries vibrates after a move");
  const auto options = std::make_shared<RespondOptions>();
  add_move_options(*verb, options->move, true);
  add_mode_options(*verb, options->modes);
  verb->add_flag("--quantised", options->quantised, "As a servo makes it that takes one set-point an update");
  verb->add_option("--shaper", options->shaper, "Run the move through an input shaper for these modes: zv or zvd")
      ->check(CLI::IsMember({"zv", "zvd"}));
  verb->add_option("--delay-us", options->delay_us, "Dead time before the axis moves")->capture_default_str();
  verb->add_option("--until-ms", options->until_ms, "End of the CSV and the figure (beyond the positioning time)");
  add_output_options(*verb, options->output);
  verb->callback(
      [&command, options] { command.run = [&command, options] { return run_respond(*options, command.json); }; });
}

struct SearchVerbOptions {
  MoveOptions move;
  ModeOptions modes;
  OutputOptions output;
  double mode_error_percent = 5;
  double jerk_max = 1e21;
  bool no_grid = false;
  std::uint64_t seed = 1;
  std::uint32_t effort = 1;
};

/// Envelope when the input ends; what is left of a shaped one is rounding.
std::string residual_text(double residual) {
  return residual < 1e-8 ? "< 1e-8" : fmt::format("{:.4g}", residual);
}

std::string search_text(const motion::SearchReport& report, double error_percent) {
  std::string text = fmt::format("{:<16} {:>12} {:>12} {:>14} {:>12}  {}\n", "", "access ms", "settled ms",
                                 fmt::format("+-{} % ms", error_percent), "residual", "v mm/s, a up, a down mm/s^2, S");
  for (const motion::Alternative& row : report.alternatives) {
    text += fmt::format("{:<16} {:>12.4f} {:>12.4f} {:>14.4f} {:>12}", row.name, row.access_time_s * 1e3,
                        row.positioning_time_s * 1e3, row.worst_positioning_time_s * 1e3, residual_text(row.residual));
    if (row.profile) {
      text += fmt::format("  {:.4f}, {:.2f}, {:.2f}, {:.4f}", row.profile->v_mm_s, row.profile->a_up_mm_s2,
                          row.profile->a_down_mm_s2, row.profile->s_factor);
    }
    text += "\n";
  }
  return text + fmt::format("{} profiles evaluated. {}\n", report.evaluated, report.verdict);
}

std::string search_csv(const motion::SearchReport& report) {
  std::string csv =
      "name,access_time_s,positioning_time_s,worst_positioning_time_s,envelope_time_s,v_mm_s,a_up_mm_s2,a_down_mm_s2,s_"
      "factor\n";
  for (const motion::Alternative& row : report.alternatives) {
    const motion::Candidate c = row.profile.value_or(motion::Candidate{});
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", row.name, row.access_time_s, row.positioning_time_s,
                       row.worst_positioning_time_s, row.envelope_time_s, c.v_mm_s, c.a_up_mm_s2, c.a_down_mm_s2,
                       c.s_factor, row.residual);
  }
  return csv;
}

Result<int> run_search(const SearchVerbOptions& options, bool json) {
  const MoveOptions& move = options.move;
  motion::SearchProblem problem{
      move.stroke_mm, move.v_max, move.a_up, move.a_down.value_or(move.a_up), options.jerk_max,
      move.update_us, {},         {},        options.mode_error_percent};
  GRAVURE_TRY(problem.modes, modes_of(options.modes));
  GRAVURE_TRY(problem.band, band_of(options.modes));
  motion::SearchOptions search{std::nullopt, options.seed, options.effort, true};
  // The published grid is made for a table of its size; other moves may have no point on it.
  if (!options.no_grid && motion::search_grid(problem, motion::SearchGrid{}, false)) {
    search.grid = motion::SearchGrid{};
  }
  GRAVURE_TRY(const motion::SearchReport report, motion::search(problem, search));
  const motion::Candidate& best = report.best;
  const motion::SFactorRequest request{
      {move.stroke_mm, best.v_mm_s, best.a_up_mm_s2, best.a_down_mm_s2, 0, 0}, best.s_factor, move.update_us};
  GRAVURE_TRY(const Profile profile, motion::plan_profile(request));
  GRAVURE_CHECK(write_outputs(options.output, search_csv(report), "Best profile", "ms", profile_curves(profile, 1000)));
  print(json ? formats::search_to_json(report) : search_text(report, options.mode_error_percent));
  return kDone;
}

void add_search(CLI::App& parent, Command& command) {
  CLI::App* verb = add_verb(parent, command, "search", "The move with the shortest positioning time, beside shapers");
  const auto options = std::make_shared<SearchVerbOptions>();
  verb->add_option("--stroke-mm", options->move.stroke_mm, "Distance to the target")->required();
  verb->add_option("--v-max", options->move.v_max, "Velocity limit in mm/s")->required();
  verb->add_option("--a-up", options->move.a_up, "Acceleration limit along the move in mm/s^2")->required();
  verb->add_option("--a-down", options->move.a_down, "Acceleration limit against the move in mm/s^2 (as --a-up)");
  verb->add_option("--jerk-max", options->jerk_max, "Jerk limit in mm/s^3 (none)");
  verb->add_option("--update-us", options->move.update_us, "Update time of the controller")->capture_default_str();
  add_mode_options(*verb, options->modes);
  verb->add_option("--mode-error-percent", options->mode_error_percent, "Error of the modes in the worst case")
      ->capture_default_str();
  verb->add_flag("--no-grid", options->no_grid, "Leave out the complete published grids");
  verb->add_option("--seed", options->seed, "Of the random starting points")->capture_default_str();
  verb->add_option("--effort", options->effort, "Multiplies the random starting points")->capture_default_str();
  add_output_options(*verb, options->output);
  verb->callback(
      [&command, options] { command.run = [&command, options] { return run_search(*options, command.json); }; });
}

}  // namespace

void add_motion_command(CLI::App& app, Command& command) {
  CLI::App* motion = app.add_subcommand("motion", "Moves that do not ring and rotary paths that do not turn back");
  motion->require_subcommand(1);
  add_profile(*motion, command);
  add_respond(*motion, command);
  add_search(*motion, command);
  add_motion_identify(*motion, command);
  add_motion_unreverse(*motion, command);
}

}  // namespace gravure::cli
