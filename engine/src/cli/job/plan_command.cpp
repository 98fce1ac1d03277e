#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "gravure/core/exact.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/plan_json.hpp"
#include "job/job_loader.hpp"
#include "job/job_scanner.hpp"
#include "job/plan_text.hpp"
#include "program/path_program.hpp"
#include "program/program_files.hpp"
#include "texture/freeform_job.hpp"
#include "texture/texture_motion.hpp"
#include "verb.hpp"

namespace gravure::cli {

namespace {

const char* order_name(LayerOrder order) {
  return order == LayerOrder::sequence ? "sequence" : order == LayerOrder::cycle ? "cycle" : "hold";
}

std::string number(const Rational& value) {
  return denominator_of(value) == 1 ? to_string(value) : fmt::format("{:.8g}", to_double(value));
}

std::string counter_text(const AbPlan& ab) {
  std::string counter =
      fmt::format("increment {} every {} ticks, {} bits", ab.increment, ab.prescaler, ab.counter_bits);
  if (ab.fraction_num != 0) {
    counter += fmt::format(", fraction {}/{}", ab.fraction_num, ab.fraction_den);
  }
  return fmt::format("{}: {:.6f} Hz, wanted {:.6f} Hz", counter, to_double(ab.output_hz), to_double(ab.wanted_hz));
}

std::string seam_text(const AbPlan& ab, bool flat) {
  if (ab.exact) {
    return fmt::format("drift 0: exact, for ever (limit {} um)", to_decimal_string(ab.seam_limit_um));
  }
  if (!ab.lines_until_limit) {
    return fmt::format("drift {:.6g} um a pass = {} lines, the same in each; limit {} um never reached",
                       to_double(ab.drift_um_per_revolution), to_string(ab.drift_lines_per_revolution),
                       to_decimal_string(ab.seam_limit_um));
  }
  return fmt::format(
      "drift {:.6g} um a {} = {} lines; limit {} um reached after {} {} ({} lines); the published "
      "bound would allow {} lines",
      to_double(ab.drift_um_per_revolution), flat ? "pass" : "revolution", to_string(ab.drift_lines_per_revolution),
      to_decimal_string(ab.seam_limit_um), to_string(*ab.revolutions_until_limit), flat ? "passes" : "revolutions",
      to_string(*ab.lines_until_limit), to_string(ab.bound_lines_until_limit));
}

/// Where the first column of each band lies, from that of the image.
std::string band_places(const BandsPlan& bands) {
  constexpr std::int64_t kShown = 16;
  std::string text;
  for (std::int64_t band = 0; band < std::min(bands.count, kShown); ++band) {
    text += (band == 0 ? "" : ", ") + number(bands.step_mm * Rational(band));
  }
  return text + (bands.count > kShown ? ", ... mm" : " mm") +
         fmt::format(" along the axis; {} mm from one to the next, not in the time of the job", number(bands.step_mm));
}

std::string ramp_text(const SpinPlan& ramp, const char* unit) {
  return fmt::format("{} segments, {} ticks = {:.6f} s, {:.9g} {}, at most {:.6g} {}/s^2, staircase within {:.3g} {}/s",
                     ramp.segments.size(), ramp.ticks, to_double(ramp.duration_s), to_double(ramp.travel), unit,
                     to_double(ramp.max_acceleration), unit, to_double(ramp.speed_error), unit);
}

/// How the images are laid side by side; nothing where they are not.
std::string repeat_text(const LoadedJob& loaded) {
  const RepeatSettings& repeat = loaded.job.repeat;
  if (repeat.around == 1 && repeat.along == 1) {
    return "";
  }
  const bool mirrored = repeat.mirror_around || repeat.mirror_along;
  return fmt::format("{:<10}{} images around, {} along{}{}{}{}, each of {} lines of {} pixels\n", "repeat",
                     repeat.around, repeat.along, mirrored ? ", every other one turned over " : "",
                     repeat.mirror_around ? "around" : "", repeat.mirror_around && repeat.mirror_along ? " and " : "",
                     repeat.mirror_along ? "along" : "", loaded.plan.rotary.lines_per_revolution / repeat.around,
                     loaded.columns / repeat.along);
}

std::string joints_text(const std::vector<scan::JointReach>& joints) {
  std::string text;
  for (const scan::JointReach& joint : joints) {
    const char* unit = joint.kind == kinematics::JointKind::revolute ? "deg" : "mm";
    text += text.empty() ? fmt::format("{:<10}", "joints") : ", ";
    text += joint.least == joint.most
                ? fmt::format("{} at {:.9g} {}", joint.joint, joint.least, unit)
                : fmt::format("{} from {:.9g} to {:.9g} {}", joint.joint, joint.least, joint.most, unit);
  }
  return text.empty() ? text : text + "\n";
}

/// Keyed as the machine file is.
Json joints_json(const std::vector<scan::JointReach>& joints) {
  Json json = Json::object();
  const auto figure = [](const std::optional<double>& value) {
    return value ? Json(rounded(*value, 9)) : Json(nullptr);
  };
  for (const scan::JointReach& joint : joints) {
    const std::string unit = joint.kind == kinematics::JointKind::revolute ? "_deg" : "_mm";
    json[joint.joint] = {{"from" + unit, figure(joint.least)},
                         {"to" + unit, figure(joint.most)},
                         {"least" + unit, figure(joint.least_allowed)},
                         {"most" + unit, figure(joint.most_allowed)}};
  }
  return json;
}

}  // namespace

std::string plan_text(const Plan& plan) {
  std::string text;
  const auto row = [&](const char* name, const std::string& value) { text += fmt::format("{:<10}{}\n", name, value); };
  const bool flat = plan.mode == Mode::flat;
  row("job", fmt::format("{} ({}), {} {}, {} ticks = {:.3f} s", plan.title, mode_name(plan.mode), plan.job.revolutions,
                         turns_name(plan), plan.job.ticks, to_double(plan.job.duration_s)));
  row("clock", fmt::format("seed {} Hz, FPGA {} Hz, pulses {} Hz (every seed pulse no. {}), {} ticks a slot",
                           plan.clock.seed_hz, plan.clock.fpga_hz, number(plan.clock.pulse_hz),
                           plan.clock.pulse_divider, plan.clock.ticks_per_slot));
  if (plan.path) {
    return text + path_text(plan);
  }
  row("line", fmt::format("{} pixels in {} slots = {} ticks, {} ticks a microvector, {} lines/s, scan speed {} m/s",
                          plan.line.pixels, plan.line.slots, plan.line.ticks,
                          plan.line.slots_per_microvector * plan.clock.ticks_per_slot, number(plan.line.rate_hz),
                          number(plan.line.scan_speed_m_s)));
  row("window", fmt::format("first slot {} forward, {} reverse{}", plan.line.forward_first_slot,
                            plan.line.reverse_first_slot, plan.line.bidirectional ? "" : " (unused: one direction)"));
  if (plan.bands) {
    row("bands", fmt::format("{} of {} pixels for {} columns, {} {} each", plan.bands->count, plan.line.pixels,
                             plan.bands->columns, plan.bands->revolutions_per_band, turns_name(plan)));
    row("at", band_places(*plan.bands));
  }
  const std::string pitch = fmt::format("pitch {} um ({:.1f} DPI)", number(plan.rotary.line_pitch_um),
                                        25400.0 / to_double(plan.rotary.line_pitch_um));
  if (flat) {
    row("stage", fmt::format("{} lines a pass, {}, {} ticks a pass, {} mm/s", plan.rotary.lines_per_revolution, pitch,
                             plan.rotary.ticks_per_revolution, number(plan.rotary.surface_speed_mm_s)));
  } else {
    row("rotary", fmt::format("{} lines a revolution, {}, {} ticks a revolution, {} rpm, surface {} mm/s",
                              plan.rotary.lines_per_revolution, pitch, plan.rotary.ticks_per_revolution,
                              number(plan.rotary.rpm), number(plan.rotary.surface_speed_mm_s)));
  }
  row("A-B", counter_text(plan.ab));
  row("seam", seam_text(plan.ab, flat));
  const auto spin_rows = [&](const AxisSpin& spin, const char* unit, bool turns) {
    row("spin-up", ramp_text(spin.up, unit));
    if (turns) {
      row("start", fmt::format("line 0 at {} deg from the encoder index, where the axis stands before, {:+.3g} deg",
                               number(spin.start_deg), to_double(spin.start_error_deg)));
    }
    row("spin-down", ramp_text(spin.down, unit));
    if (turns || flat) {
      row("in all", fmt::format("{:.3f} s with {}{}", to_double(spin.total_s),
                                flat ? "a spin-up and a spin-down each pass" : "spin-up and spin-down",
                                plan.bands ? ", but without the moves from band to band" : ""));
    }
  };
  if (plan.spin) {
    spin_rows(*plan.spin, flat ? "mm" : "deg", !flat);
  }
  if (plan.carriage) {
    const CarriagePlan& carriage = *plan.carriage;
    row("carriage", fmt::format("{} columns = {} um a revolution, {} layers in windows of {} columns, {} columns, {} "
                                "mm/s, {} mm in all",
                                to_decimal_string(carriage.feed_pixels), number(carriage.feed_um), carriage.layers,
                                carriage.window_columns, carriage.columns, number(carriage.speed_mm_s),
                                number(carriage.travel_mm)));
    row("A-B 1", counter_text(carriage.ab));
    row("drift", seam_text(carriage.ab, flat));
    if (carriage.spin) {
      spin_rows(*carriage.spin, "mm", false);
    }
  }
  return text;
}

void add_plan(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "plan", "Clock tree, line, A-B solution, drift and time of a job");
  const auto path = std::make_shared<std::string>();
  verb->add_option("JOB", *path, "Job file")->required();
  add_texture_memory(*verb, command);
  verb->callback([&command, path] {
    command.run = [&command, path]() -> Result<int> {
      if (is_freeform_job(*path)) {
        return plan_freeform_job(*path, command);
      }
      const ImageFiles files;
      GRAVURE_TRY(const LoadedJob loaded, load_job(*path, files, false));
      const ImageSettings& image = loaded.job.image;
      if (command.json) {
        Json plan = Json::parse(plan_to_json(loaded.plan));
        plan["line"]["ticks_per_microvector"] =
            loaded.plan.line.slots_per_microvector * loaded.plan.clock.ticks_per_slot;
        if (plan.contains("scanner")) {
          plan["scanner"]["trajectory"] =
              loaded.trajectory ? trajectory_json(loaded.trajectory->of_revolution(0)) : Json(nullptr);
        }
        if (const std::optional<BandsPlan>& bands = loaded.plan.bands) {
          Json places = Json::array();
          for (std::int64_t band = 0; band < bands->count; ++band) {
            places.push_back(to_double(Rational(bands->step_mm * Rational(band))));
          }
          plan["bands"]["position_mm"] = places;
        }
        if (!loaded.joints.empty()) {
          plan["joints"] = joints_json(loaded.joints);
        }
        plan["image"] = {{"fires", polarity_name(image.fires)},
                         {"lines_along", image.lines_along == LinesAlong::rows ? "rows" : "columns"},
                         {"order", order_name(image.order)}};
        if (const RepeatSettings& repeat = loaded.job.repeat; repeat.around > 1 || repeat.along > 1) {
          plan["image"]["repeat"] = {{"around", repeat.around},
                                     {"along", repeat.along},
                                     {"mirror_around", repeat.mirror_around},
                                     {"mirror_along", repeat.mirror_along}};
        }
        print_json(plan);
      } else {
        print(plan_text(loaded.plan));
        if (loaded.trajectory) {
          print(trajectory_text(loaded.trajectory->of_revolution(0)));
        }
        print(joints_text(loaded.joints));
        print(fmt::format("{:<10}{} fires, lines along {}, layers in order \"{}\"\n", "image",
                          polarity_name(image.fires), image.lines_along == LinesAlong::rows ? "rows" : "columns",
                          order_name(image.order)));
        print(repeat_text(loaded));
      }
      warn_of(loaded);
      return kDone;
    };
  });
}

}  // namespace gravure::cli
