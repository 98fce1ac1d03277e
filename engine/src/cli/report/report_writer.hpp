#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gravure/twin/verify_path.hpp"
#include "program/program_verification.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// What a report page is made from.
struct ReportRequest {
  std::string program;  ///< file
  std::string name;     ///< what the page calls it
  std::string output;
  std::int64_t revolution = 0;       ///< of the line whose timing is shown
  std::optional<std::int64_t> line;  ///< none: the first of that revolution that fires
};

struct WrittenReport {
  std::int64_t bytes = 0;
  std::int64_t line = 0;
  std::int64_t shown_layers = 0;
  bool view_3d = false;
};

struct WrittenPathReport {
  PathReport verified;
  std::int64_t bytes = 0;
};
/// Judges a program that follows a path, its job's files sought below `folder` too, and writes its page.
Result<WrittenPathReport> write_path_report(const ReportRequest& request, LineSource& program,
                                            const std::string& folder);

/// Fails with bad_argument where a program cannot be drawn: one that follows a path, or a shard.
Result<void> check_drawable(const ProgramHeader& header, const std::string& path);

/// Draws the layers of a verified program and writes the page. The program has the line that is asked for.
Result<WrittenReport> write_report(const ReportRequest& request, VerifiedProgram verified, const Command& command);

}  // namespace gravure::cli
