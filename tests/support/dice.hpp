#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace gravure::test {

/// Random integers from GRAVURE_TEST_SEED, else 1; the same on every machine (std distributions are not).
class Dice {
 public:
  explicit Dice(std::uint64_t stream = 0) : engine_(seed() + (stream << 32U)) {}
  static std::uint32_t seed() {
    const char* const text = std::getenv("GRAVURE_TEST_SEED");
    return text != nullptr ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : 1U;
  }
  static std::string note() { return "rerun with GRAVURE_TEST_SEED=" + std::to_string(seed()); }
  std::uint64_t word() { return engine_(); }
  /// least .. most, both included.
  std::int64_t between(std::int64_t least, std::int64_t most) {
    return least + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(most - least + 1));
  }
  bool coin() { return (engine_() & 1U) != 0; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace gravure::test
