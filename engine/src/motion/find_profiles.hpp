#pragma once

#include <optional>

#include "gravure/motion/plan_profile.hpp"
#include "gravure/motion/search.hpp"

namespace gravure::motion {

/// The profiles of a search, as they run when planned from their parameters.
struct FoundProfiles {
  Candidate symmetric;
  Candidate asymmetric;             ///< never slower than the symmetric one
  std::optional<Candidate> robust;  ///< never slower in the worst case than either
  std::optional<SearchedGrids> grids;
  std::uint64_t evaluated = 0;
};

/// The request that runs a candidate.
SFactorRequest request_of(const SearchProblem& problem, const Candidate& candidate);

/// Searches in rounds: one from starting points that are always the same, then `effort` from random ones; each starts
/// from the best so far as well. Grids come last. So more effort, or a grid, never makes any of the profiles worse.
Result<FoundProfiles> find_profiles(const SearchProblem& problem, const SearchOptions& options);

}  // namespace gravure::motion
