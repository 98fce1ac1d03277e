#pragma once

#include <string>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/program.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/pipeline/compile_path.hpp"
#include "gravure/twin/verify_path.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// A and C of kPathAxes, not the others.
bool axis_turns(std::size_t axis);

/// The decimal of so many digits that a number was given as, or is nearest to it.
Rational exact_decimal(double value, int digits = 15);

/// pulses, fired_pulses, spacing_um{max, rms}, half_slot_um, max_speed_mm_s of a compiled path; and the same in words.
Json spacing_json(const PathSpacing& spacing);
std::string spacing_text(const PathSpacing& spacing);

/// A pulse every pitch along a path, all of which fire; out_of_range, naming `key`, for none or more than 2^33.
Result<PathPulses> all_pulses(const std::string& key, double pitch_mm, double length_mm);

/// Judges a program that follows a path, with a bar of progress; `violations` and `notes` are what is known of it
/// already and come first.
Result<PathReport> judge_path_program(LineSource& program, const VerifyPathOptions& options,
                                      const std::vector<std::string>& violations,
                                      const std::vector<std::string>& notes);

/// Prints what was found, as `verify` does; the exit status.
int print_path_report(const PathReport& report, const Command& command);

/// What `unroll` does with a picture on a surface: every pulse that fired, put on the workpiece and projected back
/// along z, into a page of the picture's size.
Result<int> unroll_path_program(LineSource& program, const BilevelTiffPage& page, const std::string& output,
                                const Command& command);

/// What `inspect` says of one, after name and mode.
std::string path_text(const Plan& plan);

}  // namespace gravure::cli
