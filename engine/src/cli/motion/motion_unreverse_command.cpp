#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include "gravure/core/file_output.hpp"
#include "gravure/motion/rotary_rewrite.hpp"
#include "gravure/motion/smooth_tool_path.hpp"
#include "motion/motion_command.hpp"
#include "motion/motion_options.hpp"
#include "motion/motion_surroundings.hpp"

namespace gravure::cli {
namespace {

struct UnreverseOptions {
  std::string program;
  double tolerance_deg = 0;
  std::size_t control_points = 16;
  std::string rewritten;
  bool machine_frame = false;
  double ball_radius_mm = 0;
  std::vector<double> rotary_centre_mm{0, 0, 0};
  bool choose_branches = false;
  std::vector<double> a_limits_deg;
  std::vector<double> c_limits_deg;
  double shift_deg = 0.05;  ///< [C2]
  SurroundingOptions around;
  OutputOptions output;
};

/// The path of a program, one sample for each block that turns A or C.
struct ToolPath {
  std::string text;
  motion::RotaryPath read;
  std::vector<double> block;    ///< 0, 1, 2 ...
  std::vector<double> a_deg;    ///< as programmed, or of the chosen branches
  std::vector<double> c_deg;    ///< the same, unwrapped
  std::vector<double> c_turns;  ///< whole turns to take off again for the program
  std::vector<motion::ToolPose> tools;
  std::vector<motion::HeldStop> stops;  ///< blocks that move X, Y or Z alone
  motion::Vector3 rotary_centre_mm{};
};

/// `chosen` without the rounding of its way through radians, where it is `programmed` but for whole periods: rounding
/// would count as reversals.
double unrounded(double chosen, double programmed, double period) {
  const double exact = programmed + std::round((chosen - programmed) / period) * period;
  return std::abs(chosen - exact) < 1e-9 ? exact : chosen;
}

Result<void> choose_branches(const UnreverseOptions& options, ToolPath& path) {
  motion::BranchCosts costs;
  if (!options.a_limits_deg.empty()) {
    costs.a_min_rad = options.a_limits_deg[0] * kDegree;
    costs.a_max_rad = options.a_limits_deg[1] * kDegree;
  }
  if (!options.c_limits_deg.empty()) {
    costs.c_min_rad = options.c_limits_deg[0] * kDegree;
    costs.c_max_rad = options.c_limits_deg[1] * kDegree;
  }
  GRAVURE_TRY(const auto poses,
              motion::choose_branches(path.tools, path.rotary_centre_mm, costs, path.read.c_deg.front() * kDegree));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double a = poses[k].a_rad / kDegree;
    path.a_deg[k] = unrounded(a, a * path.read.a_deg[k] < 0 ? -path.read.a_deg[k] : path.read.a_deg[k], 360);
    path.c_deg[k] = unrounded(poses[k].c_rad / kDegree, path.read.c_deg[k], 180);
    path.c_turns[k] = 0;
  }
  return {};
}

/// The tip on the workpiece of a block with the angles of block `k`.
motion::ToolPose tool_at(const UnreverseOptions& options, const ToolPath& path, std::size_t k,
                         const motion::Vector3& xyz) {
  motion::ToolPose tool = motion::tool_of(
      {xyz[0], xyz[1], xyz[2], path.read.a_deg[k] * kDegree, path.read.c_deg[k] * kDegree}, path.rotary_centre_mm);
  if (!options.machine_frame) {
    tool.centre_mm = xyz;
  }
  return tool;
}

Result<ToolPath> load_path(const UnreverseOptions& options) {
  ToolPath path;
  GRAVURE_TRY(path.text, read_file(options.program, kMostMotionBytes));
  GRAVURE_TRY(path.read, motion::parse_rotary_program(path.text, options.program));
  if (path.read.line.size() < 2) {
    return Error{ErrorCode::bad_file, options.program + ": fewer than 2 blocks turn A or C: nothing to do"};
  }
  path.rotary_centre_mm = {options.rotary_centre_mm[0], options.rotary_centre_mm[1], options.rotary_centre_mm[2]};
  path.a_deg = path.read.a_deg;
  path.c_deg = motion::unwrapped(path.read.c_deg, 360);
  for (std::size_t k = 0; k < path.a_deg.size(); ++k) {
    path.tools.push_back(tool_at(options, path, k, path.read.xyz_mm[k]));
    path.block.push_back(static_cast<double>(k));
    path.c_turns.push_back(path.c_deg[k] - path.read.c_deg[k]);
  }
  for (const motion::RotaryPath::Linear& linear : path.read.linear) {
    path.stops.push_back({linear.block, tool_at(options, path, linear.block, linear.xyz_mm).centre_mm, linear.line});
  }
  if (options.choose_branches) {
    GRAVURE_CHECK(choose_branches(options, path));
  }
  return path;
}

Result<motion::SmoothPath> smooth(const UnreverseOptions& options, const ToolPath& path) {
  GRAVURE_TRY(const std::vector<motion::Vector3> points, surrounding_points(options.around, path.rotary_centre_mm));
  motion::SmoothPathRequest request{path.tools,
                                    path.a_deg,
                                    path.c_deg,
                                    path.block,
                                    options.tolerance_deg,
                                    options.control_points,
                                    options.ball_radius_mm,
                                    surroundings_of(options.around, points)};
  request.stops = path.stops;
  request.line_of_sample = path.read.line;
  if (options.machine_frame) {
    request.straight_axes_about_mm = path.rotary_centre_mm;
  }
  auto smoothed = motion::smooth_tool_path(request);
  if (!smoothed) {
    return Error{smoothed.error().code, options.program + ": " + smoothed.error().message};
  }
  return smoothed;
}

/// Angles as they stand in the program, with the turns it winds up.
std::vector<double> program_c(const ToolPath& path, const motion::SmoothPath& smoothed) {
  std::vector<double> c_deg = smoothed.c.angle;
  for (std::size_t k = 0; k < c_deg.size(); ++k) {
    c_deg[k] -= path.c_turns[k];
  }
  return c_deg;
}

Result<motion::Rewritten> rewrite(const UnreverseOptions& options, const ToolPath& path,
                                  const motion::SmoothPath& smoothed) {
  const std::vector<double> c_deg = program_c(path, smoothed);
  return motion::rewrite_rotary_program(
      {path.text, smoothed.a.angle, c_deg,
       options.machine_frame ? motion::ProgramFrame::machine : motion::ProgramFrame::workpiece, options.ball_radius_mm,
       path.rotary_centre_mm, options.program});
}

std::string unreversed_text(const std::vector<formats::UnreversedAxis>& axes, const formats::ToolPathSummary& tool) {
  std::string text;
  for (const auto& axis : axes) {
    text += fmt::format("{}: {} of {} reversals kept, {} control points, at most {:.4f} degrees off (rms {:.4f})\n",
                        axis.name, axis.result.reversals_after, axis.result.reversals_before,
                        axis.result.control_points, axis.result.largest_deviation, axis.result.rms_deviation);
    text += fmt::format(
        "   by the published shift rule ({} degrees): {} kept, at most {:.4f} degrees off (rms {:.4f})\n",
        axis.shift_deg, axis.shifted.reversals_after, axis.shifted.largest_deviation, axis.shifted.rms_deviation);
  }
  if (tool.clearance_mm) {
    text += fmt::format("clearance {:.4f} mm; C turned out of the way at {} blocks by up to {:.3f} degrees\n",
                        *tool.clearance_mm, tool.turned_blocks, tool.largest_turn_deg);
  }
  if (tool.rewritten) {
    text += fmt::format(
        "{} lines written anew: the tool tilts by up to {:.4f} degrees, X Y Z move by up to {:.6f} mm, "
        "its centre by {:.2g} mm (rounding)\n",
        tool.rewritten->changed_lines, tool.rewritten->largest_tilt_deg, tool.rewritten->largest_shift_mm,
        tool.rewritten->largest_error_mm);
  }
  return text;
}

/// The published rule takes the turns off again as well.
std::string path_csv(const ToolPath& path, const motion::SmoothPath& smoothed,
                     const std::vector<formats::UnreversedAxis>& axes) {
  const std::vector<double> c_deg = program_c(path, smoothed);
  std::string csv = "line,a_before_deg,a_deg,c_before_deg,c_deg,x_mm,y_mm,z_mm,a_shifted_deg,c_shifted_deg\n";
  for (std::size_t k = 0; k < path.block.size(); ++k) {
    const motion::Vector3& tip = smoothed.tools[k].centre_mm;
    csv += fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n",
                       path.read.line[k], path.read.a_deg[k], smoothed.a.angle[k], path.read.c_deg[k], c_deg[k], tip[0],
                       tip[1], tip[2], axes[0].shifted.angle[k], axes[1].shifted.angle[k] - path.c_turns[k]);
  }
  return csv;
}

