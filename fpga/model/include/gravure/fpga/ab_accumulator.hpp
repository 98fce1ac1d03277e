#pragma once

#include <cstdint>

#include "gravure/fpga/ab_pacer.hpp"
#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/ab_accumulator.v: the counter and its pins. One step() is one rising edge of the FPGA
/// clock, two a seed clock. The segments of the Verilog show here as a delay of the pins alone.
class AbAccumulator {
 public:
  struct Inputs {
    bool clear = false;
    bool beat = false;   ///< turns over with every seed clock
    unsigned due = 0;    ///< two bits, as AbPacer gives them
    unsigned carry = 0;  ///< two bits
    std::uint64_t step = 0;
    bool back = false;  ///< edges run backward; to turn makes none
  };
  using Outputs = AbPins;

  /// FPGA clocks from the seed clock that shows a word to the pins, for its first bit.
  static constexpr int word_latency(const AbPacer::Widths& widths) noexcept {
    return kWordStages + widths.bits / widths.segment_bits;
  }

  explicit AbAccumulator(const AbPacer::Widths& widths) noexcept
      : mask_(~std::uint64_t{0} >> static_cast<unsigned>(64 - widths.bits)),
        quarter_shift_(static_cast<unsigned>(widths.bits - 2)),
        top_shift_(2U * static_cast<unsigned>(widths.bits / widths.segment_bits - 1)) {}

  Outputs step(const Inputs& in) noexcept {
    if (now_.clear) {
      out_ = {};
      count_ = turns_ = add_ = 0;
      add_back_ = false;
    } else {
      out_ = pins_of_quarter(turns_ >> top_shift_);
      const std::uint64_t quarter = count_ >> quarter_shift_;
      count_ = (count_ + add_) & mask_;
      show_turn((count_ >> quarter_shift_) - quarter);
      add_ = now_.due ? now_.step + (now_.carry ? 1U : 0U) : 0U;
      add_back_ = now_.back;
    }
    const unsigned bit = in.beat != was_beat_ ? 0 : 1;
    was_beat_ = in.beat;
    now_ = {.clear = in.clear,
            .due = ((in.due >> bit) & 1U) != 0,
            .carry = ((in.carry >> bit) & 1U) != 0,
            .back = in.back,
            .step = in.step & mask_};
    return out_;
  }

 private:
  friend class AxisTrack;

  struct Now {
    bool clear = false;
    bool due = false;
    bool carry = false;
    bool back = false;
    std::uint64_t step = 0;
  };
  /// Quarter turns there and back, the pins' own.
  void show_turn(std::uint64_t moved) noexcept {
    turns_ = (turns_ << 2U) | ((add_back_ ? turns_ - moved : turns_ + moved) & 3U);
  }

  std::uint64_t mask_;
  unsigned quarter_shift_;
  unsigned top_shift_;
  bool was_beat_ = false;
  Now now_;
  std::uint64_t add_ = 0;
  bool add_back_ = false;
  std::uint64_t count_ = 0;  ///< as the lowest segment has it
  std::uint64_t turns_ = 0;  ///< two bits a clock, the latest lowest; the leading segment shows an older pair
  Outputs out_;
};

}  // namespace gravure::fpga
