#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"
#include "layout.hpp"

namespace gravure::grv {

/// What has to hold between a header and the chunks, before writing and after reading: sizes against the plan, one
/// layer a revolution, indices within their tables, layers that share bits alike, mirrored layers only where lines
/// alternate, fired pixels that add up. `fired_of_chunks` is the table of the chunks. Fails with `code`; the message
/// names field, value and range.
Result<void> check_header(const ProgramHeader& header, const Layout& layout,
                          std::span<const std::int64_t> fired_of_chunks, ErrorCode code);

/// A number of the plan as it is shown beside the plan's JSON.
struct PlanNumber {
  std::string name;
  std::variant<std::int64_t, std::uint64_t> value;
  std::string unit;
};
std::vector<PlanNumber> plan_numbers(const Plan& plan);

}  // namespace gravure::grv
