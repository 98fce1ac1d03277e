#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace gravure::job_file {

/// Fewest insertions, deletions, replacements and swaps of neighbours that make `a` from `b`, letter case aside.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// "; did you mean seed_hz?" where the nearest candidate is near, "; the nearest known one is seed_hz" where it is not.
std::string suggestion(std::string_view wrong, std::span<const std::string> candidates);

}  // namespace gravure::job_file
