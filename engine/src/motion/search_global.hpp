#pragma once

#include <vector>

#include "move_space.hpp"

namespace gravure::motion {

enum class SearchFor : std::uint8_t { symmetric, asymmetric, robust };

/// The best point found from the notch grid (durations in fractions of the modes' periods), random points and the given
/// `seeds`, by descents from the best of them. Never worse than any seed.
MovePoint search_global(const MoveSpace& space, const SearchProblem& problem, const SearchOptions& options,
                        SearchFor what, const std::vector<MovePoint>& seeds);

}  // namespace gravure::motion
