#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/scanner_clock.v (W = 16): a strobe every slots_per_microvector-th slot of a line, in
/// phase with its first slot.
class ScannerClock {
 public:
  static constexpr int kLatency = 1;  ///< clocks from the sequencer's outputs to `scan`

  struct Inputs {
    bool rst = false;
    bool decision = false;
    bool first = false;
    std::uint16_t slots_per_microvector = 0;  ///< 0 acts as 1
  };
  struct Outputs {
    bool scan = false;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst) {
      phase_ = 0;
      return {};
    }
    const std::uint32_t now = in.first ? 0 : phase_;
    if (in.decision) {
      phase_ = now + 1 >= in.slots_per_microvector ? 0 : now + 1;
    }
    return {.scan = in.decision && now == 0};
  }

 private:
  std::uint32_t phase_ = 0;
};

}  // namespace gravure::fpga
