#pragma once

#include <span>

#include "gravure/motion/settling.hpp"

namespace gravure::motion {

/// The last instant up to `from_s` at which the sum of the terms is beyond `tolerance`, 0 if it never is; within the
/// tolerance from `from_s` on.
double last_exit_before(std::span<const ResidualSignal::Term> terms, double from_s, double tolerance) noexcept;

}  // namespace gravure::motion
