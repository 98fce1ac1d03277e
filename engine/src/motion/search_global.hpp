#pragma once

#include <vector>

#include "move_space.hpp"

namespace gravure::motion {

enum class SearchFor : std::uint8_t { symmetric, asymmetric, robust };

/// The best few points, best first, found from the notch grid (durations in fractions of the modes' periods), random
/// points of one stream and the given `seeds`, by descents from the best of them. The first is never worse than a seed.
std::vector<MovePoint> search_global(const MoveSpace& space, const SearchProblem& problem, std::uint64_t stream,
                                     SearchFor what, const std::vector<MovePoint>& seeds);

/// Descents from each of `starts`, large steps first; the ends, best first.
std::vector<MovePoint> polish(const MoveSpace& space, SearchFor what, const std::vector<MovePoint>& starts);

}  // namespace gravure::motion
