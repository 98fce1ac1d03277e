#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"

namespace gravure {

/// Larger job files are refused before they are read.
inline constexpr std::size_t kMaxJobBytes = std::size_t{1} << 20U;

/// Reads a job file (TOML, docs/formats/job.md). Fails with bad_file where it cannot be opened, is not a regular file
/// or is larger than kMaxJobBytes, with io where reading breaks off, and otherwise as parse_job() does.
Result<Job> read_job(const std::string& path);

/// The job that `text` describes; `path` is only named, in errors and in Job::path.
///
/// Values are checked one by one and against each other as far as the file alone tells. Every violation is one line
/// "path:line:column: what, its value, what is allowed", each once, in file order (after 1000 of them only their number
/// is given). The code is out_of_range where every violation is a number outside its range, bad_argument otherwise;
/// text beyond kMaxJobBytes is bad_file.
/// Decimal numbers are taken from their literals and are exact.
Result<Job> parse_job(std::string_view text, const std::string& path);

/// A commented job that runs as it is when `layers/` beside it holds kStarterLayers bilevel images of kStarterPixels x
/// kStarterLines pixels.
std::string starter_job(Mode mode);
inline constexpr int kStarterLayers = 2;
inline constexpr int kStarterPixels = 64;   ///< image width: pixels of one scan line
inline constexpr int kStarterLines = 1968;  ///< image height: lines of one revolution

}  // namespace gravure
