#pragma once

#include "gravure/motion/search.hpp"

namespace gravure::motion {

Result<void> check_problem(const SearchProblem& problem);

}  // namespace gravure::motion
