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
  std::uint8_t address;  ///< of its low 32-bit word
  int bits;
  RegisterAccess access;
  std::uint64_t reset;
};

inline constexpr Register kMagicRegister{
    "magic", 0x00, 32, RegisterAccess::read_only, 0x47524156};
inline constexpr Register kVersionRegister{
    "version", 0x01, 32, RegisterAccess::read_only, 0x1};
inline constexpr Register kCounterBitsRegister{
    "counter_bits", 0x02, 8, RegisterAccess::read_only, 0x20};
inline constexpr Register kFifoBitsRegister{
    "fifo_bits", 0x03, 8, RegisterAccess::read_only, 0xc};
inline constexpr Register kClockMultiplierRegister{
    "clock_multiplier", 0x04, 8, RegisterAccess::read_only, 0x2};
inline constexpr Register kControlRegister{
    "control", 0x10, 3, RegisterAccess::read_write, 0x0};
inline constexpr Register kCommandRegister{
    "command", 0x11, 4, RegisterAccess::write_only, 0x0};
inline constexpr Register kStatusRegister{
    "status", 0x12, 8, RegisterAccess::read_only, 0x0};
inline constexpr Register kFifoLevelRegister{
    "fifo_level", 0x13, 16, RegisterAccess::read_only, 0x0};
inline constexpr Register kIncrementRegister{
    "increment", 0x20, 32, RegisterAccess::read_write, 0x0};
inline constexpr Register kPrescalerRegister{
    "prescaler", 0x22, 32, RegisterAccess::read_write, 0x1};
inline constexpr Register kFractionNumRegister{
    "fraction_num", 0x24, 34, RegisterAccess::read_write, 0x0};
inline constexpr Register kFractionDenRegister{
    "fraction_den", 0x26, 34, RegisterAccess::read_write, 0x1};
inline constexpr Register kTicksPerSlotRegister{
    "ticks_per_slot", 0x30, 16, RegisterAccess::read_write, 0x1};
inline constexpr Register kSlotsPerLineRegister{
    "slots_per_line", 0x31, 16, RegisterAccess::read_write, 0x0};
inline constexpr Register kWindowSlotsRegister{
    "window_slots", 0x32, 16, RegisterAccess::read_write, 0x0};
inline constexpr Register kSlotsPerMicrovectorRegister{
    "slots_per_microvector", 0x33, 16, RegisterAccess::read_write, 0x1};
inline constexpr Register kLinesPerRevolutionRegister{
    "lines_per_revolution", 0x34, 32, RegisterAccess::read_write, 0x1};
inline constexpr Register kPositionRevolutionRegister{
    "position_revolution", 0x36, 32, RegisterAccess::read_write, 0x0};
inline constexpr Register kPositionLineRegister{
    "position_line", 0x37, 32, RegisterAccess::read_write, 0x0};
inline constexpr Register kSilenceLimitRegister{
    "silence_limit", 0x38, 32, RegisterAccess::read_write, 0xfa3e80};

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
