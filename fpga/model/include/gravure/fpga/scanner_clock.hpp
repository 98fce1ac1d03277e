#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/scanner_clock.v (W = 24): a strobe every slots_per_microvector-th slot of a line, in
/// phase with its first slot.
/// Latency (latencies.hpp): kScanLatency.
class ScannerClock {
 public:
  struct Inputs {
    bool rst = false;
    bool decision = false;
    bool first = false;
    std::uint32_t slots_per_microvector = 0;  ///< 24 bits; 0 acts as 1
  };
  struct Outputs {
    bool scan = false;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    const std::uint32_t reload = reload_;
    reload_ = in.slots_per_microvector == 0 ? 0 : in.slots_per_microvector - 1;
    if (in.rst) {
      left_ = 0;
      return {};
    }
    const bool strobe = in.first || left_ == 0;
    if (in.decision) {
      left_ = strobe ? reload : left_ - 1;
    }
    return {.scan = in.decision && strobe};
  }

 private:
  std::uint32_t left_ = 0;    ///< decisions until the next strobe
  std::uint32_t reload_ = 0;  ///< the setting, less one
};

}  // namespace gravure::fpga