formats::UnreversedAxis axis_of(const UnreverseOptions& options, const std::string& name,
                                const motion::Unreversed& result, const std::vector<double>& programmed) {
  return {name, options.tolerance_deg, result, options.shift_deg,
          motion::published_shift_between_turns(programmed, options.tolerance_deg, options.shift_deg)};
}

Result<int> run_unreverse(const UnreverseOptions& options, bool json) {
  const std::vector<std::string> inputs{options.program, options.around.surface, options.around.blade};
  GRAVURE_CHECK(check_outputs(options.output, inputs, options.rewritten));
  GRAVURE_TRY(const ToolPath path, load_path(options));
  GRAVURE_TRY(const motion::SmoothPath smoothed, smooth(options, path));
  formats::ToolPathSummary tool;
  if (options.around.any()) {
    tool.clearance_mm = smoothed.clearance_mm;
    tool.turned_blocks = smoothed.turned_samples;
    tool.largest_turn_deg = smoothed.largest_turn_deg;
  }
  if (!options.rewritten.empty()) {
    GRAVURE_TRY(tool.rewritten, rewrite(options, path, smoothed));
  }
  const std::vector<formats::UnreversedAxis> axes{axis_of(options, "a", smoothed.a, path.a_deg),
                                                  axis_of(options, "c", smoothed.c, path.c_deg)};
  const std::vector<formats::Curve> curves{{"a degrees", path.block, smoothed.a.angle},
                                           {"a degrees, published shift", path.block, axes[0].shifted.angle},
                                           {"c degrees", path.block, smoothed.c.angle},
                                           {"c degrees, published shift", path.block, axes[1].shifted.angle}};
  const std::string csv = options.output.csv.empty() ? "" : path_csv(path, smoothed, axes);
  GRAVURE_CHECK(write_outputs(options.output, csv, "Rotary axes without unintended reversals", "block", curves,
                              {options.rewritten, tool.rewritten ? tool.rewritten->program : ""}));
  print(json ? formats::unreversed_to_json(axes, tool) : unreversed_text(axes, tool));
  return kDone;
}

