#pragma once

#include <array>
#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/increment_schedule.v (32 bits, 16 segments): loads the next increment exactly `clocks`
/// clocks after the last, for spin-up and spin-down without a gap. The last increment stays in force.
class IncrementSchedule {
 public:
  static constexpr std::uint64_t kSegments = 16;

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
  };

  Outputs step(const Inputs& in) noexcept {
    if (in.rst || in.flush) {
      written_ = taken_ = 0;
      left_ = 0;
      return out_ = {};
    }
    const bool due = in.run && left_ <= 1;
    const bool next = due && written_ != taken_;
    const bool full = written_ - taken_ == kSegments;
    out_.load_increment = next;
    out_.busy = next || (out_.busy && !due);
    out_.overflow = out_.overflow || (in.push && full);
    if (next) {
      const Segment& segment = segments_[taken_++ % kSegments];
      out_.increment = segment.increment;
      left_ = segment.clocks;
    } else if (in.run && left_ != 0) {
      --left_;
    }
    if (in.push && !full) {
      segments_[written_++ % kSegments] = {in.push_increment, in.push_clocks};
    }
    out_.full = written_ - taken_ == kSegments;
    return out_;
  }

 private:
  struct Segment {
    std::uint32_t increment = 0;
    std::uint32_t clocks = 0;
  };
  std::array<Segment, kSegments> segments_{};
  std::uint64_t written_ = 0;
  std::uint64_t taken_ = 0;
  std::uint32_t left_ = 0;
  Outputs out_;
};

}  // namespace gravure::fpga
