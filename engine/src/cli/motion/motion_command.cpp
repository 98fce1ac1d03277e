#include "motion/motion_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "gravure/motion/search.hpp"
#include "gravure/motion/shaper.hpp"
#include "motion/motion_options.hpp"

namespace gravure::cli {
namespace {

using motion::Profile;

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
  std::vector<formats::Curve> curves(2);
  curves[0].name = "carried acceleration mm/s^2";
  curves[1].name = "deviation mm";
  curves[response.band.of == motion::BandOf::acceleration ? 0 : 1].band = response.band.tolerance;
  std::string csv = "time_s,acceleration_mm_s2,deviation_mm\n";
  constexpr int kPoints = 2000;
  for (int i = 0; i <= kPoints; ++i) {
    const double time_s = until_s * i / kPoints;
    const motion::CarriedState state = motion::carried_at(modes, input, time_s);
    csv += fmt::format("{:.12g},{:.12g},{:.12g}\n", time_s, state.acceleration_mm_s2, state.deviation_mm);
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

std::string milliseconds(double time_s) {
  return std::isfinite(time_s) ? fmt::format("{:.6f} ms", time_s * 1e3) : "never";
}

Result<int> run_respond(const RespondOptions& options, bool json) {
  GRAVURE_CHECK(check_outputs(options.output, {}));
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
             : fmt::format("access time       {}\npositioning time  {}\nresidual after    {}\nenvelope settles  {}\n",
                           milliseconds(settling.access_time_s), milliseconds(settling.positioning_time_s),
                           milliseconds(settling.residual_after_s()), milliseconds(settling.envelope_time_s)));
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
  verb->add_option("--delay-us", options->delay_us, "Dead time before the axis moves")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  verb->add_option("--until-ms", options->until_ms, "End of the CSV and the figure (beyond the positioning time)")
      ->check(number_from(1e-6, 1e12));
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
  if (report.grids) {
    text += fmt::format("published grid: {} symmetric points, best {:.4f} ms; {} asymmetric ones, best {:.4f} ms\n",
                        report.grids->symmetric.evaluated, report.grids->symmetric.best.positioning_time_s * 1e3,
                        report.grids->asymmetric.evaluated, report.grids->asymmetric.best.positioning_time_s * 1e3);
  }
  return text + fmt::format("{} profiles evaluated. {}\n", report.evaluated, report.verdict);
}

std::string search_csv(const motion::SearchReport& report) {
  std::string csv =
      "name,access_time_s,positioning_time_s,worst_positioning_time_s,envelope_time_s,v_mm_s,a_up_mm_s2,a_down_mm_s2,s_"
      "factor,residual\n";
  for (const motion::Alternative& row : report.alternatives) {
    const motion::Candidate c = row.profile.value_or(motion::Candidate{});
    csv += fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", row.name,
                       row.access_time_s, row.positioning_time_s, row.worst_positioning_time_s, row.envelope_time_s,
                       c.v_mm_s, c.a_up_mm_s2, c.a_down_mm_s2, c.s_factor, row.residual);
  }
  return csv;
}

Result<int> run_search(const SearchVerbOptions& options, bool json) {
  GRAVURE_CHECK(check_outputs(options.output, {}));
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
  GRAVURE_CHECK(write_outputs(options.output, search_csv(report), "Best profile", "ms", profile_curves(profile)));
  print(json ? formats::search_to_json(report) : search_text(report, options.mode_error_percent));
  return kDone;
}

void add_search(CLI::App& parent, Command& command) {
  CLI::App* verb = add_verb(parent, command, "search", "The move with the shortest positioning time, beside shapers");
  const auto options = std::make_shared<SearchVerbOptions>();
  add_number(*verb, "--stroke-mm", options->move.stroke_mm, "Distance to the target")->required();
  add_number(*verb, "--v-max", options->move.v_max, "Velocity limit in mm/s")->required();
  add_number(*verb, "--a-up", options->move.a_up, "Acceleration limit along the move in mm/s^2")->required();
  add_number(*verb, "--a-down", options->move.a_down, "Acceleration limit against the move in mm/s^2 (as --a-up)");
  add_number(*verb, "--jerk-max", options->jerk_max, "Jerk limit in mm/s^3 (none)");
  add_number(*verb, "--update-us", options->move.update_us, "Update time of the controller")->capture_default_str();
  add_mode_options(*verb, options->modes);
  add_number(*verb, "--mode-error-percent", options->mode_error_percent, "Error of the modes in the worst case")
      ->capture_default_str();
  verb->add_flag("--no-grid", options->no_grid, "Leave out the complete published grids");
  add_integer(*verb, "--seed", options->seed, "Of the random starting points", 0,
              std::numeric_limits<std::int64_t>::max());
  add_integer(*verb, "--effort", options->effort, "Rounds with random starting points; one more is never worse", 1,
              1000);
  add_output_options(*verb, options->output);
  verb->callback(
      [&command, options] { command.run = [&command, options] { return run_search(*options, command.json); }; });
}

}  // namespace

void add_motion_command(CLI::App& app, Command& command) {
  CLI::App* motion = app.add_subcommand("motion", "Moves that do not ring and rotary paths that do not turn back");
  motion->require_subcommand(1);
  add_motion_profile(*motion, command);
  add_respond(*motion, command);
  add_search(*motion, command);
  add_motion_identify(*motion, command);
  add_motion_unreverse(*motion, command);
}

}  // namespace gravure::cli
