#pragma once

#include <string>

#include "gravure/core/job.hpp"
#include "gravure/core/program.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/twin/verify.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// A program, the job it carries, and what its verification found.
struct VerifiedProgram {
  GrvProgram program;
  Job job;
  VerifyReport report;
};

/// Runs the whole program on the emulated board and judges it, with a progress bar: what `verify` and `report` do.
/// Images are sought at the job's paths, or below `images`.
Result<VerifiedProgram> verify_program_file(GrvProgram program, const std::string& path, const std::string& images,
                                            const Command& command);

}  // namespace gravure::cli
