#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::usb {

struct UsbOptions {
  std::string serial = {};                          ///< empty: the only board there is
  std::size_t transfers = 8;                        ///< of the stream, in flight at once; 1 to 64
  std::size_t transfer_bytes = 16384;               ///< most a transfer carries; 1 to 1 MiB
  std::chrono::milliseconds control_timeout{5000};  ///< most a register access or closing may take
};

/// Opens a board and shakes hands: claims it, clears halted endpoints, asks for its status. Errors: device where there
/// is none, several and no serial number, it may not be opened (the message names the udev rule), another program has
/// it; version_mismatch, naming both versions; timeout; bad_argument for options out of range.
///
/// Each bulk transfer is in one of a fixed number of buffers. A stall, a short or failed transfer and an unplugged
/// board end the link for good, because nobody knows which bytes arrived; open it anew and set the position.
Result<std::unique_ptr<DeviceLink>> open_usb_link(const UsbOptions& options);

}  // namespace gravure::usb
