#pragma once

#include <string>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/fpga/ab_registers.hpp"

namespace gravure::emulator {

/// device: "the board refuses " and what.
Error board_refuses(const std::string& what);

/// The A-B registers of a setup. Its counter_bits must be in range.
fpga::AbRegisters ab_registers_of(const DeviceSetup& setup) noexcept;

/// Those of its second channel.
fpga::AbRegisters carriage_registers_of(const DeviceSetup& setup) noexcept;

/// device, with one line for each register that the board would not take as it is.
Result<void> check_setup(const DeviceSetup& setup);

}  // namespace gravure::emulator
