#include "machine/open_device.hpp"

#include <string_view>

#include "gravure/emulator/emulated_link.hpp"
#include "gravure/replay/recording_link.hpp"
#include "gravure/replay/replay_link.hpp"
#include "gravure/usb/usb_link.hpp"

namespace gravure::cli {
namespace {

Result<OpenDevice> open_usb(const std::string& serial) {
  OpenDevice device;
  GRAVURE_TRY(device.link, usb::open_usb_link({.serial = serial}));
  GRAVURE_TRY(device.lock, session::DeviceLock::take(session::DeviceLock::path_for(device.link->identity().serial)));
  return device;
}

Result<OpenDevice> open_named(const std::string& name) {
  const std::size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  const std::string place = colon == std::string::npos ? std::string() : name.substr(colon + 1);
  if (kind == "emulated" && !place.empty()) {
    OpenDevice device;
    GRAVURE_TRY(device.link, emulator::EmulatedLink::open(place));
    return device;
  }
  if (kind == "usb" && (colon == std::string::npos || !place.empty())) {
    return open_usb(place);
  }
  if (kind == "replay" && !place.empty()) {
    OpenDevice device;
    GRAVURE_TRY(device.link, replay::ReplayLink::open(place));
    return device;
  }
  return Error{ErrorCode::bad_argument, "--device " + name + ": must be " + kDeviceNames};
}

}  // namespace

Result<OpenDevice> open_device(const std::string& name, const std::string& record) {
  GRAVURE_TRY(OpenDevice device, open_named(name));
  if (!record.empty()) {
    GRAVURE_TRY(auto recording, replay::RecordingLink::create(std::move(device.link), record));
    device.recording = recording.get();
    device.link = std::move(recording);
  }
  return device;
}

}  // namespace gravure::cli
