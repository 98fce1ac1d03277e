#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/formats/grv.hpp"
#include "job/job_loader.hpp"

namespace gravure::cli {

/// Writes the program at `path` to `output` with layers that show the same picture stored once, and returns its header.
/// Where no two do, nothing is written and nothing returned.
Result<std::optional<ProgramHeader>> write_shared(const std::string& path, const std::string& output,
                                                  const GrvOptions& grv);

/// The header of the output of `request` where it is there already, whole, and what compiling to `wanted` would make:
/// the same job, images and storage, equal layers stored once, and every checksum holds. Nothing where it is to be
/// compiled.
Result<std::optional<ProgramHeader>> finished_output(const ProgramHeader& wanted, const CompileRequest& request,
                                                     const CancelToken& cancel);

/// Merges shards, in any order, to the whole program `output`.
Result<ProgramHeader> merge_shards(const std::vector<std::string>& shards, const std::string& output);

}  // namespace gravure::cli
