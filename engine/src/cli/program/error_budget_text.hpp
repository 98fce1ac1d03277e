#pragma once

#include <string>

#include "gravure/twin/error_budget.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// The error budget as `verify` prints it: a table of the terms, then what they come to.
std::string error_budget_text(const ErrorBudget& budget);
/// `error_um` of `verify --json`.
Json error_budget_json(const ErrorBudget& budget);

}  // namespace gravure::cli
