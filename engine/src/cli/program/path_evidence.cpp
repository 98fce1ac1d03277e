#include "program/path_evidence.hpp"

#include <fmt/format.h>

#include <utility>

#include "gravure/formats/image_files.hpp"
#include "gravure/formats/plan_json.hpp"
#include "gravure/pipeline/compare_path.hpp"
#include "program/program_files.hpp"
#include "texture/freeform_program.hpp"
#include "texture/texture_options.hpp"
#include "zones/zones_program.hpp"

namespace gravure::cli {
namespace {

/// Where the files of a program's job lie now; says of those that are not there or not the same.
class SourceSearch {
 public:
  SourceSearch(const ProgramHeader& header, const std::string& path, const std::string& folder, PathEvidence& evidence)
      : header_(header), path_(path), folder_(folder), evidence_(evidence) {}

  /// Of the file that the job calls `name`: where it is; "" where it is not.
  std::string find(const std::string& name) {
    const auto source = std::find_if(header_.sources.begin(), header_.sources.end(),
                                     [&name](const SourceImage& each) { return each.path == name; });
    const std::string place =
        source != header_.sources.end() ? locate_source(*source, header_, path_, folder_) : std::string();
    if (place.empty()) {
      evidence_.notes.push_back(name + " not found: points and limits are those that the program stores");
      evidence_.violations.push_back(
          name + " was not found, so nothing proves that the program does what its job says: give --images DIR");
      found_all_ = false;
      return place;
    }
    const Result<std::string> hash = sha256_file(place);
    if (hash && hash.value() != source->sha256) {
      evidence_.notes.push_back(place + " is not the file that was compiled (other SHA-256)");
    }
    return place;
  }
  bool found_all() const noexcept { return found_all_; }

 private:
  const ProgramHeader& header_;
  const std::string& path_;
  const std::string& folder_;
  PathEvidence& evidence_;
  bool found_all_ = true;
};

void say_not_made(const Error& error, PathEvidence& evidence) {
  evidence.violations.push_back("the job cannot be made anew: " + error.message);
}

/// The job text in a program must lead to the very plan that stands in it.
void hold_plan(const Result<Plan>& again, const ProgramHeader& header, PathEvidence& evidence) {
  if (!again || plan_to_json(again.value()) != plan_to_json(header.plan)) {
    evidence.violations.push_back("the program's plan is not the one its job leads to: compile again");
  }
}

Result<void> hold_freeform(SourceSearch& search, const ProgramHeader& header, PathEvidence& evidence) {
  GRAVURE_TRY(FreeformJob job, parse_freeform_job(header.job_text, header.job_path));
  const FreeformJob as_given = job;
  for (std::string* name : files_of(job.texture)) {
    *name = search.find(*name);
  }
  job.texture.folder.clear();
  if (!search.found_all()) {
    return {};
  }
  Result<WantedTexture> wanted = wanted_of(job);
  if (!wanted && wanted.error().code == ErrorCode::cancelled) {
    return wanted.error();
  }
  if (!wanted) {
    say_not_made(wanted.error(), evidence);
    return {};
  }
  if (wanted.value().pulses.count != header.plan.path->pulses) {
    evidence.violations.push_back(fmt::format("the job's files lead to {} pulses, the program has {}: compile again",
                                              wanted.value().pulses.count, header.plan.path->pulses));
    return {};
  }
  hold_plan(plan_of(as_given, wanted.value(), set_points_of(header.plan)), header, evidence);
  evidence.wanted = PathEvidence::Wanted{std::move(wanted.value().targets), std::move(wanted.value().pulses)};
  return {};
}

Result<ZonesProgram> lay_out_again(const ZonesJob& job, const ZonesFiles& files) {
  GRAVURE_TRY(const LoadedZonesJob loaded, load_zones_job(job, files));
  return lay_out_zones(loaded);
}

Result<void> hold_zones(SourceSearch& search, LineSource& program, PathEvidence& evidence) {
  const ProgramHeader& header = program.header();
  GRAVURE_TRY(const ZonesJob job, parse_zones_job(header.job_text, header.job_path));
  ZonesFiles files;
  for (const auto& [name, place] :
       {std::pair(&job.contours, &files.contours), std::pair(&job.transform, &files.transform),
        std::pair(&job.machine, &files.machine)}) {
    *place = name->empty() ? "" : search.find(*name);
  }
  if (!search.found_all()) {
    return {};
  }
  Result<ZonesProgram> again = lay_out_again(job, files);
  if (!again && again.error().code == ErrorCode::cancelled) {
    return again.error();
  }
  if (!again) {
    say_not_made(again.error(), evidence);
    return {};
  }
  ZonesProgram& made = again.value();
  hold_plan(made.plan, header, evidence);
  ProgressBar bar("compare");
  GRAVURE_TRY(const std::vector<std::string> differences,
              compare_path(program, *made.motion, made.pulses, made.motion->targets(), &cancel_token(), &bar));
  for (const std::string& difference : differences) {
    evidence.violations.push_back(difference + ": compile again");
  }
  if (made.pulses.count == header.plan.path->pulses) {
    evidence.wanted = PathEvidence::Wanted{made.motion->targets(), std::move(made.pulses)};
  }
  return {};
}

}  // namespace

Result<PathEvidence> evidence_of(LineSource& program, const std::string& path, const std::string& folder) {
  const ProgramHeader& header = program.header();
  PathEvidence evidence;
  if (header.job_text.empty()) {
    return evidence;
  }
  SourceSearch search(header, path, folder, evidence);
  if (header.plan.mode == Mode::zones) {
    GRAVURE_CHECK(hold_zones(search, program, evidence));
  } else if (header.plan.mode == Mode::freeform) {
    GRAVURE_CHECK(hold_freeform(search, header, evidence));
  }
  return evidence;
}

}  // namespace gravure::cli
