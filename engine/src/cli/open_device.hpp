#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gravure/core/device_link.hpp"
#include "gravure/session/device_lock.hpp"

namespace gravure::cli {

/// The names that open_device() takes, for help texts and errors.
inline constexpr const char* kDeviceNames = "usb[:SERIAL] or emulated:DIR[,key=value...]";

/// A board that this process alone uses.
struct OpenDevice {
  std::unique_ptr<DeviceLink> link;
  std::optional<session::DeviceLock> lock;  ///< of boards that their link does not keep to itself
};

/// Opens the board of a name: bad_argument where there is no such kind, else the errors of its link and lock.
Result<OpenDevice> open_device(const std::string& name);

}  // namespace gravure::cli