void add_tool_options(CLI::App& verb, UnreverseOptions& options) {
  verb.add_option("-o,--output", options.rewritten, "Write the program with the new angles, X Y Z computed anew");
  verb.add_flag("--machine-frame", options.machine_frame,
                "X Y Z are the machine's axes (else the tool's tip on the workpiece)");
  verb.add_option("--ball-radius-mm", options.ball_radius_mm, "Hold the centre of a ball end (0: the tip or focus)")
      ->check(number_from(0, 1e6))
      ->capture_default_str();
  verb.add_option("--rotary-centre-mm", options.rotary_centre_mm, "x,y,z where A and C cross, on the workpiece (0,0,0)")
      ->check(number_from(-1e6, 1e6))
      ->delimiter(',')
      ->expected(3);
  verb.add_flag("--choose-branches", options.choose_branches,
                "Choose the branch and turns of A and C anew, the cheapest over the whole path");
  verb.add_option("--a-limits-deg", options.a_limits_deg, "least,most A for --choose-branches")
      ->check(number_from(-1e6, 1e6))
      ->delimiter(',')
      ->expected(2)
      ->needs("--choose-branches");
  verb.add_option("--c-limits-deg", options.c_limits_deg, "least,most C for --choose-branches")
      ->check(number_from(-1e6, 1e6))
      ->delimiter(',')
      ->expected(2)
      ->needs("--choose-branches");
}

}  // namespace

void add_motion_unreverse(CLI::App& motion, Command& command) {
  CLI::App* verb =
      add_verb(motion, command, "unreverse", "Remove unintended reversals of the rotary axes of a program");
  const auto options = std::make_shared<UnreverseOptions>();
  verb->add_option("PROGRAM", options->program, "G-code with A and C words in degrees")->required();
  verb->add_option("--tolerance-deg", options->tolerance_deg,
                   "Reversals up to this go; no block moves by more, but for turns clear of --surface or --blade")
      ->check(number_from(1e-9, 1e6))
      ->required();
  add_integer(*verb, "--control-points", options->control_points, "Of each piece to begin with", 8, 1'000'000);
  verb->add_option("--shift-deg", options->shift_deg, "Of the published rule, which is shown for comparison")
      ->check(number_from(1e-6, 360))
      ->capture_default_str();
  add_tool_options(*verb, *options);
  add_surrounding_options(*verb, options->around);
  add_output_options(*verb, options->output);
  verb->callback([&command, verb, options] {
    check_surrounding_options(*verb, options->around);
    command.run = [&command, options] { return run_unreverse(*options, command.json); };
  });
}

}  // namespace gravure::cli
