#pragma once

#include <cstdint>

namespace gravure::fpga {

/// Bits of the control register.
enum Control : std::uint16_t {
  kRun = 1,
  kEnable0 = 2,
  kWatch = 4,
  kEnable1 = 8,
  kTimed = 16,
  kBackward = 32,
  kReference = 64,
  kBackward0 = 128,
  kBackward1 = 256
};

}  // namespace gravure::fpga
