#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/line_fifo.v (W bits of Word): words on trial until commit, forgotten by rollback; only
/// committed ones are read. `data` means nothing while `valid` is low.
/// Latency (latencies.hpp): kLevelLatency, kAlmostEmptyLatency.
template <class Word>
class TrialFifo {
 public:
  struct Inputs {
    bool rst = false;
    bool flush = false;
    bool push = false;
    bool commit = false;
    bool rollback = false;
    bool pop = false;
    Word push_data = 0;
    std::uint32_t low_level = 0;
  };
  struct Outputs {
    bool valid = false;
    Word data = 0;
    std::uint32_t level = 0;   ///< committed and not yet popped, LEVEL_LATENCY clocks ago
    bool almost_empty = true;  ///< level was low_level or less, one clock later
    bool full = false;
    bool overflow = false;  ///< sticky until flush
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  explicit TrialFifo(int address_bits) : memory_(std::size_t{1} << static_cast<unsigned>(address_bits)) {}

  Outputs step(const Inputs& in) noexcept {
    const std::size_t mask = memory_.size() - 1;
    const bool full = written_ - taken_ == memory_.size();
    const bool refill = (!out_.valid || in.pop) && committed_ != taken_;
    if (refill) {
      out_.data = memory_[taken_ & mask];
    }
    out_.almost_empty = out_.level <= in.low_level;
    out_.level = static_cast<std::uint32_t>(committed_ - taken_) + (out_.valid ? 1U : 0U);
    if (in.rst || in.flush) {
      written_ = committed_ = taken_ = 0;
      out_ = {.data = out_.data, .almost_empty = out_.almost_empty};
      return out_;
    }
    const std::uint64_t before_push = written_;
    if (in.rollback) {
      written_ = committed_;
    } else if (in.push && !full) {
      memory_[written_++ & mask] = in.push_data;
    } else if (in.push) {
      out_.overflow = true;
    }
    if (in.commit && !in.rollback) {
      committed_ = before_push;
    }
    taken_ += refill ? 1 : 0;
    out_.valid = refill || (out_.valid && !in.pop);
    out_.full = written_ - taken_ == memory_.size();
    return out_;
  }

 private:
  std::vector<Word> memory_;
  std::uint64_t written_ = 0;
  std::uint64_t committed_ = 0;
  std::uint64_t taken_ = 0;
  Outputs out_;
};

/// The bytes of lines.
using LineFifo = TrialFifo<std::uint8_t>;
/// First slot and, in bit 16, direction of whole lines.
using LineQueue = TrialFifo<std::uint32_t>;

}  // namespace gravure::fpga
