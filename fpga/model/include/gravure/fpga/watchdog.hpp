#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/watchdog.v (W = 32): expires after `limit` clocks without a kick, sticky until clear.
class Watchdog {
 public:
  struct Inputs {
    bool rst = false;
    bool enable = false;
    bool kick = false;
    bool clear = false;
    std::uint32_t limit = 0;
  };
  struct Outputs {
    bool expired = false;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst || in.clear) {
      silent_ = 0;
      out_.expired = false;
    } else if (!in.enable || in.kick) {
      silent_ = 0;
    } else if (silent_ >= in.limit) {
      out_.expired = true;
    } else {
      ++silent_;
    }
    return out_;
  }

 private:
  friend class SynchroEvents;

  std::uint32_t silent_ = 0;
  Outputs out_;
};

}  // namespace gravure::fpga
