#pragma once

#include <cstdint>

#include "gravure/fpga/register_read.hpp"
#include "gravure/fpga/settings.hpp"

namespace gravure::emulator {

/// The registers of a board, by the models of the blocks that keep them, one access at a time: between two of them more
/// clocks pass than any setting takes to settle.
class BoardRegisters {
 public:
  explicit BoardRegisters(int fifo_bits) : fifo_bits_(fifo_bits), read_(fifo_bits) {}

  /// What the board says of itself, beside what was written.
  struct Live {
    std::uint16_t status = 0;
    std::uint32_t level = 0;
    std::uint8_t faults = 0;
    std::uint32_t executed_lines = 0;
    std::uint32_t closed_slot = 0;
  };

  /// The commands that the write gives.
  std::uint16_t write(std::uint8_t address, std::uint32_t value) noexcept;
  std::uint32_t read(std::uint8_t address, const Live& live) noexcept;
  /// A write was refused since the last acknowledge.
  bool refused() const noexcept { return settings_now_.refused; }
  const fpga::Settings::Outputs& settings() const noexcept { return settings_now_; }

 private:
  void step(const fpga::Settings::Inputs& in) noexcept;

  int fifo_bits_;
  fpga::Settings settings_;
  fpga::Settings::Outputs settings_now_;
  fpga::RegisterRead read_;
};

}  // namespace gravure::emulator
