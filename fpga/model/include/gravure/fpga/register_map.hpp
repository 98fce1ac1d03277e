#pragma once

// clang-format off
// Made by fpga/regs/generate.py from registers.txt; change that file.

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
    "version", 0x1, 32, 0x01, RegisterAccess::read_only};
inline constexpr Register kCounterBitsRegister{
    "counter_bits", 0x20, 8, 0x02, RegisterAccess::read_only};
inline constexpr Register kFifoBitsRegister{
    "fifo_bits", 0xc, 8, 0x03, RegisterAccess::read_only};
inline constexpr Register kClockMultiplierRegister{
    "clock_multiplier", 0x2, 8, 0x04, RegisterAccess::read_only};
inline constexpr Register kControlRegister{
    "control", 0x0, 3, 0x10, RegisterAccess::read_write};
inline constexpr Register kCommandRegister{
    "command", 0x0, 4, 0x11, RegisterAccess::write_only};
inline constexpr Register kStatusRegister{
    "status", 0x0, 8, 0x12, RegisterAccess::read_only};
inline constexpr Register kFifoLevelRegister{
    "fifo_level", 0x0, 16, 0x13, RegisterAccess::read_only};
inline constexpr Register kIncrementRegister{
    "increment", 0x0, 32, 0x20, RegisterAccess::read_write};
inline constexpr Register kPrescalerRegister{
    "prescaler", 0x1, 32, 0x22, RegisterAccess::read_write};
inline constexpr Register kFractionNumRegister{
    "fraction_num", 0x0, 34, 0x24, RegisterAccess::read_write};
inline constexpr Register kFractionDenRegister{
    "fraction_den", 0x1, 34, 0x26, RegisterAccess::read_write};
inline constexpr Register kTicksPerSlotRegister{
    "ticks_per_slot", 0x1, 16, 0x30, RegisterAccess::read_write};
inline constexpr Register kSlotsPerLineRegister{
    "slots_per_line", 0x0, 16, 0x31, RegisterAccess::read_write};
inline constexpr Register kWindowSlotsRegister{
    "window_slots", 0x0, 16, 0x32, RegisterAccess::read_write};
inline constexpr Register kSlotsPerMicrovectorRegister{
    "slots_per_microvector", 0x1, 16, 0x33, RegisterAccess::read_write};
inline constexpr Register kLinesPerRevolutionRegister{
    "lines_per_revolution", 0x1, 32, 0x34, RegisterAccess::read_write};
inline constexpr Register kPositionRevolutionRegister{
    "position_revolution", 0x0, 32, 0x36, RegisterAccess::read_write};
inline constexpr Register kPositionLineRegister{
    "position_line", 0x0, 32, 0x37, RegisterAccess::read_write};
inline constexpr Register kSilenceLimitRegister{
    "silence_limit", 0xfa3e80, 32, 0x38, RegisterAccess::read_write};

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
    kIncrementRegister,
    kPrescalerRegister,
    kFractionNumRegister,
    kFractionDenRegister,
    kTicksPerSlotRegister,
    kSlotsPerLineRegister,
    kWindowSlotsRegister,
    kSlotsPerMicrovectorRegister,
    kLinesPerRevolutionRegister,
    kPositionRevolutionRegister,
    kPositionLineRegister,
    kSilenceLimitRegister,
};

}  // namespace gravure::fpga
