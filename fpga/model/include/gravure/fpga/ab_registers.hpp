#pragma once

#include <cstdint>

namespace gravure::fpga {

__extension__ using Uint128 = unsigned __int128;

/// Registers of one A-B channel, [B] eqs 1 and 2, with an optional fraction.
///
/// Clocks count from 1. On clocks that are multiples of `prescaler`: acc += num; carry = acc >= den; acc -= carry *
/// den; counter += increment + carry, modulo 2^bits. A and B are the two leading bits of the counter, Gray coded (00 ->
/// 00, 01 -> 01, 10 -> 11, 11 -> 10), as they stand just after the clock. Everything starts at 0.
struct AbRegisters {
  int bits = 32;                   ///< n, kMinCounterBits..kMaxCounterBits
  std::uint64_t prescaler = 1;     ///< m >= 1
  std::uint64_t increment = 0;     ///< 0 stands still; with the largest carry at most 2^(bits-2)
  std::uint64_t fraction_num = 0;  ///< < fraction_den; 0 turns the fraction off
  std::uint64_t fraction_den = 1;  ///< >= 1
};

inline constexpr int kMinCounterBits = 4;  ///< boards have 8 or more; the published example has 6
inline constexpr int kMaxCounterBits = 64;

/// The first register the board would not take.
enum class AbRefusal : std::uint8_t { none, bits, prescaler, fraction_den, fraction_num, increment };

/// none: AbCounter and AbEdges run these registers, at any 64-bit clock, without overflow.
AbRefusal check(const AbRegisters& registers) noexcept;

/// Largest increment that check() takes: 2^(bits-2), one less with a fraction. More would move A and B together.
/// `registers.bits` must be in range.
std::uint64_t max_increment(const AbRegisters& registers) noexcept;

/// The two output pins.
struct AbPins {
  bool a = false;
  bool b = false;
  friend bool operator==(const AbPins&, const AbPins&) = default;
};

/// Gray code of a count of quarter turns; only its two low bits matter.
constexpr AbPins pins_of_quarter(std::uint64_t quarter) noexcept {
  return {(quarter & 2U) != 0, ((quarter ^ (quarter >> 1U)) & 1U) != 0};
}

}  // namespace gravure::fpga
