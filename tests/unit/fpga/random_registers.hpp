#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>

#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga::test {

/// GRAVURE_TEST_SEED, else 1.
inline std::uint64_t random_seed() {
  const char* text = std::getenv("GRAVURE_TEST_SEED");
  return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

/// The same words everywhere; the distributions of the standard library are not.
class Words {
 public:
  explicit Words(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t word() { return engine_(); }
  std::uint64_t below(std::uint64_t limit) { return engine_() % limit; }
  /// Every bit length 1..64 is equally likely.
  std::uint64_t of_any_length() { return engine_() >> below(64); }

 private:
  std::mt19937_64 engine_;
};

inline AbRegisters random_registers(Words& words) {
  constexpr std::uint64_t kPrescalers[] = {1, 1, 2, 3, 7, 70'001};
  constexpr int kBits[] = {8, 16, 32, 48, 64};
  AbRegisters registers;
  registers.bits = words.below(2) == 0 ? kBits[words.below(5)] : static_cast<int>(8 + words.below(57));
  registers.prescaler = kPrescalers[words.below(6)];
  if (words.below(2) == 0) {
    registers.fraction_den = words.of_any_length() | 1U;
    registers.fraction_num = words.word() % registers.fraction_den;
  }
  const std::uint64_t top = max_increment(registers);
  switch (words.below(4)) {
    case 0:
      registers.increment = top - words.below(3);
      break;
    case 1:
      registers.increment = words.below(100) % (top + 1);
      break;
    default:
      registers.increment = words.word() % (top + 1);
      break;
  }
  return registers;
}

/// Order-dependent hash of a stream of edges: nothing is stored.
class EdgeHash {
 public:
  void add(std::uint64_t clock, AbPins pins) noexcept {
    const std::uint64_t code = (pins.a ? 2U : 0U) + (pins.b ? 1U : 0U);
    hash_ = (hash_ ^ (clock * 4 + code)) * 0x9E3779B97F4A7C15U;
    hash_ ^= hash_ >> 29U;
    ++edges_;
  }
  std::uint64_t edges() const noexcept { return edges_; }
  friend bool operator==(const EdgeHash&, const EdgeHash&) = default;

 private:
  std::uint64_t hash_ = 0;
  std::uint64_t edges_ = 0;
};

}  // namespace gravure::fpga::test
