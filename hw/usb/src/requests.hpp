#pragma once

#include <libusb.h>

#include <chrono>
#include <cstdint>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::usb {

// Control requests of docs/protocol.md over endpoint 0, which need no claim on the board.
Result<std::uint32_t> read_register(libusb_device_handle* handle, std::uint8_t address,
                                    std::chrono::milliseconds patience);
Result<void> write_register(libusb_device_handle* handle, std::uint8_t address, std::uint32_t value,
                            std::chrono::milliseconds patience);
/// The handshake: version_mismatch names both versions.
Result<BoardStatus> ask_status(libusb_device_handle* handle, std::chrono::milliseconds patience);

}  // namespace gravure::usb
