#include "gravure/core/device_link.hpp"

namespace gravure {

std::string to_string(DeviceFault fault) {
  switch (fault) {
    case DeviceFault::none:
      return "none";
    case DeviceFault::sequence:
      return "sequence";
    case DeviceFault::checksum:
      return "checksum";
    case DeviceFault::shape:
      return "shape";
    case DeviceFault::underrun:
      return "underrun";
    case DeviceFault::host_silence:
      return "host silence";
    case DeviceFault::interlock:
      return "interlock";
  }
  return "unknown";
}

std::string to_string(BoardState state) {
  switch (state) {
    case BoardState::idle:
      return "idle";
    case BoardState::filling:
      return "filling";
    case BoardState::running:
      return "running";
    case BoardState::stopped:
      return "stopped";
  }
  return "unknown";
}

}  // namespace gravure
