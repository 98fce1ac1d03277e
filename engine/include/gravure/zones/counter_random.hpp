#pragma once

#include <cstdint>

namespace gravure::zones {

/// Random numbers as a function of seed, stream and counter: SplitMix64 (Steele, Lea and Flood 2014) at place `counter`
/// of the sequence that begins at the mixed seed and stream. No state, the same on every machine.
constexpr std::uint64_t random_word(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) noexcept {
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
  const auto mix = [](std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  };
  return mix(mix(seed + kGolden * stream) + kGolden * (counter + 1));
}

/// From 0 to below 1, a multiple of 2^-53.
constexpr double random_fraction(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) noexcept {
  return static_cast<double>(random_word(seed, stream, counter) >> 11U) * 0x1p-53;
}

}  // namespace gravure::zones
