#pragma once

#include <cstdint>
#include <optional>

#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga {

/// The A-B generator, clock by clock: one step() is one rising edge of the FPGA clock. The reference that every faster
/// form is compared with.
///
/// Widths: counter `bits`, prescaler phase, accumulator and fraction 64 bits each. The accumulator never leaves
/// 0..den-1: it is compared with den - num before the addition, so the sum needs no 65th bit. A and B come straight
/// from the counter's flip-flops: no latency, no glitch. Reset: all 0.
class AbCounter {
 public:
  /// Nothing where check() refuses the registers.
  static std::optional<AbCounter> make(const AbRegisters& registers) noexcept;

  /// Advances one clock; returns the pins as they stand just after it.
  AbPins step() noexcept {
    ++clock_;
    if (++phase_ == registers_.prescaler) {
      phase_ = 0;
      advance();
    }
    return pins();
  }

  AbPins pins() const noexcept { return pins_of_quarter(counter_ >> quarter_shift_); }
  std::uint64_t clock() const noexcept { return clock_; }
  std::uint64_t counter() const noexcept { return counter_; }
  std::uint64_t accumulator() const noexcept { return accumulator_; }
  const AbRegisters& registers() const noexcept { return registers_; }

 private:
  explicit AbCounter(const AbRegisters& registers) noexcept;

  void advance() noexcept {
    const bool carry = accumulator_ >= carry_from_;
    accumulator_ = carry ? accumulator_ - carry_from_ : accumulator_ + registers_.fraction_num;
    counter_ = (counter_ + registers_.increment + (carry ? 1U : 0U)) & mask_;
  }

  AbRegisters registers_;
  std::uint64_t carry_from_;  ///< den - num
  std::uint64_t mask_;
  unsigned quarter_shift_;
  std::uint64_t clock_ = 0;
  std::uint64_t phase_ = 0;
  std::uint64_t accumulator_ = 0;
  std::uint64_t counter_ = 0;
};

}  // namespace gravure::fpga
