#include "set_cover.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace gravure::zones {
namespace {

/// A node of the search takes about as many steps as there are elements.
constexpr std::size_t kMostSteps = 4'000'000;

class Search {
 public:
  Search(const std::vector<Bits>& sets, std::size_t elements)
      : sets_(sets),
        owners_(elements),
        neighbours_(elements, Bits(elements)),
        nodes_left_(kMostSteps / (elements + 1)) {
    for (std::size_t s = 0; s < sets.size(); ++s) {
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
    while (!uncovered.empty()) {
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
    if (nodes_left_ == 0 || chosen_.size() + bound(uncovered) >= best_.size()) {
      return;
    }
    --nodes_left_;
    std::vector<std::size_t> options = owners_[hardest(uncovered)];
    std::stable_sort(options.begin(), options.end(), [&](std::size_t a, std::size_t b) {
      return sets_[a].count_common(uncovered) > sets_[b].count_common(uncovered);
    });
    for (const std::size_t s : options) {
      Bits rest = uncovered;
      rest.remove(sets_[s]);
      chosen_.push_back(s);
      descend(rest);
      chosen_.pop_back();
    }
  }

  const std::vector<Bits>& sets_;
  std::vector<std::vector<std::size_t>> owners_;
  std::vector<Bits> neighbours_;
  std::size_t nodes_left_;
  std::vector<std::size_t> chosen_;
  std::vector<std::size_t> best_;
};

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

std::vector<std::size_t> maximal_sets(const std::vector<Bits>& sets) {
  std::vector<std::size_t> by_size(sets.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t a, std::size_t b) { return sets[a].count() > sets[b].count(); });
  std::vector<std::size_t> kept;
  for (const std::size_t s : by_size) {
    if (std::none_of(kept.begin(), kept.end(), [&](std::size_t k) { return sets[s].is_subset_of(sets[k]); })) {
      kept.push_back(s);
    }
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

SetCover smallest_cover(const std::vector<Bits>& sets, std::size_t elements) {
  return Search(sets, elements).run();
}

std::size_t largest_packing(const std::vector<Bits>& neighbours) {
  const std::size_t elements = neighbours.size();
  std::vector<std::size_t> order(elements);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return neighbours[a].count() < neighbours[b].count(); });
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
