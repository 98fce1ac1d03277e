#include "gravure/fpga/register_read.hpp"

#include "gravure/fpga/descriptor_rom.hpp"

namespace gravure::fpga {
namespace {

constexpr std::uint32_t high_word(std::uint64_t value) noexcept {
  return static_cast<std::uint32_t>(value >> 32U);
}

std::uint32_t of_axes(std::uint8_t address, const Settings::Outputs& s) noexcept {
  switch (address) {
    case kIncrementRegister.address:
      return s.increment;
    case kPrescalerRegister.address:
      return s.prescaler;
    case kFractionNumRegister.address:
      return static_cast<std::uint32_t>(s.fraction_num);
    case kFractionNumRegister.address + 1:
      return high_word(s.fraction_num);
    case kFractionDenRegister.address:
      return static_cast<std::uint32_t>(s.fraction_den);
    case kFractionDenRegister.address + 1:
      return high_word(s.fraction_den);
    case kIncrement1Register.address:
      return s.increment_1;
    case kPrescaler1Register.address:
      return s.prescaler_1;
    case kFractionNum1Register.address:
      return static_cast<std::uint32_t>(s.fraction_num_1);
    case kFractionNum1Register.address + 1:
      return high_word(s.fraction_num_1);
    case kFractionDen1Register.address:
      return static_cast<std::uint32_t>(s.fraction_den_1);
    case kFractionDen1Register.address + 1:
      return high_word(s.fraction_den_1);
    default:
      return 0;
  }
}

std::uint32_t of_lines(std::uint8_t address, const Settings::Outputs& s) noexcept {
  switch (address) {
    case kSeedsPerSlotRegister.address:
      return s.seeds_per_slot;
    case kSlotsPerLineRegister.address:
      return s.slots_per_line;
    case kWindowSlotsRegister.address:
      return s.window_slots;
    case kSlotsPerMicrovectorRegister.address:
      return s.slots_per_microvector;
    case kLinesPerRevolutionRegister.address:
      return s.lines_per_revolution;
    case kPositionRevolutionRegister.address:
      return s.position_revolution;
    case kPositionLineRegister.address:
      return s.position_line;
    case kSilenceLimitRegister.address:
      return s.silence_limit;
    case kFirstTickRegister.address:
      return s.first_tick;
    case kReverseDelayRegister.address:
      return s.reverse_delay;
    case kLowLevelRegister.address:
      return s.low_level;
    case kCorrectionLimitRegister.address:
      return s.correction_limit;
    case kIndexWindowRegister.address:
      return s.index_window;
    case kRevolutionSeedsRegister.address:
      return static_cast<std::uint32_t>(s.revolution_seeds);
    case kRevolutionSeedsRegister.address + 1:
      return high_word(s.revolution_seeds);
    case kScheduleIncrementRegister.address:
      return s.schedule_increment;
    case kScheduleSeedsRegister.address:
      return s.schedule_seeds;
    default:
      return 0;
  }
}

}  // namespace

std::uint32_t RegisterRead::of_board(const Inputs& in) const noexcept {
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
    case kControlRegister.address:
      return in.settings.control;
    case kStatusRegister.address:
      return in.status;
    case kFifoLevelRegister.address:
      return in.level;
    case kFaultsRegister.address:
      return in.faults;
    case kIndexErrorRegister.address:
      return (in.index_error & 0x20000U) != 0 ? in.index_error | 0xFFFC0000U : in.index_error;
    default:
      return 0;
  }
}

std::uint32_t RegisterRead::value(const Inputs& in) const noexcept {
  if ((in.address & 0xC0U) == kDescriptorRegister.address) {
    return DescriptorRom::step({.number = in.address}).word;
  }
  return of_board(in) | of_axes(in.address, in.settings) | of_lines(in.address, in.settings);
}

}  // namespace gravure::fpga
