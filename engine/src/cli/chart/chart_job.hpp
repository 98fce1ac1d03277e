#pragma once

#include <map>
#include <string>
#include <utility>

namespace gravure::cli {

/// What a test job says itself; machine, workpiece and limits are those of another job.
struct ChartJob {
  std::string title;
  std::string mode;                                                 ///< "rotary" or "flat"
  std::string image;                                                ///< the lines of [image]
  std::map<std::pair<std::string, std::string>, std::string> keys;  ///< {"scanner", "offset_deg"} -> its value
};

/// The text of a test job: the sections of `base` that describe machine, workpiece, limits and twin as they stand
/// there, with `job.keys` in the place of their own, and [job] and [image] written anew. Reading it tells whether it is
/// one.
std::string chart_job_text(const std::string& base, const ChartJob& job);

}  // namespace gravure::cli
