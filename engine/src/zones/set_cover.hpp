#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gravure/zones/zone_watch.hpp"

namespace gravure::zones {

/// A set of small numbers.
class Bits {
 public:
  explicit Bits(std::size_t size) : words_((size + 63) / 64) {}
  void set(std::size_t i) noexcept { words_[i / 64] |= std::uint64_t{1} << (i % 64); }
  bool has(std::size_t i) const noexcept { return ((words_[i / 64] >> (i % 64)) & 1U) != 0; }
  std::size_t count() const noexcept;
  std::size_t count_common(const Bits& other) const noexcept;
  bool is_subset_of(const Bits& other) const noexcept;
  bool empty() const noexcept;
  void add(const Bits& other) noexcept;
  void remove(const Bits& other) noexcept;
  std::vector<std::size_t> members() const;
  bool operator==(const Bits& other) const noexcept { return words_ == other.words_; }
  bool operator<(const Bits& other) const noexcept { return words_ < other.words_; }

 private:
  std::vector<std::uint64_t> words_;
};

/// Which of the sets no other one holds; of equal ones the first. In ascending order. Some of them where `watch` stops.
std::vector<std::size_t> maximal_sets(const std::vector<Bits>& sets, const ZoneWatch& watch = {});

struct SetCover {
  std::vector<std::size_t> chosen;  ///< of the sets, in the order of choice
  bool is_proved = false;           ///< no fewer will do
};

/// Fewest sets that hold 0 .. elements - 1 between them; every element is in one of them at least. Branch and bound
/// from the greedy cover over the element with the fewest sets; it gives up the proof, not the cover, after
/// millions of steps, or where `watch` stops.
SetCover smallest_cover(const std::vector<Bits>& sets, std::size_t elements, const ZoneWatch& watch = {});

/// Size of a set of elements, found greedily from every start, of which no two are neighbours.
std::size_t largest_packing(const std::vector<Bits>& neighbours);

}  // namespace gravure::zones
