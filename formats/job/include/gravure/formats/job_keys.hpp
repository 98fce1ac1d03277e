#pragma once

#include <string>
#include <vector>

namespace gravure {

/// One key of the job file as an operator needs to know it; the table in docs/formats/job.md has the same rows.
struct JobKey {
  std::string section;   ///< "laser"
  std::string key;       ///< "seed_hz"
  std::string type;      ///< "integer", "decimal", "boolean", "string", "list of strings", "two integers"
  std::string unit;      ///< "Hz"; empty where there is none
  std::string range;     ///< "1 to 10_000_000_000", or the words allowed
  std::string fallback;  ///< the value a missing key stands for, "required", or what decides
};

/// Every key the reader knows, in the order of docs/formats/job.md.
std::vector<JobKey> job_keys();

}  // namespace gravure
