#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gravure/core/device_link.hpp"
#include "gravure/replay/recording_link.hpp"
#include "gravure/session/device_lock.hpp"

namespace gravure::cli {

/// The names that open_device() takes, for help texts and errors.
inline constexpr const char* kDeviceNames = "usb[:SERIAL], emulated[:DIR[,key=value...]] or replay:FILE";

/// A board that this process alone uses.
struct OpenDevice {
  std::unique_ptr<DeviceLink> link;
  std::optional<session::DeviceLock> lock;           ///< of boards that their link does not keep to itself
  const replay::RecordingLink* recording = nullptr;  ///< `link`, where it is recorded
};

/// Opens the board of a name, and records what is said over its link in the file `record` unless that is empty:
/// bad_argument where there is no such kind, else the errors of its link, lock and recording.
Result<OpenDevice> open_device(const std::string& name, const std::string& record);

}  // namespace gravure::cli
