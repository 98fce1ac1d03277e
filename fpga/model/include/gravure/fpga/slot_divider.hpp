#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/slot_divider.v (W = 16): a strobe at the first seed clock of every slot.
/// Latency (latencies.hpp): kSlotLatency.
class SlotDivider {
 public:
  struct Inputs {
    bool rst = false;
    bool run = false;
    std::uint16_t seeds_per_slot = 0;  ///< 0 acts as 1
    bool adjust = false;               ///< the slot that runs becomes longer by `amount`
    std::uint16_t amount = 0;          ///< 9 bits, two's complement
  };
  struct Outputs {
    bool slot = false;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst || !in.run) {
      count_ = 1;
      length_ = in.seeds_per_slot;
      begins_ = true;
      return {};
    }
    const Outputs out{.slot = begins_};
    begins_ = count_ >= length_;
    if (begins_) {
      count_ = 1;
      length_ = in.seeds_per_slot;
    } else {
      ++count_;
      if (in.adjust) {
        const std::uint32_t extended = (in.amount & 0x100U) != 0 ? in.amount | 0x1FE00U : in.amount & 0xFFU;
        length_ = (length_ + extended) & 0x1FFFFU;
      }
    }
    return out;
  }

 private:
  friend class SynchroEvents;

  std::uint32_t count_ = 1;   ///< clock of the slot, from 1
  std::uint32_t length_ = 0;  ///< 17 bits
  bool begins_ = true;
};

}  // namespace gravure::fpga
