#pragma once

// clang-format off
// Made by fpga/regs/generate.py from registers.txt; change that file.

#include <array>
#include <cstdint>
#include <string_view>

namespace gravure::fpga {

enum class RegisterAccess : std::uint8_t { read_only, read_write, write_only };

/// One register of the board; docs/registers.md explains them.
struct Register {
  std::string_view name;
  std::uint64_t reset;
  int bits;
  std::uint8_t address;  ///< of its low 32-bit word
  RegisterAccess access;
};

inline constexpr Register kMagicRegister{
    "magic", 0x47524156, 32, 0x00, RegisterAccess::read_only};
inline constexpr Register kVersionRegister{
    "version", 0x4, 32, 0x01, RegisterAccess::read_only};
inline constexpr Register kCounterBitsRegister{
    "counter_bits", 0x20, 8, 0x02, RegisterAccess::read_only};
inline constexpr Register kFifoBitsRegister{
    "fifo_bits", 0xc, 8, 0x03, RegisterAccess::read_only};
inline constexpr Register kClockMultiplierRegister{
    "clock_multiplier", 0x2, 8, 0x04, RegisterAccess::read_only};
inline constexpr Register kControlRegister{
    "control", 0x0, 9, 0x10, RegisterAccess::read_write};
inline constexpr Register kCommandRegister{
    "command", 0x0, 10, 0x11, RegisterAccess::write_only};
inline constexpr Register kStatusRegister{
    "status", 0x0, 16, 0x12, RegisterAccess::read_only};
inline constexpr Register kFifoLevelRegister{
    "fifo_level", 0x0, 16, 0x13, RegisterAccess::read_only};
inline constexpr Register kFaultsRegister{
    "faults", 0x0, 6, 0x14, RegisterAccess::read_only};
inline constexpr Register kIndexErrorRegister{
    "index_error", 0x0, 32, 0x15, RegisterAccess::read_only};
inline constexpr Register kExecutedLinesRegister{
    "executed_lines", 0x0, 32, 0x16, RegisterAccess::read_only};
inline constexpr Register kClosedSlotRegister{
    "closed_slot", 0x0, 32, 0x17, RegisterAccess::read_only};
inline constexpr Register kIncrementRegister{
    "increment", 0x0, 32, 0x20, RegisterAccess::read_write};
inline constexpr Register kPrescalerRegister{
    "prescaler", 0x1, 32, 0x22, RegisterAccess::read_write};
inline constexpr Register kFractionNumRegister{
    "fraction_num", 0x0, 34, 0x24, RegisterAccess::read_write};
inline constexpr Register kFractionDenRegister{
    "fraction_den", 0x1, 34, 0x26, RegisterAccess::read_write};
inline constexpr Register kIncrement1Register{
    "increment_1", 0x0, 32, 0x28, RegisterAccess::read_write};
inline constexpr Register kPrescaler1Register{
    "prescaler_1", 0x1, 32, 0x2a, RegisterAccess::read_write};
inline constexpr Register kFractionNum1Register{
    "fraction_num_1", 0x0, 34, 0x2c, RegisterAccess::read_write};
inline constexpr Register kFractionDen1Register{
    "fraction_den_1", 0x1, 34, 0x2e, RegisterAccess::read_write};
inline constexpr Register kSeedsPerSlotRegister{
    "seeds_per_slot", 0x1, 16, 0x30, RegisterAccess::read_write};
inline constexpr Register kSlotsPerLineRegister{
    "slots_per_line", 0x0, 24, 0x31, RegisterAccess::read_write};
inline constexpr Register kWindowSlotsRegister{
    "window_slots", 0x0, 24, 0x32, RegisterAccess::read_write};
inline constexpr Register kSlotsPerMicrovectorRegister{
    "slots_per_microvector", 0x1, 24, 0x33, RegisterAccess::read_write};
inline constexpr Register kLinesPerRevolutionRegister{
    "lines_per_revolution", 0x1, 32, 0x34, RegisterAccess::read_write};
inline constexpr Register kPositionRevolutionRegister{
    "position_revolution", 0x0, 32, 0x36, RegisterAccess::read_write};
inline constexpr Register kPositionLineRegister{
    "position_line", 0x0, 32, 0x37, RegisterAccess::read_write};
inline constexpr Register kSilenceLimitRegister{
    "silence_limit", 0x7d1f40, 32, 0x38, RegisterAccess::read_write};
inline constexpr Register kFirstTickRegister{
    "first_tick", 0x0, 32, 0x39, RegisterAccess::read_write};
inline constexpr Register kReverseDelayRegister{
    "reverse_delay", 0x0, 16, 0x3a, RegisterAccess::read_write};
inline constexpr Register kLowLevelRegister{
    "low_level", 0x0, 16, 0x3b, RegisterAccess::read_write};
inline constexpr Register kCorrectionLimitRegister{
    "correction_limit", 0x0, 8, 0x3c, RegisterAccess::read_write};
inline constexpr Register kIndexWindowRegister{
    "index_window", 0x0, 16, 0x3d, RegisterAccess::read_write};
inline constexpr Register kRevolutionSeedsRegister{
    "revolution_seeds", 0x0, 48, 0x3e, RegisterAccess::read_write};
inline constexpr Register kScheduleIncrementRegister{
    "schedule_increment", 0x0, 32, 0x40, RegisterAccess::read_write};
inline constexpr Register kScheduleSeedsRegister{
    "schedule_seeds", 0x1, 32, 0x41, RegisterAccess::read_write};
inline constexpr Register kDescriptorRegister{
    "descriptor", 0x0, 32, 0x80, RegisterAccess::read_only};

/// What a register of a board may say, where boards differ.
struct RegisterRange {
  std::int64_t low;
  std::int64_t high;
};
inline constexpr RegisterRange kCounterBitsRange{8, 64};
inline constexpr RegisterRange kFifoBitsRange{4, 16};
inline constexpr RegisterRange kClockMultiplierRange{1, 16};

/// The largest value that fits.
constexpr std::uint64_t largest(const Register& one) noexcept {
  return (std::uint64_t{1} << static_cast<unsigned>(one.bits)) - 1;
}

inline constexpr Register kRegisters[] = {
    kMagicRegister,
    kVersionRegister,
    kCounterBitsRegister,
    kFifoBitsRegister,
    kClockMultiplierRegister,
    kControlRegister,
    kCommandRegister,
    kStatusRegister,
    kFifoLevelRegister,
    kFaultsRegister,
    kIndexErrorRegister,
    kExecutedLinesRegister,
    kClosedSlotRegister,
    kIncrementRegister,
    kPrescalerRegister,
    kFractionNumRegister,
    kFractionDenRegister,
    kIncrement1Register,
    kPrescaler1Register,
    kFractionNum1Register,
    kFractionDen1Register,
    kSeedsPerSlotRegister,
    kSlotsPerLineRegister,
    kWindowSlotsRegister,
    kSlotsPerMicrovectorRegister,
    kLinesPerRevolutionRegister,
    kPositionRevolutionRegister,
    kPositionLineRegister,
    kSilenceLimitRegister,
    kFirstTickRegister,
    kReverseDelayRegister,
    kLowLevelRegister,
    kCorrectionLimitRegister,
    kIndexWindowRegister,
    kRevolutionSeedsRegister,
    kScheduleIncrementRegister,
    kScheduleSeedsRegister,
    kDescriptorRegister,
};

/// Registers whose range begins with 1: the board refuses a 0.
inline constexpr std::array<std::uint8_t, 6> kNotZeroAddresses{
    kSeedsPerSlotRegister.address,
    kSlotsPerLineRegister.address,
    kSlotsPerMicrovectorRegister.address,
    kLinesPerRevolutionRegister.address,
    kSilenceLimitRegister.address,
    kScheduleSeedsRegister.address,
};

/// The bits of the word at `address` that no register has: the board refuses a write that sets one.
constexpr std::uint32_t unused_bits(unsigned address) noexcept {
  switch (address) {
    case kFractionNumRegister.address + 1:
    case kFractionDenRegister.address + 1:
    case kFractionNum1Register.address + 1:
    case kFractionDen1Register.address + 1:
      return 0xfffffffc;
    case kCorrectionLimitRegister.address:
      return 0xffffff00;
    case kControlRegister.address:
      return 0xfffffe00;
    case kCommandRegister.address:
      return 0xfffffc00;
    case kSeedsPerSlotRegister.address:
    case kReverseDelayRegister.address:
    case kLowLevelRegister.address:
    case kIndexWindowRegister.address:
    case kRevolutionSeedsRegister.address + 1:
      return 0xffff0000;
    case kSlotsPerLineRegister.address:
    case kWindowSlotsRegister.address:
    case kSlotsPerMicrovectorRegister.address:
      return 0xff000000;
    default:
      return 0;
  }
}

/// A word that is read back as it was written, and what it is before that.
struct StoredWord {
  std::uint8_t address;
  std::uint32_t reset;
};
inline constexpr std::array<StoredWord, 30> kStoredWords{{
    {0x10, 0x0},
    {0x20, 0x0},
    {0x22, 0x1},
    {0x24, 0x0},
    {0x25, 0x0},
    {0x26, 0x1},
    {0x27, 0x0},
    {0x28, 0x0},
    {0x2a, 0x1},
    {0x2c, 0x0},
    {0x2d, 0x0},
    {0x2e, 0x1},
    {0x2f, 0x0},
    {0x30, 0x1},
    {0x31, 0x0},
    {0x32, 0x0},
    {0x33, 0x1},
    {0x34, 0x1},
    {0x36, 0x0},
    {0x37, 0x0},
    {0x38, 0x7d1f40},
    {0x39, 0x0},
    {0x3a, 0x0},
    {0x3b, 0x0},
    {0x3c, 0x0},
    {0x3d, 0x0},
    {0x3e, 0x0},
    {0x3f, 0x0},
    {0x40, 0x0},
    {0x41, 0x1},
}};

/// The descriptor ROM from address 0x80 on: kind << 24 | version << 16 | size.
inline constexpr std::array<std::uint32_t, 12> kDescriptors{
    0x01030020,  // A-B generator, axis 0: 32 counter bits
    0x01030020,  // A-B generator, axis 1: 32 counter bits
    0x02010022,  // fraction of axis 0: 34 bits
    0x03020100,  // increment schedule, axis 0: 256 segments
    0x03020100,  // increment schedule, axis 1: 256 segments
    0x0402000c,  // line FIFO: 12 2^size bytes
    0x05020010,  // line queue: 16 lines
    0x06030018,  // slots and lines: 24 bits of np; k has 16
    0x07010010,  // direction delay: 16 bits
    0x08010030,  // index reference: 48 bits of a revolution
    0x09020018,  // scanner clock: 24 bits
    0x0a010020,  // watchdog: 32 bits
};

}  // namespace gravure::fpga
