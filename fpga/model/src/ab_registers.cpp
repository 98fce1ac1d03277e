#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga {

std::uint64_t max_increment(const AbRegisters& registers) noexcept {
  const std::uint64_t quarter = std::uint64_t{1} << static_cast<unsigned>(registers.bits - 2);
  return registers.fraction_num == 0 ? quarter : quarter - 1;
}

AbRefusal check(const AbRegisters& registers) noexcept {
  if (registers.bits < kMinCounterBits || registers.bits > kMaxCounterBits) {
    return AbRefusal::bits;
  }
  if (registers.prescaler == 0) {
    return AbRefusal::prescaler;
  }
  if (registers.fraction_den == 0) {
    return AbRefusal::fraction_den;
  }
  if (registers.fraction_num >= registers.fraction_den) {
    return AbRefusal::fraction_num;
  }
  return registers.increment > max_increment(registers) ? AbRefusal::increment : AbRefusal::none;
}

}  // namespace gravure::fpga
