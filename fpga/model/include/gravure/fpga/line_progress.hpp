#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/line_progress.v (W = 24, LINE_BITS = 32): how far the lines that came in frames have
/// been carried out, for a host that goes on after a fault.
///
/// A slot has passed when the gate let its decision through, however soon the gate closed after that: a pulse may have
/// fired. So the slots of a line that have passed are its first ones.
/// Latency (latencies.hpp): kProgressLatency.
class LineProgress {
 public:
  static constexpr std::uint32_t kPartialBit = std::uint32_t{1} << 31U;  ///< of the register closed_slot

  struct Inputs {
    bool rst = false;
    bool clear = false;
    bool load = false;  ///< of the position
    bool run = false;
    bool begins = false;  ///< the sequencer shows the first slot of a line
    bool queued = false;  ///< whose frame waits in the queue
    bool slot = false;    ///< at the gate
    bool passed = false;  ///< of the gate, as are open and dark
    bool open = false;
    bool dark = false;
  };
  struct Outputs {
    std::uint32_t executed = 0;  ///< lines whose slots have all passed since load, the last one to its end
    std::uint32_t slots = 0;     ///< of the line that runs, or was cut, that have passed
    bool partial = false;        ///< a line was cut: nothing counts until clear or load
    /// As the register of that name has it.
    std::uint32_t closed_slot() const noexcept { return slots | (partial ? kPartialBit : 0); }
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    const bool forget = in.rst || in.clear || in.load;
    const bool counts = in.passed && framed_ && !out_.partial;
    const bool ends = counts && !in.open;
    const bool over = ending_ && (was_slot_ || in.dark || !in.run);
    out_.partial = !forget && (out_.partial || (midway_ && !in.open && !in.passed));
    midway_ = !forget && (counts || midway_) && in.open;
    framed_ = !forget && next_framed_;
    next_framed_ = !forget && (in.begins ? in.queued : next_framed_);
    ending_ = !in.rst && !in.load && (ends || (ending_ && !over));
    was_slot_ = in.slot;
    out_.slots = forget || ends ? 0 : (out_.slots + (counts ? 1U : 0U)) & 0xFFFFFFU;
    out_.executed = in.rst || in.load ? 0 : out_.executed + (over ? 1U : 0U);
    return out_;
  }

 private:
  Outputs out_;
  bool next_framed_ = false;
  bool framed_ = false;
  bool midway_ = false;
  bool ending_ = false;
  bool was_slot_ = false;
};

}  // namespace gravure::fpga
