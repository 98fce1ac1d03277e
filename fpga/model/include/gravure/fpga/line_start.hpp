#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/line_start.v (W = 32): when slots run and when the first line may begin, by the start
/// strobe or at a programmed tick after go.
/// Latency (latencies.hpp): kStartLatency.
class LineStart {
 public:
  struct Inputs {
    bool rst = false;
    bool run = false;
    bool timed = false;  ///< by the tick, not the strobe
    bool strobe = false;
    bool go = false;  ///< tick 0 is the next clock
    std::uint32_t first_tick = 0;
  };
  struct Outputs {
    bool slots_run = false;  ///< combinational in run and timed: as for the clock that comes
    bool started = false;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  /// slots_run for inputs that stand between two clocks.
  bool slots_run(bool run, bool timed) const noexcept { return run && (!timed || arrived_); }

  Outputs step(const Inputs& in) noexcept {
    if (in.rst) {
      *this = {};
      return {.slots_run = slots_run(in.run, in.timed)};
    }
    const bool begins = !in.go && (arrived_ || arrives_);
    started_ = in.run && (in.timed ? begins : started_ || in.strobe);
    arrived_ = in.run && begins;
    arrives_ = counting_ && !in.go && tick_ == in.first_tick;
    if (in.go) {
      counting_ = true;
      tick_ = 0;
    } else if (counting_) {
      counting_ = ++tick_ != 0;
    }
    return {.slots_run = slots_run(in.run, in.timed), .started = started_};
  }

 private:
  friend class SynchroEvents;

  bool counting_ = false;
  std::uint32_t tick_ = 0;
  bool arrives_ = false;
  bool arrived_ = false;
  bool started_ = false;
};

}  // namespace gravure::fpga
