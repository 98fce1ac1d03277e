#include "gravure/fpga/register_read.hpp"

#include "gravure/fpga/descriptor_rom.hpp"

namespace gravure::fpga {

void RegisterRead::forget() noexcept {
  for (const StoredWord& word : kStoredWords) {
    stored_[word.address] = word.reset;
  }
}

RegisterRead::Outputs RegisterRead::step(const Inputs& in) noexcept {
  const Outputs out{.read_data = in.rst ? 0 : value_};
  value_ = value(in);
  if (in.rst) {
    forget();
  } else if (in.store) {
    stored_[in.store_address] = in.store_data;
  }
  return out;
}

std::uint32_t RegisterRead::value(const Inputs& in) const noexcept {
  if ((in.address & 0xC0U) == kDescriptorRegister.address) {
    return DescriptorRom::step({.number = in.address}).word;
  }
  switch (in.address) {
    case kMagicRegister.address:
      return kMagicRegister.reset;
    case kVersionRegister.address:
      return kVersionRegister.reset;
    case kCounterBitsRegister.address:
      return kCounterBitsRegister.reset;
    case kFifoBitsRegister.address:
      return static_cast<std::uint32_t>(fifo_bits_);
    case kClockMultiplierRegister.address:
      return kClockMultiplierRegister.reset;
    case kStatusRegister.address:
      return in.status;
    case kFifoLevelRegister.address:
      return in.level;
    case kFaultsRegister.address:
      return in.faults;
    case kIndexErrorRegister.address:
      return (in.index_error & 0x20000U) != 0 ? in.index_error | 0xFFFC0000U : in.index_error;
    case kExecutedLinesRegister.address:
      return in.executed_lines;
    case kClosedSlotRegister.address:
      return in.closed_slot;
    default:
      return stored_[in.address];
  }
}

}  // namespace gravure::fpga
