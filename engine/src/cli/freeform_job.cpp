#include "freeform_job.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "freeform_program.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/plan_json.hpp"
#include "path_program.hpp"
#include "plan_text.hpp"
#include "program_files.hpp"

namespace gravure::cli {
namespace {

/// What a program can be held against beside itself.
struct Evidence {
  std::optional<WantedTexture> wanted;
  std::vector<std::string> notes;
  std::vector<std::string> violations;
};

/// Puts each file of the job where it lies now; says of those that are not there or not the same.
bool find_files(const ProgramHeader& header, const std::string& path, const std::string& folder,
                TextureSettings& settings, Evidence& evidence) {
  bool all = true;
  const std::vector<std::string*> names = files_of(settings);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_known = i < header.sources.size() && header.sources[i].path == *names[i];
    const std::string place = is_known ? locate_source(header.sources[i], header, path, folder) : "";
    if (place.empty()) {
      evidence.notes.push_back(*names[i] + " not found: points and limits are those that the program stores");
      all = false;
      continue;
    }
    const Result<std::string> hash = sha256_file(place);
    if (hash && hash.value() != header.sources[i].sha256) {
      evidence.notes.push_back(place + " is not the file that was compiled (other SHA-256)");
    }
    *names[i] = place;
  }
  settings.folder.clear();
  return all;
}

/// Says of a program of zones whether what it was made of is still there and the same.
Evidence evidence_of_zones(const ProgramHeader& header, const std::string& path, const std::string& folder) {
  Evidence evidence;
  for (const SourceImage& source : header.sources) {
    const std::string place = locate_source(source, header, path, folder);
    const Result<std::string> hash = place.empty() ? Result<std::string>(std::string()) : sha256_file(place);
    if (place.empty()) {
      evidence.notes.push_back(source.path + " not found");
    } else if (hash && hash.value() != source.sha256) {
      evidence.notes.push_back(place + " is not the file that was compiled (other SHA-256)");
    }
  }
  evidence.notes.emplace_back("contours are not laid out anew: points and limits are those that the program stores");
  return evidence;
}

/// The job text in a program must lead to the very plan that stands in it.
void hold_plan(const FreeformJob& job, const ProgramHeader& header, Evidence& evidence) {
  const Result<Plan> again = plan_of(job, *evidence.wanted, set_points_of(header.plan));
  if (!again || plan_to_json(again.value()) != plan_to_json(header.plan)) {
    evidence.violations.push_back("the program's plan is not the one its job leads to: compile again");
  }
}

Result<Evidence> evidence_of(const ProgramHeader& header, const std::string& path, const std::string& folder) {
  if (header.plan.mode == Mode::zones) {
    return evidence_of_zones(header, path, folder);
  }
  Evidence evidence;
  if (header.job_text.empty() || header.plan.mode != Mode::freeform) {
    return evidence;
  }
  GRAVURE_TRY(FreeformJob job, parse_freeform_job(header.job_text, header.job_path));
  const FreeformJob as_given = job;
  if (!find_files(header, path, folder, job.texture, evidence)) {
    return evidence;
  }
  Result<WantedTexture> wanted = wanted_of(job);
  if (!wanted && wanted.error().code == ErrorCode::cancelled) {
    return wanted.error();
  }
  if (!wanted) {
    evidence.violations.push_back("the job cannot be made anew: " + wanted.error().message);
    return evidence;
  }
  evidence.wanted = std::move(wanted).value();
  if (evidence.wanted->pulses.count != header.plan.path->pulses) {
    evidence.violations.push_back(fmt::format("the job's files lead to {} pulses, the program has {}: compile again",
                                              evidence.wanted->pulses.count, header.plan.path->pulses));
    evidence.wanted.reset();
    return evidence;
  }
  hold_plan(as_given, header, evidence);
  return evidence;
}

/// verify would not pass it.
void refuse_texture(const FreeformJob& job, const TextureOutcome& outcome, const Command& command) {
  if (command.json) {
    Json json = outcome_json(job, outcome);
    json["program"] = nullptr;
    print_json(json);
    return;
  }
  print(violations_text(outcome.violations) +
        "NOT within limits, nothing was written: give a smaller sigma, slower axes or wider limits\n");
}

Json compiled_json(const FreeformJob& job, const PlannedTexture& planned, const std::string& output,
                   const CompiledPath& made) {
  const PathSpacing& spacing = made.spacing;
  Json json = outcome_json(job, planned.outcome);
  json["program"] = output;
  json["periods"] = made.header.plan.rotary.lines_per_revolution;
  json["proofs"] = planned.outcome.seven.proven.proofs;
  json.update(spacing_json(spacing));
  json["least_slots"] = spacing.least_slots;
  return json;
}

}  // namespace

bool is_freeform_job(const std::string& path) {
  return mode_of_job(path) == Mode::freeform;
}

Result<int> plan_freeform_job(const std::string& path, const Command& command) {
  GRAVURE_TRY(const FreeformJob job, read_freeform_job(path));
  GRAVURE_TRY(const PlannedTexture planned, plan_texture(job, Depth::choice, command));
  const TextureOutcome& outcome = planned.outcome;
  if (command.json) {
    Json json = Json::parse(plan_to_json(planned.plan));
    json["texture"] = outcome_json(job, outcome);
    json["texture"].erase("violations");
    json["violations"] = outcome.violations;
    print_json(json);
  } else {
    print(plan_text(planned.plan) + outcome_text(job, outcome));
  }
  return outcome.violations.empty() ? kDone : kLimitViolated;
}

Result<int> compile_freeform_job(const FreeformJob& job, const FreeformOutputs& outputs, const Command& command) {
  GRAVURE_TRY(const PlannedTexture planned, plan_texture(job, Depth::times, command));
  if (!planned.outcome.violations.empty()) {
    refuse_texture(job, planned.outcome, command);
    return kLimitViolated;
  }
  GRAVURE_TRY(const CompiledPath made, compile_texture(job, planned, outputs.program, outputs.grv));
  if (!outputs.points.empty()) {
    const texture::TimedSplit& timed = planned.outcome.seven.timed;
    GRAVURE_CHECK(write_points(outputs.points, timed.split, timed.axes, job.split.focus_axis));
  }
  if (command.json) {
    print_json(compiled_json(job, planned, outputs.program, made));
    return kDone;
  }
  const PathSpacing& spacing = made.spacing;
  const Plan& plan = made.header.plan;
  print(fmt::format("{}: {:.3f} s in {} periods of {} us; {} of {} pulses fire\nspacing: {}\n", outputs.program,
                    to_double(plan.job.duration_s), plan.rotary.lines_per_revolution, job.motion.servo_us,
                    spacing.fired, spacing.pulses, spacing_text(spacing)));
  return kDone;
}

Result<PathReport> judge_path_file(LineSource& program, const std::string& path, const std::string& folder,
                                   const std::function<Result<void>(const LandedPulse&)>& landed) {
  GRAVURE_TRY(const Evidence evidence, evidence_of(program.header(), path, folder));
  VerifyPathOptions options;
  options.landed = landed;
  if (evidence.wanted) {
    options.wanted = &evidence.wanted->pulses;
    options.targets = evidence.wanted->targets;
  }
  return judge_path_program(program, options, evidence.violations, evidence.notes);
}

Result<int> verify_path_file(const std::string& path, const std::string& folder, const Command& command) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(path));
  GRAVURE_TRY(const PathReport report, judge_path_file(*program, path, folder));
  return print_path_report(report, command);
}

}  // namespace gravure::cli
