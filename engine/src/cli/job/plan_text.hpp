#pragma once

#include <string>

#include "gravure/core/plan.hpp"

namespace gravure::cli {

/// A plan as an operator reads it, a line a subject.
std::string plan_text(const Plan& plan);

}  // namespace gravure::cli
