#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace gravure::toml_file {

/// Fewest insertions, deletions, replacements and swaps of neighbours that make `a` from `b`, letter case aside.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// What a wrong word is compared with, and how the message writes it: "seed_hz", "[laser] seed_hz".
struct Candidate {
  std::string_view word;
  std::string shown;
};

struct Suggestion {
  std::string text;     ///< "; did you mean seed_hz?" where it is near, "; the nearest known one is seed_hz" where not
  std::string nearest;  ///< the word, where it is near
  bool is_near = false;
};

/// The candidate nearest to a wrong word; of equally near ones the first. Empty without candidates.
Suggestion suggest(std::string_view wrong, std::span<const Candidate> candidates);

}  // namespace gravure::toml_file
