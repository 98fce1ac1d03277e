#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/twin/verify_path.hpp"
#include "verb.hpp"

// Jobs of mode "freeform", as `plan`, `compile` and `verify` take them.

namespace gravure::cli {

/// Is the file a freeform job, as far as can be told?
bool is_freeform_job(const std::string& path);

/// `plan JOB`.
Result<int> plan_freeform_job(const std::string& path, const Command& command);

/// What a compilation writes.
struct FreeformOutputs {
  std::string program;
  std::string points;  ///< CSV of every point; empty: none
  GrvOptions grv;
};
/// `compile JOB` and `texture compile`, which says what a job would.
Result<int> compile_freeform_job(const FreeformJob& job, const FreeformOutputs& outputs, const Command& command);

/// Judges a program that follows a path, as `verify` does: by what the freeform job that it was made from asks for,
/// where its sources are at hand, at the job's paths or below `folder`. `landed` is told of every pulse.
Result<PathReport> judge_path_file(LineSource& program, const std::string& path, const std::string& folder,
                                   const std::function<Result<void>(const LandedPulse&)>& landed = {});

}  // namespace gravure::cli
