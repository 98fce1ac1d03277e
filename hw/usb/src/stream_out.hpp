#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bus.hpp"
#include "link_state.hpp"

namespace gravure::usb {

/// Bulk OUT: a fixed number of buffers, each on its way or free. Bytes leave in the order they came.
class StreamOut {
 public:
  StreamOut(LinkState& state, libusb_device_handle* handle, std::size_t transfers, std::size_t transfer_bytes);
  StreamOut(const StreamOut&) = delete;
  StreamOut& operator=(const StreamOut&) = delete;

  /// As DeviceLink::send().
  Result<std::size_t> send(std::span<const std::byte> stream, Deadline deadline);
  /// Waits until nothing is on its way; false after the deadline.
  bool wait_until_idle(Deadline deadline);
  /// Takes back what is on its way; wait_until_idle() tells when that is done. With the mutex held.
  void cancel();

 private:
  struct Slot {
    StreamOut* owner = nullptr;
    Transfer transfer;
    std::vector<std::byte> buffer;
    bool on_its_way = false;
  };

  static void LIBUSB_CALL on_done(libusb_transfer* transfer);
  void done(Slot& slot);
  Slot* free_slot();
  Result<void> submit(Slot& slot, std::span<const std::byte> bytes);

  LinkState& state_;
  libusb_device_handle* handle_;
  std::vector<Slot> slots_;
  std::size_t on_their_way_ = 0;
};

}  // namespace gravure::usb
