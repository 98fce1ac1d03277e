#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gravure/core/line_device.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/frame.hpp"

namespace gravure::emulator::test {

inline constexpr std::size_t kFrame = protocol::kFrameBytes + 2;  ///< bytes, of wire_setup()

/// Bits of the registers control and command.
inline constexpr std::uint32_t kRunTimed = 1U | 2U | 8U | 16U;  // slots, both axes, from first_tick on
inline constexpr std::uint32_t kWatch = 4;
inline constexpr std::uint32_t kAcknowledge = 1;
inline constexpr std::uint32_t kLoadBoth = 2U | 16U;
inline constexpr std::uint32_t kPosition = 8;
inline constexpr std::uint32_t kGo = 64;

struct Write {
  std::uint8_t address;
  std::uint32_t value;
};

/// 3 revolutions of 4 lines of 20 slots of 2 seed clocks, 13 of them in the window.
inline DeviceSetup wire_setup() {
  return {.counter_bits = 32,
          .prescaler = 2,
          .increment = 700'000'000,
          .fraction_num = 5,
          .fraction_den = 7,
          .clock_multiplier = 2,
          .ticks_per_slot = 4,
          .slots_per_line = 20,
          .window_slots = 13,
          .lines_per_revolution = 4,
          .end_revolution = 3};
}

inline void add_write(std::vector<Write>& writes, const fpga::Register& target, std::uint64_t value) {
  writes.push_back({target.address, static_cast<std::uint32_t>(value)});
  if (target.bits > 32) {
    writes.push_back({static_cast<std::uint8_t>(target.address + 1), static_cast<std::uint32_t>(value >> 32U)});
  }
}

/// All that a host writes before the stream, without control and go.
inline std::vector<Write> preparation(const DeviceSetup& setup, std::uint32_t first_tick) {
  std::vector<Write> writes;
  const auto put = [&](const fpga::Register& target, auto value) {
    add_write(writes, target, static_cast<std::uint64_t>(value));
  };
  put(fpga::kControlRegister, 0);
  put(fpga::kCommandRegister, kAcknowledge);
  put(fpga::kIncrementRegister, setup.increment);
  put(fpga::kPrescalerRegister, setup.prescaler);
  put(fpga::kFractionNumRegister, setup.fraction_num);
  put(fpga::kFractionDenRegister, setup.fraction_den);
  put(fpga::kIncrement1Register, setup.carriage.increment);
  put(fpga::kPrescaler1Register, setup.carriage.prescaler);
  put(fpga::kCommandRegister, kLoadBoth);
  put(fpga::kSeedsPerSlotRegister, setup.ticks_per_slot / setup.clock_multiplier);
  put(fpga::kSlotsPerLineRegister, setup.slots_per_line);
  put(fpga::kWindowSlotsRegister, setup.window_slots);
  put(fpga::kLinesPerRevolutionRegister, setup.lines_per_revolution);
  put(fpga::kPositionRevolutionRegister, setup.first_revolution);
  put(fpga::kPositionLineRegister, setup.first_line);
  put(fpga::kCommandRegister, kPosition);
  put(fpga::kFirstTickRegister, first_tick);
  return writes;
}

/// Bits of a line of its own; its window begins at `first_slot`.
struct WireLine {
  std::uint32_t first_slot = 0;
  std::vector<std::byte> bits;
};

inline WireLine wire_line(const DeviceSetup& setup, std::int64_t ordinal) {
  const auto slots = static_cast<std::size_t>(setup.window_slots);
  const auto free = static_cast<std::uint64_t>(setup.slots_per_line - setup.window_slots + 1);
  WireLine line{static_cast<std::uint32_t>(static_cast<std::uint64_t>(ordinal) % free),
                std::vector<std::byte>((slots + 7) / 8)};
  std::uint32_t noise = 0x9E37'79B9U * static_cast<std::uint32_t>(ordinal + 1);
  for (std::byte& byte : line.bits) {
    noise = noise * 1'664'525U + 1'013'904'223U;
    byte = static_cast<std::byte>(noise >> 24U);
  }
  if (slots % 8 != 0) {
    line.bits.back() &= static_cast<std::byte>(0xFF00U >> (slots % 8));
  }
  return line;
}

/// The frame of that line, `sequence` frames after the position.
inline void add_frame(std::vector<std::byte>& stream, const DeviceSetup& setup, std::int64_t ordinal,
                      std::uint32_t sequence) {
  const WireLine line = wire_line(setup, ordinal);
  protocol::append_frame(stream,
                         {.sequence = sequence,
                          .revolution = static_cast<std::uint32_t>(ordinal / setup.lines_per_revolution),
                          .line = static_cast<std::uint32_t>(ordinal % setup.lines_per_revolution),
                          .first_slot = line.first_slot},
                         line.bits);
}

/// Lines first .. last, from the first on that comes after the position.
inline std::vector<std::byte> wire_stream(const DeviceSetup& setup, std::int64_t first, std::int64_t last) {
  std::vector<std::byte> stream;
  for (std::int64_t ordinal = first; ordinal <= last; ++ordinal) {
    add_frame(stream, setup, ordinal, static_cast<std::uint32_t>(ordinal - first));
  }
  return stream;
}

}  // namespace gravure::emulator::test
