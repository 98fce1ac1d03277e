#include "gravure/usb/boards.hpp"

#include <algorithm>
#include <utility>

#include "bus.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/control.hpp"
#include "link_state.hpp"
#include "requests.hpp"

namespace gravure::usb {
namespace {

constexpr std::chrono::milliseconds kPatience{5000};
constexpr std::chrono::milliseconds kEventSlice{100};

/// Registers and status, which need no claim; the first thing that is wrong.
Result<void> question(libusb_device_handle* handle, BoardReport& report) {
  GRAVURE_TRY(const BoardStatus status, ask_status(handle, kPatience));
  report.status = status;
  report.identity.protocol_version = status.protocol_version;
  GRAVURE_TRY(const std::uint32_t magic, read_register(handle, fpga::kMagicRegister.address, kPatience));
  if (magic != fpga::kMagicRegister.reset) {
    return Error{ErrorCode::device, "register magic reads " + std::to_string(magic) + ": none of our boards"};
  }
  GRAVURE_TRY(report.register_map, read_register(handle, fpga::kVersionRegister.address, kPatience));
  if (*report.register_map != fpga::kVersionRegister.reset) {
    return Error{ErrorCode::version_mismatch, "the board has version " + std::to_string(*report.register_map) +
                                                  " of the register map, this program version " +
                                                  std::to_string(fpga::kVersionRegister.reset) +
                                                  ": update the older one"};
  }
  const int code = libusb_claim_interface(handle, protocol::kInterface);
  if (code != LIBUSB_SUCCESS) {
    return usb_error("claiming it", code);
  }
  libusb_release_interface(handle, protocol::kInterface);
  return {};
}

BoardReport report_of(libusb_device* device) {
  BoardReport report;
  libusb_device_handle* opened = nullptr;
  const int code = libusb_open(device, &opened);
  const Handle handle(opened);
  report.identity = identify(device, handle.get());
  const Result<void> answer = code == LIBUSB_SUCCESS ? question(handle.get(), report) : usb_error("opening it", code);
  if (!answer) {
    report.problem = answer.error().message;
  }
  return report;
}

Result<std::vector<BoardReport>> reports_on(libusb_context* context) {
  GRAVURE_TRY(const std::vector<Device> devices, find_boards(context));
  std::vector<BoardReport> reports;
  reports.reserve(devices.size());
  for (const Device& device : devices) {
    reports.push_back(report_of(device.get()));
  }
  return reports;
}

/// Whether a board with that serial number is there (one that may not be opened counts where any will do).
Result<bool> is_there(libusb_context* context, const std::string& serial) {
  GRAVURE_TRY(const std::vector<Device> devices, find_boards(context));
  return std::any_of(devices.begin(), devices.end(), [&](const Device& device) {
    libusb_device_handle* opened = nullptr;
    const bool open = libusb_open(device.get(), &opened) == LIBUSB_SUCCESS;
    const Handle handle(opened);
    return serial.empty() || (open && identify(device.get(), opened).serial == serial);
  });
}

int LIBUSB_CALL on_arrival(libusb_context* /*context*/, libusb_device* /*device*/, libusb_hotplug_event /*event*/,
                           void* arrived) {
  *static_cast<bool*>(arrived) = true;
  return 0;
}

}  // namespace

Result<std::vector<BoardReport>> list_boards() {
  GRAVURE_TRY(const Context context, open_bus());
  return reports_on(context.get());
}

Result<bool> wait_for_board(const std::string& serial, std::chrono::milliseconds patience,
                            const std::function<bool()>& stop) {
  GRAVURE_TRY(const Context context, open_bus());
  bool arrived = false;  // touched by this thread alone: it runs the events
  const int code = libusb_hotplug_register_callback(context.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED,
                                                    LIBUSB_HOTPLUG_ENUMERATE, protocol::kVendorId, protocol::kProductId,
                                                    LIBUSB_HOTPLUG_MATCH_ANY, &on_arrival, &arrived, nullptr);
  if (code != LIBUSB_SUCCESS) {
    return usb_error("waiting for a board", code);
  }
  const Deadline deadline = deadline_after(patience);
  for (;;) {
    if (std::exchange(arrived, false)) {
      GRAVURE_TRY(const bool found, is_there(context.get(), serial));
      if (found) {
        return true;
      }
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) {
      return false;
    }
    if (stop && stop()) {
      return Error{ErrorCode::cancelled, "waiting for a board: stopped on request"};
    }
    timeval slice{0, static_cast<suseconds_t>(1000 * std::min(left, kEventSlice).count())};
    libusb_handle_events_timeout_completed(context.get(), &slice, nullptr);
  }
}

}  // namespace gravure::usb
