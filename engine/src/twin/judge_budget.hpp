#pragma once

#include <functional>
#include <memory>

#include "gravure/twin/verify.hpp"

namespace gravure {

/// Adds the error budget to a report, with what its limits have to say; a limit that cannot be judged is a violation.
/// Fails where the program cannot be read, and on cancellation.
Result<void> judge_budget(const std::function<Result<std::unique_ptr<LineSource>>()>& programs, const Plan& plan,
                          const VerifyOptions& options, VerifyReport& report);

}  // namespace gravure
