#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/crc32c.v: CRC-32C, one byte a clock.
class Crc32c {
 public:
  struct Inputs {
    bool rst = false;
    bool start = false;  ///< a new message; a byte on the same clock is its first
    bool valid = false;
    std::uint8_t data = 0;
  };
  struct Outputs {
    std::uint32_t crc = 0;  ///< of the bytes so far
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst || in.start) {
      state_ = ~std::uint32_t{0};
    }
    if (in.valid && !in.rst) {
      state_ ^= in.data;
      for (int bit = 0; bit < 8; ++bit) {
        state_ = (state_ >> 1U) ^ ((state_ & 1U) != 0 ? 0x82F63B78U : 0U);
      }
    }
    return {~state_};
  }

 private:
  std::uint32_t state_ = ~std::uint32_t{0};
};

}  // namespace gravure::fpga
