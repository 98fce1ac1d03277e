#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/slot_divider.v (W = 16): a strobe at the first tick of every slot.
class SlotDivider {
 public:
  struct Inputs {
    bool rst = false;
    bool run = false;
    std::uint16_t ticks_per_slot = 0;  ///< 0 acts as 1
  };
  struct Outputs {
    bool slot = false;
  };

  Outputs step(const Inputs& inputs) noexcept {
    if (inputs.rst || !inputs.run) {
      phase_ = 0;
      return {};
    }
    const Outputs out{.slot = phase_ == 0};
    phase_ = phase_ + 1 >= inputs.ticks_per_slot ? 0 : phase_ + 1;
    return out;
  }

 private:
  std::uint32_t phase_ = 0;
};

}  // namespace gravure::fpga
