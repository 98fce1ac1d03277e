#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string>

#include "machine.hpp"

namespace gravure::cosim {

/// The same words everywhere, cheap enough for one a port and clock.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t word() { return engine_(); }
  bool one_in(std::uint64_t number) { return engine_() % number == 0; }
  std::uint64_t of_any_length() { return engine_() >> (engine_() % 64); }

 private:
  std::mt19937_64 engine_;
};

/// Changes inputs before a clock: random, extreme, idle. `in` keeps its values between calls.
using Stimulus = std::function<void(Dice&, std::span<std::uint64_t> in)>;
/// What suits the block's ports.
Stimulus stimulus_for(const Machine& machine);

}  // namespace gravure::cosim
