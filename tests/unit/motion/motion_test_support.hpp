#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

namespace gravure::motion::test {

/// GRAVURE_TEST_SEED, else 1.
inline std::uint32_t seed() {
  const char* text = std::getenv("GRAVURE_TEST_SEED");
  return text != nullptr ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : 1U;
}

/// Random numbers that are the same on every machine; the std distributions are not.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double uniform() { return static_cast<double>(engine_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  double log_between(double low, double high) { return low * std::exp(std::log(high / low) * uniform()); }
  double gaussian() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
  }

 private:
  std::mt19937 engine_;
};

/// `value` moved by `ulps` steps of its own spacing.
inline double nudge(double value, long ulps) {
  return value * (1 + static_cast<double>(ulps) * std::numeric_limits<double>::epsilon());
}

}  // namespace gravure::motion::test

#define GRAVURE_TRACE_SEED() \
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << gravure::motion::test::seed())
