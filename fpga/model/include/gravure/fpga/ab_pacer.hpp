#pragma once

#include <cstdint>

#include "gravure/fpga/latencies.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/ab_pacer.v: on which of the next two FPGA clocks a counter steps, and by how much. One
/// step() is one rising edge of the seed clock. Values wider than their register are cut to it, like wires.
class AbPacer {
 public:
  /// Seed clocks from the one that takes a load to the one after which its first word shows; one of less than that many
  /// later is refused.
  static constexpr int kLoadClocks = fpga::kLoadClocks;
  static constexpr int kDueLatency = fpga::kDueLatency;    ///< the same, from `enable`
  static constexpr int kStepLatency = fpga::kStepLatency;  ///< the same, from `load_increment`

  struct Widths {
    int bits = 32;
    int prescaler_bits = 32;
    int fraction_bits = 34;
    bool fraction = true;  ///< false: a load with a fraction is refused
    int segment_bits = 8;  ///< of AbAccumulator
  };
  struct Inputs {
    bool rst = false;
    bool enable = false;          ///< low: everything stands
    bool load = false;            ///< takes all registers, starts a new count of clocks, keeps the counter
    bool backward = false;        ///< the way the edges shall run; taken by a load alone
    bool load_increment = false;  ///< takes the increment alone, without a gap
    std::uint64_t increment = 0;
    std::uint64_t prescaler = 0;
    std::uint64_t fraction_num = 0;
    std::uint64_t fraction_den = 0;
  };
  struct Outputs {
    unsigned due = 0;    ///< bit 0: the first of the two FPGA clocks steps, bit 1: the second does
    unsigned carry = 0;  ///< and by one more
    std::uint64_t step = 0;
    bool back = false;     ///< and the edges run backward
    bool refused = false;  ///< the last load would have broken a rule and changed nothing
    bool busy = false;     ///< a load is under way
  };

  explicit AbPacer(const Widths& widths) noexcept;
  Outputs step(const Inputs& inputs) noexcept;

 private:
  friend class AxisTrack;

  /// A load on its way into force.
  struct Load {
    std::uint64_t step = 0;
    bool back = false;
    std::uint64_t period = 0;
    std::uint64_t num = 0;
    std::uint64_t den = 0;
    bool over = false;
    bool quarter = false;
    bool zero = false;
    bool one = false;
    std::uint64_t period_less = 0;
    std::uint64_t rest = 0;  ///< den - num
    bool improper = false;   ///< num > den
    bool num_zero = false;
    std::uint64_t twice = 0;  ///< 2 num - den
    bool wraps = false;       ///< and it is not negative
    std::uint64_t num_2 = 0;  ///< 2 num mod den
    std::uint64_t rest_2 = 0;
    bool ok = false;
  };

  void words(const Inputs& in) noexcept;
  void fraction() noexcept;
  void pace(bool enable) noexcept;
  void check_load(const Inputs& in) noexcept;
  bool loading(int stage) const noexcept { return ((loading_ >> static_cast<unsigned>(stage)) & 1U) != 0; }
  bool over(std::uint64_t increment) const noexcept { return increment > quarter_; }

  std::uint64_t count_mask_;
  std::uint64_t prescaler_mask_;
  std::uint64_t fraction_mask_;
  std::uint64_t quarter_;
  bool with_fraction_;

  unsigned loading_ = 0;
  Load load_;
  std::uint64_t next_step_ = 0;
  bool next_step_ok_ = false;
  bool next_step_bad_ = false;
  bool has_fraction_ = false;

  std::uint64_t left_ = 1;
  std::uint64_t period_ = 1;
  std::uint64_t period_less_ = 0;
  bool every_ = true;
  unsigned pace_due_ = 0;
  unsigned add_due_ = 0;
  unsigned word_due_ = 0;

  std::uint64_t x_ = 0;
  std::uint64_t y_ = 0;
  std::uint64_t addend_ = 0;
  std::uint64_t below_ = 1;
  bool two_ = true;
  std::uint64_t add_x_ = 0;
  std::uint64_t add_y_ = 0;
  std::uint64_t num_ = 0;
  unsigned less_ = 0;
  Outputs out_;
};

}  // namespace gravure::fpga
