#pragma once

#include <optional>
#include <string_view>

#include "gravure/core/job.hpp"
#include "gravure/formats/toml/document.hpp"
#include "gravure/formats/toml/violations.hpp"

namespace gravure::job_file {

using namespace toml_file;

/// What one key says about another: which exclude or need each other, whose values contradict. Keys count as given
/// where they stand in the file, even with a wrong value; values are compared where both passed their own checks and
/// so are in `job`.
/// `mode` is none where the file does not give one that can be run.
void check_rules(const Document& document, const Job& job, std::optional<Mode> mode, Violations& violations);

/// Keys that a section needs beyond its required ones, for the message when the whole section is missing.
std::string_view choices_of(std::string_view section);

}  // namespace gravure::job_file
