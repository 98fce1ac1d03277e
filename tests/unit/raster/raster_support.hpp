#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "gravure/raster/kernels.hpp"

/// Bits one at a time, random sizes, and the kernel tables under test.
namespace gravure::raster {

using Bytes = std::vector<std::byte>;

inline bool get_bit(const Bytes& bytes, std::int64_t bit) {
  return (std::to_integer<int>(bytes[static_cast<std::size_t>(bit / 8)]) >> (7 - bit % 8) & 1) != 0;
}

inline void set_bit(Bytes& bytes, std::int64_t bit, bool one) {
  const auto mask = static_cast<std::byte>(0x80 >> bit % 8);
  std::byte& byte = bytes[static_cast<std::size_t>(bit / 8)];
  byte = one ? byte | mask : byte & ~mask;
}

/// The engine's bits alone: std distributions differ between libraries.
class Dice {
 public:
  Dice() {
    if (const char* text = std::getenv("GRAVURE_TEST_SEED")) {
      seed_ = static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
    }
    engine_.seed(seed_);
  }
  std::uint32_t word() { return static_cast<std::uint32_t>(engine_()); }
  /// 0 .. most
  std::int64_t up_to(std::int64_t most) {
    return static_cast<std::int64_t>(word() % static_cast<std::uint64_t>(most + 1));
  }
  /// Mostly short, now and then up to `most`, so that heads, tails and loops are all met.
  std::int64_t size(std::int64_t most) {
    const std::int64_t kind = up_to(9);
    return up_to(kind < 4 ? std::min<std::int64_t>(most, 40) : kind < 8 ? std::min<std::int64_t>(most, 700) : most);
  }
  bool coin() { return (word() & 1) != 0; }
  /// Random bits, or long runs of equal bytes.
  Bytes bytes(std::int64_t count) {
    Bytes out(static_cast<std::size_t>(count));
    const bool runs = up_to(3) == 0;
    auto byte = static_cast<std::byte>(word());
    for (std::byte& each : out) {
      if (!runs || up_to(19) == 0) {
        byte = runs && coin() ? (coin() ? std::byte{0} : std::byte{0xFF}) : static_cast<std::byte>(word());
      }
      each = byte;
    }
    return out;
  }
  std::string trace() const { return "rerun with GRAVURE_TEST_SEED=" + std::to_string(seed_); }

 private:
  std::uint32_t seed_ = 1;
  std::mt19937 engine_;
};

/// A test that runs once for each instruction set; skipped, with the reason, where the processor lacks it.
class KernelTest : public testing::TestWithParam<Isa> {
 protected:
  void SetUp() override {
    kernels_ = kernels_for(GetParam());
    if (kernels_ == nullptr) {
      GTEST_SKIP() << "this processor has no " << isa_name(GetParam());
    }
  }
  const Kernels& kernels() const { return *kernels_; }
  static const Kernels& portable() { return *kernels_for(Isa::portable); }

 private:
  const Kernels* kernels_ = nullptr;
};

inline const auto kEveryIsa = testing::Values(Isa::portable, Isa::avx2, Isa::avx512);
inline const auto kIsaName = [](const testing::TestParamInfo<Isa>& isa) { return std::string(isa_name(isa.param)); };

}  // namespace gravure::raster
