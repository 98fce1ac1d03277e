#pragma once

#include <string>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/twin/verify_path.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// A and C of kPathAxes, not the others.
bool axis_turns(std::size_t axis);

/// What `verify` does with a program that follows a path; `violations` and `notes` are what is known of it already.
Result<int> verify_path_program(LineSource& program, const VerifyPathOptions& options,
                                const std::vector<std::string>& violations, const std::vector<std::string>& notes,
                                const Command& command);

/// What `unroll` does with a picture on a surface: every pulse that fired, put on the workpiece and projected back
/// along z, into a page of the picture's size.
Result<int> unroll_path_program(LineSource& program, const BilevelTiffPage& page, const std::string& output,
                                const Command& command);

/// What `inspect` says of one, after name and mode.
std::string path_text(const Plan& plan);

}  // namespace gravure::cli
