#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::usb {

/// What one board on the bus says, as far as it can be asked.
struct BoardReport {
  DeviceIdentity identity;                    ///< serial and product are empty where it may not be opened
  std::optional<std::uint32_t> register_map;  ///< version of its registers
  std::optional<BoardStatus> status;          ///< also where another program runs a job on it
  std::string problem;                        ///< why it cannot be used, and what to do; empty: it can
};

/// All boards (1209:0001) on the bus, by their places. Disturbs no job that runs. device where the bus cannot be read.
Result<std::vector<BoardReport>> list_boards();

/// Waits until a board with that serial number (empty: any) is on the bus. False where none came within `patience`;
/// cancelled where `stop` says so (asked a few times a second). device as above.
Result<bool> wait_for_board(const std::string& serial, std::chrono::milliseconds patience,
                            const std::function<bool()>& stop = {});

}  // namespace gravure::usb
