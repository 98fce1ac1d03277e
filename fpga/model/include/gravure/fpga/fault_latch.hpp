#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/fault_latch.v: the first fault, until acknowledged; numbered like gravure::DeviceFault.
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
    bool any = false;
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst) {
      return out_ = {};
    }
    if (in.acknowledge || !out_.any) {
      out_.fault = cause(in);
      out_.any = out_.fault != 0;
    }
    return out_;
  }

 private:
  static std::uint8_t cause(const Inputs& in) noexcept {
    const bool causes[] = {in.sequence_error, in.checksum_error, in.shape_error,
                           in.underrun,       in.host_silence,   in.interlock};
    std::uint8_t number = 0;
    for (const bool present : causes) {
      ++number;
      if (present) {
        return number;
      }
    }
    return 0;
  }

  Outputs out_;
};

}  // namespace gravure::fpga
