#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/pulse_gate.v: the gate for one slot at a time, from bytes of a show-ahead FIFO, most
/// significant bit first. Fails dark on a fault or a missing bit until clear, and then until a line begins.
/// (PulseGate is the gate as a whole line sees it, without the FIFO.)
/// Latency (latencies.hpp): kGateLatency.
class SlotGate {
 public:
  struct Inputs {
    bool rst = false;
    bool run = false;
    bool clear = false;
    bool fault = false;
    bool slot = false;
    bool decision = false;
    bool window = false;
    bool first = false;
    bool last = false;
    bool byte_valid = false;
    std::uint8_t byte_data = 0;
  };
  struct Outputs {
    bool gate = false;
    bool byte_take = false;
    bool underrun = false;  ///< sticky until clear
    bool dark = false;
    bool passed = false;  ///< the decision of a slot was let through; those of a line are its first ones
    bool open = false;    ///< and the next one of this line will be; low from its last
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst || in.clear) {
      next_valid_ = false;
      left_ = 0;
      return out_ = {.dark = in.rst || in.fault};
    }
    const bool closed = out_.dark || in.fault;
    const bool line_open = in.first || out_.open;
    const bool wanted = in.slot && in.decision && in.window && line_open && !closed && in.run;
    const bool starved = wanted && left_ == 0 && !next_valid_;
    const bool passes = in.slot && in.decision && line_open && !closed && !starved && in.run;
    const bool fetch = !next_valid_ && in.byte_valid && !out_.byte_take;
    if (closed || !in.run) {
      out_.gate = false;
    } else if (in.slot) {
      out_.gate = wanted && !starved && take_bit();
    }
    out_.dark = out_.dark || in.fault || starved;
    out_.underrun = out_.underrun || starved;
    if (closed || starved || !in.run) {
      out_.open = false;
    } else if (in.slot && in.decision) {
      out_.open = line_open && !in.last;
    }
    out_.passed = passes;
    out_.byte_take = fetch;
    if (fetch) {
      next_ = in.byte_data;
      next_valid_ = true;
    }
    if (in.slot && in.decision && in.last) {
      left_ = 0;  // the next line starts on a fresh byte
    }
    return out_;
  }

 private:
  bool take_bit() noexcept {
    if (left_ == 0) {
      bits_ = next_;
      next_valid_ = false;
      left_ = 8;
    }
    --left_;
    return ((bits_ >> static_cast<unsigned>(left_)) & 1U) != 0;
  }

  Outputs out_;
  bool next_valid_ = false;
  int left_ = 0;
  unsigned bits_ = 0;
  std::uint8_t next_ = 0;
};

}  // namespace gravure::fpga
