#include "program/program_verification.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/formats/plan_json.hpp"
#include "gravure/pipeline/window_reader.hpp"
#include "gravure/sync/make_plan.hpp"
#include "gravure/twin/unroll.hpp"
#include "job/job_loader.hpp"
#include "program/program_files.hpp"

namespace gravure::cli {
namespace {

/// The first revolution that does not expose the layer its job asks for.
std::optional<std::int64_t> wrong_layer(const ProgramHeader& header, LayerOrder order) {
  StoredLayers stored(header.plan, order, image_layers(header));
  for (std::int64_t r = 0; r < header.plan.job.revolutions; ++r) {
    if (stored.number(r) != header.layer_of_revolution[static_cast<std::size_t>(r)]) {
      return r;
    }
  }
  return std::nullopt;
}

/// What a job names other files for stands in the program as it was compiled: the head of a machine file, a field grid.
Job with_files_of(const Plan& plan, Job job) {
  if (!plan.scanner) {
    return job;
  }
  const ScannerPlan& compiled = *plan.scanner;
  if (job.machine.file) {
    job.scanner.field_mm = compiled.field_mm;
    job.scanner.resolution_bits = compiled.resolution_bits;
    job.scanner.lag_us = compiled.lag_us;
    job.scanner.max_speed_mm_s = compiled.max_speed_mm_s;
    job.scanner.max_acceleration_mm_s2 = compiled.max_acceleration_mm_s2;
    job.scanner.max_jerk_mm_s3 = compiled.max_jerk_mm_s3;
    job.scanner.tilt_deg_per_mm = compiled.tilt_deg_per_mm;
  }
  if (job.scanner.field_grid) {
    job.scanner.field_grid_text = compiled.field_grid;
  }
  return job;
}

/// Ramps that a job asks for by its machine file.
void keep_ramps(const Plan& plan, Plan& again) {
  if (!again.spin) {
    again.spin = plan.spin;
  }
  if (again.carriage && plan.carriage && !again.carriage->spin) {
    again.carriage->spin = plan.carriage->spin;
  }
}

/// The job text in a program must lead to the very plan, and the order of layers, that stand in it.
Result<std::optional<std::string>> plan_contradiction(const ProgramHeader& header, const Job& job) {
  const std::int64_t exposures =
      header.plan.carriage ? header.plan.carriage->layers : revolutions_per_band(header.plan);
  GRAVURE_TRY(Plan again, make_plan(with_files_of(header.plan, job), image_columns(header.plan), exposures));
  again.warnings = header.plan.warnings;  // those about images are not made here
  if (job.machine.file) {                 // the limits of the axes stand there, and the program keeps the ramps alone
    keep_ramps(header.plan, again);
  }
  if (plan_to_json(again) == plan_to_json(header.plan)) {
    const std::optional<std::int64_t> wrong = wrong_layer(header, job.image.order);
    return wrong ? std::optional(
                       fmt::format("revolution {} exposes another layer than its job asks for: compile again", *wrong))
                 : std::nullopt;
  }
  return std::optional<std::string>(
      fmt::format("the program's plan is not the one its job leads to: increment {} every {} ticks in the program, {} "
                  "every {} by the job: compile again",
                  header.plan.ab.increment, header.plan.ab.prescaler, again.ab.increment, again.ab.prescaler));
}

/// Says of differing images whether the files are the ones that were compiled.
void note_changed_sources(const ProgramHeader& header, const std::vector<std::string>& paths, VerifyReport& report) {
  std::set<std::string> seen;
  for (std::size_t source = 0; source < header.sources.size(); ++source) {
    if (!seen.insert(paths[source]).second) {
      continue;
    }
    const Result<std::string> now = sha256_file(paths[source]);
    if (now && now.value() != header.sources[source].sha256) {  // one that is not there is a violation of its own
      report.notes.push_back(paths[source] + " is not the file that was compiled (other SHA-256)");
    }
  }
}

/// Says of the files that the job names beside its images whether they are there, and the ones that the program was
/// compiled with.
void judge_files(const ProgramHeader& header, const std::string& path, const std::string& images,
                 VerifyReport& report) {
  for (const SourceImage& file : header.files) {
    std::string place = images.empty() ? std::string() : locate_source(file, header, path, images);
    if (place.empty()) {
      place = locate_source(file, header, path, {});
    }
    const auto unproved = [&report](const std::string& why) {
      report.notes.push_back(why + ": what the file said is taken from the program");
      report.violations.push_back(why +
                                  ", so nothing proves that the program does what its job says: give --images DIR");
    };
    if (place.empty()) {
      unproved(file.path + " was not found");
      continue;
    }
    const Result<std::string> now = sha256_file(place);
    if (!now) {
      unproved(now.error().message);
    } else if (now.value() != file.sha256) {
      report.notes.push_back(
          place + " is not the file that was compiled (other SHA-256): what it says now is not in the program");
    }
  }
}

}  // namespace

Result<VerifiedProgram> verify_program_file(GrvProgram program, const std::string& path, const std::string& images,
                                            const Command& command) {
  const ProgramHeader& header = program.header();
  const ImageFiles files;
  GRAVURE_TRY(const FoundImages found, find_images(header, path, images, files));
  GRAVURE_TRY(Job job, parse_job(header.job_text, header.job_path));
  GRAVURE_TRY(const std::optional<std::string> contradiction, plan_contradiction(header, job));
  LayerLinesFactory readers;
  const std::int64_t panel = command.memory_bytes() / 4;
  if (found.stack) {
    readers = [&]() -> Result<std::unique_ptr<LayerLines>> {
      return make_layer_lines(header, *found.stack, files, panel);
    };
  }
  Result<VerifyReport> verified = [&] {
    ProgressBar bar("verify");
    VerifyOptions verify_options;
    verify_options.memory_bytes = command.memory_bytes();
    verify_options.table_bytes = program.table_bytes();
    verify_options.threads = command.threads;
    verify_options.cancel = &cancel_token();
    verify_options.progress = &bar;
    verify_options.budget = BudgetOptions{job.twin, job.limits.landing_um, job.limits.defocus_um};
    const auto programs = [&program]() -> Result<std::unique_ptr<LineSource>> { return program.reader(); };
    return verify(programs, emulated_devices(), readers, verify_options);
  }();
  GRAVURE_TRY(VerifyReport report, std::move(verified));
  if (contradiction) {
    report.violations.push_back(*contradiction);
  }
  for (const std::string& missing : found.stack ? std::vector<std::string>() : found.missing) {
    report.notes.push_back("image not found: " + missing);
  }
  if (found.stack && (report.wrong_pixels > 0 || report.uncompared_lines > 0)) {
    note_changed_sources(header, found.paths, report);
  }
  judge_files(header, path, images, report);
  if (report.ab_step_um > report.seam_limit_um) {
    report.notes.push_back(
        fmt::format("one A-B edge ({:.3f} um) is coarser than limits.seam_um: within an edge the "
                    "drive's own interpolation decides",
                    report.ab_step_um));
  }
  return VerifiedProgram{std::move(program), std::move(job), std::move(report)};
}

}  // namespace gravure::cli
