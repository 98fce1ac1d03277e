#include "gravure/fpga/ab_counter.hpp"

#include <limits>

namespace gravure::fpga {

AbCounter::AbCounter(const AbRegisters& registers) noexcept
    : registers_(registers),
      carry_from_(registers.fraction_den - registers.fraction_num),
      mask_(std::numeric_limits<std::uint64_t>::max() >> static_cast<unsigned>(kMaxCounterBits - registers.bits)),
      quarter_shift_(static_cast<unsigned>(registers.bits - 2)) {}

std::optional<AbCounter> AbCounter::make(const AbRegisters& registers) noexcept {
  if (check(registers) != AbRefusal::none) {
    return std::nullopt;
  }
  return AbCounter(registers);
}

}  // namespace gravure::fpga
