#pragma once

#include <cstdint>

#include "gravure/fpga/line_fifo.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/increment_schedule.v (32 bits, 2^address_bits segments): loads the next increment
/// exactly `clocks` clocks after the last, for spin-up and spin-down without a gap. The last increment stays in force.
/// Latency (latencies.hpp): kScheduleLatency.
class IncrementSchedule {
 public:
  explicit IncrementSchedule(int address_bits = 8) : segments_(address_bits) {}

  struct Inputs {
    bool rst = false;
    bool flush = false;
    bool run = false;
    bool push = false;
    std::uint32_t push_increment = 0;
    std::uint32_t push_clocks = 0;  ///< 0 acts as 1
  };
  struct Outputs {
    bool load_increment = false;
    bool busy = false;
    bool full = false;
    bool overflow = false;  ///< sticky until flush
    std::uint32_t increment = 0;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    const bool due = in.run && left_ <= 1;
    const bool next = due && list_.valid;
    const std::uint64_t segment = list_.data;
    list_ = segments_.step({.rst = in.rst,
                            .flush = in.flush,
                            .push = in.push,
                            .commit = true,
                            .pop = next,
                            .push_data = (std::uint64_t{in.push_increment} << 32U) | in.push_clocks});
    out_.full = list_.full;
    out_.overflow = list_.overflow;
    if (in.rst || in.flush) {
      left_ = 0;
      return out_ = {};
    }
    out_.load_increment = next;
    out_.busy = next || (out_.busy && !due);
    if (next) {
      out_.increment = static_cast<std::uint32_t>(segment >> 32U);
      left_ = static_cast<std::uint32_t>(segment);
    } else if (in.run && left_ != 0) {
      --left_;
    }
    return out_;
  }

 private:
  friend class SynchroEvents;

  TrialFifo<std::uint64_t> segments_;
  TrialFifo<std::uint64_t>::Outputs list_;
  std::uint32_t left_ = 0;
  Outputs out_;
};

}  // namespace gravure::fpga
