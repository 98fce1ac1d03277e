#include "set_cover.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace gravure::zones {
namespace {

/// A node of the search takes about as many steps as there are elements.
constexpr std::size_t kMostSteps = 4'000'000;

class Search {
 public:
  Search(const std::vector<Bits>& sets, std::size_t elements, const ZoneWatch& watch)
      : sets_(sets),
        watch_(watch),
        owners_(elements),
        neighbours_(elements, Bits(elements)),
        nodes_left_(kMostSteps / (elements + 1)) {
    for (std::size_t s = 0; s < sets.size() && !watch.stopped(); ++s) {
      for (const std::size_t e : sets[s].members()) {
        owners_[e].push_back(s);
        neighbours_[e].add(sets[s]);
      }
    }
  }

  SetCover run() {
    Bits uncovered(owners_.size());
    for (std::size_t e = 0; e < owners_.size(); ++e) {
      uncovered.set(e);
    }
    best_ = greedy(uncovered);
    descend(uncovered);
    return {best_, nodes_left_ > 0};
  }

 private:
  /// Always the set with most that is missing; of equals the first.
  std::vector<std::size_t> greedy(Bits uncovered) const {
    std::vector<std::size_t> chosen;
    while (!uncovered.empty() && !watch_.stopped()) {
      std::size_t best = 0;
      std::size_t most = 0;
      for (std::size_t s = 0; s < sets_.size(); ++s) {
        const std::size_t news = sets_[s].count_common(uncovered);
        if (news > most) {
          best = s;
          most = news;
        }
      }
      chosen.push_back(best);
      uncovered.remove(sets_[best]);
    }
    return chosen;
  }

  std::size_t hardest(const Bits& uncovered) const {
    const std::vector<std::size_t> members = uncovered.members();
    return *std::min_element(members.begin(), members.end(),
                             [this](std::size_t a, std::size_t b) { return owners_[a].size() < owners_[b].size(); });
  }

  /// Elements no two of which share a set need a set each.
  std::size_t bound(Bits uncovered) const {
    std::size_t count = 0;
    while (!uncovered.empty()) {
      uncovered.remove(neighbours_[hardest(uncovered)]);
      ++count;
    }
    return count;
  }

  void descend(const Bits& uncovered) {
    if (uncovered.empty()) {
      if (chosen_.size() < best_.size()) {
        best_ = chosen_;
      }
      return;
    }
    if (watch_.stopped()) {
      nodes_left_ = 0;
    }
    if (nodes_left_ == 0 || chosen_.size() + bound(uncovered) >= best_.size()) {
      return;
    }
    --nodes_left_;
    std::vector<std::pair<std::size_t, std::size_t>> options;  // what it adds, the set
    for (const std::size_t s : owners_[hardest(uncovered)]) {
      options.emplace_back(sets_[s].count_common(uncovered), s);
    }
    std::stable_sort(options.begin(), options.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [news, s] : options) {
      Bits rest = uncovered;
      rest.remove(sets_[s]);
      chosen_.push_back(s);
      descend(rest);
      chosen_.pop_back();
    }
  }

  const std::vector<Bits>& sets_;
  const ZoneWatch& watch_;
  std::vector<std::vector<std::size_t>> owners_;
  std::vector<Bits> neighbours_;
  std::size_t nodes_left_;
  std::vector<std::size_t> chosen_;
  std::vector<std::size_t> best_;
};

/// The numbers of the sets by how much is in them, of equal ones the lower first.
std::vector<std::size_t> by_count(const std::vector<Bits>& sets, bool most_first) {
  std::vector<std::size_t> counts;
  for (const Bits& set : sets) {
    counts.push_back(set.count());
  }
  std::vector<std::size_t> order(sets.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return most_first ? counts[a] > counts[b] : counts[a] < counts[b];
  });
  return order;
}

}  // namespace

std::size_t Bits::count() const noexcept {
  return std::accumulate(words_.begin(), words_.end(), std::size_t{0}, [](std::size_t sum, std::uint64_t word) {
    return sum + static_cast<std::size_t>(std::popcount(word));
  });
}

std::size_t Bits::count_common(const Bits& other) const noexcept {
  std::size_t sum = 0;
  for (std::size_t w = 0; w < words_.size(); ++w) {
    sum += static_cast<std::size_t>(std::popcount(words_[w] & other.words_[w]));
  }
  return sum;
}

bool Bits::is_subset_of(const Bits& other) const noexcept {
  for (std::size_t w = 0; w < words_.size(); ++w) {
    if ((words_[w] & ~other.words_[w]) != 0) {
      return false;
    }
  }
  return true;
}

bool Bits::empty() const noexcept {
  return std::all_of(words_.begin(), words_.end(), [](std::uint64_t word) { return word == 0; });
}

void Bits::add(const Bits& other) noexcept {
  for (std::size_t w = 0; w < words_.size(); ++w) {
    words_[w] |= other.words_[w];
  }
}

void Bits::remove(const Bits& other) noexcept {
  for (std::size_t w = 0; w < words_.size(); ++w) {
    words_[w] &= ~other.words_[w];
  }
}

std::vector<std::size_t> Bits::members() const {
  std::vector<std::size_t> members;
  for (std::size_t w = 0; w < words_.size(); ++w) {
    for (std::uint64_t word = words_[w]; word != 0; word &= word - 1) {
      members.push_back(w * 64 + static_cast<std::size_t>(std::countr_zero(word)));
    }
  }
  return members;
}

std::vector<std::size_t> maximal_sets(const std::vector<Bits>& sets, const ZoneWatch& watch) {
  std::vector<std::size_t> kept;
  std::vector<std::vector<std::size_t>> owners;  // the kept sets that hold an element
  for (const std::size_t s : by_count(sets, true)) {
    const std::vector<std::size_t> members = sets[s].members();
    if (watch.stopped() || members.empty()) {
      break;
    }
    owners.resize(std::max(owners.size(), members.back() + 1));
    // What holds the set holds its rarest element.
    const std::size_t rarest = *std::min_element(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
      return owners[a].size() < owners[b].size();
    });
    const std::vector<std::size_t>& may_hold = owners[rarest];
    if (std::none_of(may_hold.begin(), may_hold.end(), [&](std::size_t k) { return sets[s].is_subset_of(sets[k]); })) {
      kept.push_back(s);
      for (const std::size_t e : members) {
        owners[e].push_back(s);
      }
    }
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

SetCover smallest_cover(const std::vector<Bits>& sets, std::size_t elements, const ZoneWatch& watch) {
  return Search(sets, elements, watch).run();
}

std::size_t largest_packing(const std::vector<Bits>& neighbours) {
  const std::size_t elements = neighbours.size();
  const std::vector<std::size_t> order = by_count(neighbours, false);
  std::size_t largest = 0;
  for (std::size_t start = 0; start < elements; ++start) {
    Bits taken = neighbours[start];
    std::size_t count = 1;
    for (const std::size_t e : order) {
      if (!taken.has(e)) {
        taken.add(neighbours[e]);
        ++count;
      }
    }
    largest = std::max(largest, count);
  }
  return largest;
}

}  // namespace gravure::zones
