#include <fmt/format.h>

#include <memory>

#include "gravure/core/file_output.hpp"
#include "gravure/motion/identify.hpp"
#include "motion/motion_command.hpp"
#include "motion/motion_options.hpp"

namespace gravure::cli {
namespace {

struct IdentifyOptions {
  std::string recording;
  bool step = false;
  double start_s = 0;
  std::uint32_t modes = 0;
  MoveOptions move;  ///< what excited a run-down; a stroke of 0 for unknown
  OutputOptions output;
};

std::string identification_text(const motion::Identification& found) {
  std::string text =
      fmt::format("{:>12} {:>10} {:>12} {:>12} {:>14} {:>10} {:>14}\n", "f Hz", "+-", "zeta", "+-",
                  found.participation_is_absolute ? "participation" : "amplitude", "+-", "resolution Hz");
  for (const motion::IdentifiedMode& mode : found.modes) {
    text += fmt::format("{:>12.5f} {:>10.2g} {:>12.6f} {:>12.2g} {:>14.5f} {:>10.2g} {:>14.3g}\n", mode.mode.f_hz,
                        mode.f_sd_hz, mode.mode.zeta, mode.zeta_sd, mode.mode.participation, mode.participation_sd,
                        mode.resolution_hz);
  }
  return text +
         fmt::format(
             "noise {:.4g} mm/s^2, offset {:.6g} mm/s^2, {} samples in {:.4g} s (1/T = {:.3g} Hz); what vibrates "
             "above {:.6g} Hz appears below, folded\n",
             found.noise_sd_mm_s2, found.offset_mm_s2, found.samples, found.record_s, 1 / found.record_s,
             found.sample_hz / 2);
}

std::string identification_csv(const motion::Identification& found) {
  std::string csv = "f_hz,f_sd_hz,zeta,zeta_sd,participation,participation_sd,resolution_hz\n";
  for (const motion::IdentifiedMode& m : found.modes) {
    csv += fmt::format("{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", m.mode.f_hz, m.f_sd_hz, m.mode.zeta,
                       m.zeta_sd, m.mode.participation, m.participation_sd, m.resolution_hz);
  }
  return csv;
}

Result<int> run_identify(const IdentifyOptions& options, bool json) {
  GRAVURE_CHECK(check_outputs(options.output, {options.recording}));
  GRAVURE_TRY(const std::string text, read_file(options.recording, kMostMotionBytes));
  motion::IdentifyRequest request;
  auto recording = motion::parse_recording_csv(text);
  if (!recording) {
    return Error{recording.error().code, options.recording + ": " + recording.error().message};
  }
  request.recording = std::move(recording).value();
  request.of = options.step ? motion::RecordingOf::step : motion::RecordingOf::run_down;
  request.start_s = options.start_s;
  request.modes = options.modes;
  if (options.move.stroke_mm != 0) {
    GRAVURE_TRY(const motion::Profile profile, plan_move(options.move));
    request.input = motion::input_of(profile);
  }
  const formats::Curve curve{"acceleration mm/s^2", request.recording.time_s, request.recording.acceleration_mm_s2};
  const auto found = motion::identify(request);
  if (!found) {
    return Error{found.error().code, options.recording + ": " + found.error().message};
  }
  for (const std::string& warning : found.value().warnings) {
    warn(warning);
  }
  GRAVURE_CHECK(write_outputs(options.output, identification_csv(found.value()), "Recording", "s", {curve}));
  print(json ? formats::identification_to_json(found.value()) : identification_text(found.value()));
  return kDone;
}

}  // namespace

void add_motion_identify(CLI::App& motion, Command& command) {
  CLI::App* verb = add_verb(motion, command, "identify", "Modes from a recording of acceleration over time");
  const auto options = std::make_shared<IdentifyOptions>();
  verb->add_option("RECORDING", options->recording, "CSV: time in s, acceleration in mm/s^2")->required();
  verb->add_flag("--step", options->step,
                 "The axis starts to accelerate evenly at --start-s (else it rings down from there)");
  add_number(*verb, "--start-s", options->start_s, "Samples before are not used")->capture_default_str();
  add_integer(*verb, "--modes", options->modes, "How many; 0 lets the data choose", 0, 4);
  add_move_options(*verb, options->move, false);
  add_output_options(*verb, options->output);
  verb->callback(
      [&command, options] { command.run = [&command, options] { return run_identify(*options, command.json); }; });
}

}  // namespace gravure::cli
