#include "board_registers.hpp"

namespace gravure::emulator {
namespace {

constexpr std::uint16_t kAcknowledge = 1;
constexpr std::uint32_t kLineFifo = 0x04;  // kind of its descriptor

}  // namespace

void BoardRegisters::step(const fpga::Settings::Inputs& in) noexcept {
  settings_now_ = settings_.step(in);
  static_cast<void>(read_.step({.store = settings_now_.store,
                                .store_address = settings_now_.store_address,
                                .store_data = settings_now_.store_data}));
}

std::uint16_t BoardRegisters::write(std::uint8_t address, std::uint32_t value) noexcept {
  step({.write = true, .address = address, .write_data = value});
  step({});
  const std::uint16_t command = settings_now_.command;
  step({.clear = (command & kAcknowledge) != 0});
  for (int clock = 0; clock < fpga::Settings::kCheckClocks; ++clock) {
    step({});
  }
  return command;
}

std::uint32_t BoardRegisters::read(std::uint8_t address, const Live& live) noexcept {
  const fpga::RegisterRead::Inputs in{.address = address,
                                      .status = live.status,
                                      .level = live.level,
                                      .faults = live.faults,
                                      .executed_lines = live.executed_lines,
                                      .closed_slot = live.closed_slot};
  static_cast<void>(read_.step(in));
  const std::uint32_t word = read_.step(in).read_data;
  const bool rom = (address & 0xC0U) == fpga::kDescriptorRegister.address;
  return rom && word >> 24U == kLineFifo ? (word & 0xFFFF0000U) | static_cast<std::uint32_t>(fifo_bits_) : word;
}

}  // namespace gravure::emulator
