#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/direction_delay.v (W = 16): the slots of backward lines come `delay` clocks later.
/// Latency (latencies.hpp): kDelayLatency, for backward lines `delay` more.
class DirectionDelay {
 public:
  struct Inputs {
    bool rst = false;
    std::uint16_t delay = 0;  ///< less than a slot lasts
    bool reverse = false;     ///< of the line whose first slot this is
    bool slot_in = false;
    bool decision_in = false;
    bool window_in = false;
    bool first_in = false;
    bool last_in = false;
  };
  struct Outputs {
    bool slot = false;
    bool decision = false;
    bool window = false;
    bool first = false;
    bool last = false;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    const bool now_reverse = in.first_in ? in.reverse : line_reverse_;
    const bool waits = in.slot_in && in.decision_in && now_reverse && in.delay != 0;
    Outputs out;
    if (in.rst) {
      line_reverse_ = waiting_ = false;
      left_ = 0;
    } else {
      if (in.slot_in && in.decision_in) {
        line_reverse_ = now_reverse;
      }
      if (in.slot_in && !waits) {
        out = {true, in.decision_in, in.window_in, in.first_in, in.last_in};
      } else if (waiting_ && left_ == 1) {
        out = held_;
      }
      if (waits) {
        waiting_ = true;
        left_ = in.delay;
      } else {
        const bool over = left_ == 1;
        left_ = static_cast<std::uint16_t>(left_ - (waiting_ ? 1U : 0U));
        waiting_ = waiting_ && !over;
      }
    }
    if (waits) {
      held_ = {true, true, in.window_in, in.first_in, in.last_in};
    }
    return out;
  }

 private:
  friend class SynchroEvents;

  bool line_reverse_ = false;
  bool waiting_ = false;
  std::uint16_t left_ = 0;
  Outputs held_;
};

}  // namespace gravure::fpga
