#pragma once

#include <cstdint>
#include <string>

namespace gravure {

/// Why the board closed its gate, by the numbers of its `status` register (docs/registers.md); sticky until
/// acknowledged.
enum class DeviceFault : std::uint8_t { none, sequence, checksum, shape, underrun, host_silence, interlock };
std::string to_string(DeviceFault fault);

}  // namespace gravure
