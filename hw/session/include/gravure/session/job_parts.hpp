#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gravure/core/plan.hpp"

namespace gravure::session {

/// Lines that run without a break, counted over the whole job. Each part begins with its axes at their reference.
struct JobPart {
  std::int64_t first_line = 0;
  std::int64_t end_line = 0;
  bool axis_backward = false;  ///< flat mode: the stage comes back
  std::string begins_with;     ///< what the operator has to see to before it, or empty
};

/// The whole job in rotary and helical mode; its bands where there are several, since the stage along the axis moves
/// between them; in flat mode every pass, since the stage turns round and goes back where it came.
std::vector<JobPart> job_parts(const Plan& plan);

/// Part that holds a line of the job.
std::size_t part_of(const std::vector<JobPart>& parts, std::int64_t line);

/// "revolution 3, line 17", or "pass".
std::string line_text(const Plan& plan, std::int64_t line);

}  // namespace gravure::session
