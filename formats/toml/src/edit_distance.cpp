#include "gravure/formats/toml/edit_distance.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace gravure::toml_file {
namespace {

constexpr std::size_t kMaxCompared = 64;  // no key is longer; bounds the work for hostile files

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Optimal string alignment: rows of the usual table for i-2, i-1 and i characters of a.
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const bool same = lower(a[i - 1]) == lower(b[k - 1]);
      row[k] = std::min({last[k] + 1, row[k - 1] + 1, last[k - 1] + (same ? 0U : 1U)});
      if (i > 1 && k > 1 && lower(a[i - 1]) == lower(b[k - 2]) && lower(a[i - 2]) == lower(b[k - 1])) {
        row[k] = std::min(row[k], before_last[k - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

Suggestion suggest(std::string_view wrong, std::span<const Candidate> candidates) {
  const std::string_view compared = wrong.substr(0, kMaxCompared);
  const Candidate* nearest = nullptr;
  std::size_t nearest_distance = 0;
  for (const Candidate& candidate : candidates) {
    const std::size_t distance = edit_distance(compared, candidate.word);
    if (nearest == nullptr || distance < nearest_distance) {
      nearest = &candidate;
      nearest_distance = distance;
    }
  }
  if (nearest == nullptr) {
    return {};
  }
  const bool is_near = nearest_distance <= std::max<std::size_t>(2, nearest->word.size() / 3);
  return {is_near ? "; did you mean " + nearest->shown + "?" : "; the nearest known one is " + nearest->shown,
          is_near ? std::string(nearest->word) : "", is_near};
}

}  // namespace gravure::toml_file
