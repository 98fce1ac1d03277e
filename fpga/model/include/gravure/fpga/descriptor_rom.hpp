#pragma once

#include <cstdint>

#include "gravure/fpga/register_map.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/descriptor_rom.v: what the board is made of (docs/registers.md).
class DescriptorRom {
 public:
  struct Inputs {
    std::uint8_t number = 0;  ///< 6 bits
  };
  struct Outputs {
    std::uint32_t word = 0;
  };
  static Outputs step(const Inputs& in) noexcept {
    const unsigned number = in.number & 0x3FU;
    return {.word = number < kDescriptors.size() ? kDescriptors[number] : 0};
  }
};

}  // namespace gravure::fpga
