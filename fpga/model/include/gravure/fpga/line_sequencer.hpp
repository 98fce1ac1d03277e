#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/line_sequencer.v (W = 24): exactly slots_per_line decisions a line. A line begins on a
/// slot that finds none running and `start` high, and takes its settings there.
/// Latency (latencies.hpp): kSequencerLatency.
class LineSequencer {
 public:
  struct Inputs {
    bool rst = false;
    bool slot = false;
    bool start = false;
    std::uint32_t slots_per_line = 0;  ///< 24 bits each; 0 starts nothing
    std::uint32_t first_slot = 0;
    std::uint32_t window_slots = 0;
  };
  struct Outputs {
    bool slot_out = false;
    bool decision = false;  ///< this slot belongs to a line
    bool window = false;    ///< and carries a pixel
    bool first = false;
    bool last = false;
    bool running = false;  ///< a line has slots left
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& inputs) noexcept {
    if (inputs.rst) {
      running_ = false;
      return {};
    }
    Outputs out{.slot_out = inputs.slot};
    if (inputs.slot && (running_ || (inputs.start && inputs.slots_per_line != 0))) {
      if (!running_) {
        index_ = 0;
        line_ = inputs;
      }
      out.decision = true;
      out.first = !running_;
      out.last = index_ == line_.slots_per_line - 1;
      out.window = index_ >= line_.first_slot && index_ - line_.first_slot < line_.window_slots;
      running_ = !out.last;
      ++index_;
    }
    out.running = running_;
    return out;
  }

 private:
  bool running_ = false;
  std::uint32_t index_ = 0;
  Inputs line_;
};

}  // namespace gravure::fpga
