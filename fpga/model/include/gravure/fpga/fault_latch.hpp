#pragma once

#include <bit>
#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/fault_latch.v: the first fault until it is acknowledged, and which others came after it;
/// numbered like gravure::DeviceFault.
class FaultLatch {
 public:
  struct Inputs {
    bool rst = false;
    bool acknowledge = false;
    bool sequence_error = false;
    bool checksum_error = false;
    bool shape_error = false;
    bool underrun = false;
    bool host_silence = false;
    bool interlock = false;
  };
  struct Outputs {
    std::uint8_t fault = 0;
    std::uint8_t seen = 0;  ///< bit n - 1: fault n
    bool any = false;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst) {
      return out_ = {};
    }
    out_.seen = static_cast<std::uint8_t>(causes(in) | (in.acknowledge ? 0U : out_.seen));
    if (in.acknowledge || !out_.any) {
      out_.fault = cause(in);
      out_.any = out_.fault != 0;
    }
    return out_;
  }

 private:
  static unsigned causes(const Inputs& in) noexcept {
    return (in.sequence_error ? 1U : 0U) | (in.checksum_error ? 2U : 0U) | (in.shape_error ? 4U : 0U) |
           (in.underrun ? 8U : 0U) | (in.host_silence ? 16U : 0U) | (in.interlock ? 32U : 0U);
  }
  static std::uint8_t cause(const Inputs& in) noexcept {
    const unsigned present = causes(in);
    return static_cast<std::uint8_t>(present == 0 ? 0 : 1 + std::countr_zero(present));
  }

  Outputs out_;
};

}  // namespace gravure::fpga
