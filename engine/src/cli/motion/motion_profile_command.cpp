#include <fmt/format.h>

#include <memory>

#include "gravure/motion/synchronise.hpp"
#include "motion/motion_command.hpp"
#include "motion/motion_options.hpp"

namespace gravure::cli {
namespace {

using motion::Profile;

constexpr const char* kAxisForm = "stroke_mm,v_max,a_up,jerk_up[,a_down,jerk_down[,start_velocity,end_velocity]]";

struct ProfileOptions {
  MoveOptions move;
  std::vector<std::string> axes;
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

Result<int> run_one_axis(const ProfileOptions& options, bool json) {
  GRAVURE_TRY(const Profile profile, plan_to_target(options));
  std::string csv;
  if (!options.output.csv.empty()) {
    GRAVURE_TRY(const auto samples, motion::sample_profile(profile, options.move.update_us));
    csv = formats::samples_to_csv(samples);
  }
  GRAVURE_CHECK(write_outputs(options.output, csv, "Motion profile", "ms", profile_curves(profile)));
  print(json ? formats::profile_to_json(profile) : profile_text(profile));
  return kDone;
}

Result<motion::JerkRequest> axis_of(const std::string& text) {
  GRAVURE_TRY(const std::vector<double> n, numbers_of("--axis", text, kAxisForm));
  if (n.size() != 4 && n.size() != 6 && n.size() != 8) {
    return Error{ErrorCode::bad_argument, fmt::format("--axis {}: must be {}", text.substr(0, 80), kAxisForm)};
  }
  const bool down = n.size() > 4;
  const bool moving = n.size() > 6;
  return motion::JerkRequest{
      {n[0], n[1], n[2], down ? n[4] : n[2], moving ? n[6] : 0, moving ? n[7] : 0}, n[3], down ? n[5] : n[3]};
}

/// All axes end together; the slowest decides.
Result<int> run_axes(const ProfileOptions& options, bool json) {
  std::vector<motion::JerkRequest> requests;
  for (const std::string& text : options.axes) {
    GRAVURE_TRY(const motion::JerkRequest request, axis_of(text));
    requests.push_back(request);
  }
  GRAVURE_TRY(const motion::SynchronisedMove move, motion::synchronise(requests));
  std::vector<std::vector<motion::Sample>> samples;
  std::string text = fmt::format("{} axes end together; axis {} is the slowest\n", move.axes.size(), move.slowest_axis);
  std::vector<formats::Curve> curves;
  for (std::size_t axis = 0; axis < move.axes.size(); ++axis) {
    const Profile& profile = move.axes[axis];
    text += fmt::format("axis {}\n{}", axis, profile_text(profile));
    if (!options.output.csv.empty()) {
      GRAVURE_TRY(auto of_axis, motion::sample_profile(profile, options.move.update_us));
      samples.push_back(std::move(of_axis));
    }
    for (formats::Curve& curve : profile_curves(profile)) {
      curve.name = fmt::format("axis {} {}", axis, curve.name);
      curves.push_back(std::move(curve));
    }
  }
  const std::string csv = formats::samples_to_csv(samples);
  GRAVURE_CHECK(write_outputs(options.output, csv, "Axes that end together", "ms", curves));
  print(json ? formats::synchronised_to_json(move) : text);
  return kDone;
}

}  // namespace

std::vector<formats::Curve> profile_curves(const Profile& profile) {
  constexpr int kPoints = 1000;
  std::vector<formats::Curve> curves{
      {"position mm", {}, {}}, {"velocity mm/s", {}, {}}, {"acceleration mm/s^2", {}, {}}};
  for (int i = 0; i <= kPoints; ++i) {
    const double time_s = profile.access_time_s() * i / kPoints;
    const motion::State state = profile.at(time_s);
    const double values[] = {state.position_mm, state.velocity_mm_s, state.acceleration_mm_s2};
    for (std::size_t c = 0; c < curves.size(); ++c) {
      curves[c].x.push_back(time_s * 1e3);
      curves[c].y.push_back(values[c]);
    }
  }
  return curves;
}

void add_motion_profile(CLI::App& motion, Command& command) {
  CLI::App* verb = add_verb(motion, command, "profile", "Plan a jerk-limited move, or several that end together");
  const auto options = std::make_shared<ProfileOptions>();
  add_move_options(*verb, options->move, false);
  add_number(*verb, "--target-velocity", options->target_velocity,
             "The target moves at this velocity in mm/s; the stroke is its distance at the start");
  auto* axis = verb->add_option("--axis", options->axes, std::string(kAxisForm) + "; once for each axis");
  axis->allow_extra_args(false);
  for (const char* name : {"--stroke-mm", "--v-max", "--a-up", "--a-down", "--s-factor", "--jerk-up", "--jerk-down",
                           "--start-velocity", "--end-velocity", "--target-velocity"}) {
    axis->excludes(name);
  }
  add_output_options(*verb, options->output);
  verb->callback([&command, verb, options] {
    for (const char* name : {"--stroke-mm", "--v-max", "--a-up"}) {
      if (options->axes.empty() && verb->count(name) == 0) {
        throw CLI::RequiredError(std::string(name) + " (or --axis)");
      }
    }
    command.run = [&command, options]() -> Result<int> {
      GRAVURE_CHECK(check_outputs(options->output, {}));
      return options->axes.empty() ? run_one_axis(*options, command.json) : run_axes(*options, command.json);
    };
  });
}

}  // namespace gravure::cli
