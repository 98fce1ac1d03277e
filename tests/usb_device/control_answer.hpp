#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/protocol/control.hpp"
#include "usb_board.hpp"

namespace gravure::test {

/// The strings of a USB device: number 1 and 2.
struct DeviceTexts {
  std::string product;
  std::string serial;
};

/// What a device answers to a control request: its strings and what docs/protocol.md says. `messages` is the number of
/// the last status message. An Error stalls the endpoint.
Result<std::vector<std::byte>> answer_control(UsbBoard& board, const DeviceTexts& texts, std::uint32_t messages,
                                              const protocol::Setup& setup, std::span<const std::byte> data);

}  // namespace gravure::test
