#pragma once

#include <cstdint>

#include "gravure/core/device_link.hpp"
#include "gravure/core/program.hpp"

namespace gravure::session {

/// What a program asks of the link, exactly.
struct LinkDemand {
  std::int64_t frame_bytes = 0;  ///< of every line
  Rational bits_per_s = 0;       ///< that the board uses up while lines run
};
LinkDemand link_demand(const ProgramHeader& header);

/// bad_argument, naming both rates and what to change, where the link carries less than the program uses up: the board
/// would starve. A link that does not know its rate (0) is not asked.
Result<void> check_link_rate(const LinkDemand& demand, const DeviceIdentity& device);

/// Bytes the board is to hold before lines run: `wanted`, else half of its buffer; never more than the job has.
/// out_of_range where that is less than a frame or more than the board holds.
Result<std::int64_t> reserve_bytes(std::int64_t wanted, const LinkDemand& demand, std::int64_t capacity_bytes,
                                   std::int64_t job_lines);

}  // namespace gravure::session
