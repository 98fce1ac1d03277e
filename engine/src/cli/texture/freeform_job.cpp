#include "texture/freeform_job.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "gravure/formats/plan_json.hpp"
#include "job/plan_text.hpp"
#include "program/path_evidence.hpp"
#include "program/path_program.hpp"
#include "texture/freeform_program.hpp"

namespace gravure::cli {
namespace {

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
  const texture::TimedSplit& timed = planned.outcome.seven.timed;
  GRAVURE_TRY(std::optional<TextOutput> points,
              stage_points(outputs.points, timed.split, timed.axes, job.split.focus_axis));
  GRAVURE_TRY(const CompiledPath made, compile_texture(job, planned, outputs.program, outputs.grv));
  if (points) {
    GRAVURE_CHECK(points->commit());
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
  GRAVURE_TRY(const PathEvidence evidence, evidence_of(program, path, folder));
  VerifyPathOptions options;
  options.landed = landed;
  if (evidence.wanted) {
    options.wanted = &evidence.wanted->pulses;
    options.targets = evidence.wanted->targets;
  }
  return judge_path_program(program, options, evidence.violations, evidence.notes);
}

}  // namespace gravure::cli
