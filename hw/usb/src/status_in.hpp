#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>

#include "bus.hpp"
#include "gravure/protocol/status_message.hpp"
#include "link_state.hpp"

namespace gravure::usb {

/// Bulk IN: always some transfers that wait for the board's next status message.
class StatusIn {
 public:
  /// `on_failure` is called with the mutex held.
  StatusIn(LinkState& state, libusb_device_handle* handle, std::function<void()> on_failure);
  StatusIn(const StatusIn&) = delete;
  StatusIn& operator=(const StatusIn&) = delete;

  Result<void> start();
  /// As DeviceLink::next_status().
  Result<std::optional<BoardStatus>> next(Deadline deadline);
  bool wait_until_idle(Deadline deadline);
  void cancel();  ///< with the mutex held

 private:
  static constexpr std::size_t kTransfers = 4;
  struct Slot {
    StatusIn* owner = nullptr;
    Transfer transfer;
    std::array<std::byte, protocol::kStatusBytes> buffer{};
    bool on_its_way = false;
  };

  static void LIBUSB_CALL on_done(libusb_transfer* transfer);
  void done(Slot& slot);
  Result<void> submit(Slot& slot);
  void keep(const BoardStatus& status);
  void fail(const Error& error);

  LinkState& state_;
  libusb_device_handle* handle_;
  std::function<void()> on_failure_;
  std::array<Slot, kTransfers> slots_;
  std::size_t on_their_way_ = 0;
  std::optional<BoardStatus> fresh_;   ///< not given yet
  std::optional<BoardStatus> newest_;  ///< of all that came
};

}  // namespace gravure::usb
