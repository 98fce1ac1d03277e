#include "stream_out.hpp"

#include <algorithm>
#include <string>

#include "gravure/protocol/control.hpp"
#include "transfer_error.hpp"

namespace gravure::usb {

StreamOut::StreamOut(LinkState& state, libusb_device_handle* handle, std::size_t transfers, std::size_t transfer_bytes)
    : state_(state), handle_(handle), slots_(transfers) {
  for (Slot& slot : slots_) {
    slot.owner = this;
    slot.transfer = Transfer(libusb_alloc_transfer(0));
    slot.buffer.resize(transfer_bytes);
  }
}

StreamOut::Slot* StreamOut::free_slot() {
  const auto free = std::find_if(slots_.begin(), slots_.end(), [](const Slot& slot) { return !slot.on_its_way; });
  return free == slots_.end() ? nullptr : &*free;
}

Result<void> StreamOut::submit(Slot& slot, std::span<const std::byte> bytes) {
  if (!slot.transfer) {
    return usb_error("sending the stream", LIBUSB_ERROR_NO_MEM);
  }
  std::copy(bytes.begin(), bytes.end(), slot.buffer.begin());
  // No time-out of libusb's: a part of a transfer that arrived would leave the ones behind it out of step. Whoever
  // waits is patient only so long, and closing cancels.
  libusb_fill_bulk_transfer(slot.transfer.get(), handle_, protocol::kStreamEndpoint,
                            reinterpret_cast<unsigned char*>(slot.buffer.data()), static_cast<int>(bytes.size()),
                            &StreamOut::on_done, &slot, 0);
  const int code = libusb_submit_transfer(slot.transfer.get());
  if (code != LIBUSB_SUCCESS) {
    return usb_error("sending the stream", code);
  }
  slot.on_its_way = true;
  ++on_their_way_;
  return {};
}

Result<std::size_t> StreamOut::send(std::span<const std::byte> stream, Deadline deadline) {
  std::unique_lock lock(state_.mutex);
  std::size_t taken = 0;
  while (taken < stream.size()) {
    Slot* slot = nullptr;
    if (!state_.changed.wait_until(lock, deadline, [&] { return state_.failure || (slot = free_slot()) != nullptr; })) {
      break;
    }
    if (state_.failure) {
      return *state_.failure;
    }
    const auto part = stream.subspan(taken, std::min(slot->buffer.size(), stream.size() - taken));
    if (const auto sent = submit(*slot, part); !sent) {
      state_.fail(sent.error());
      cancel();
      return sent.error();
    }
    taken += part.size();
  }
  return taken;
}

bool StreamOut::wait_until_idle(Deadline deadline) {
  std::unique_lock lock(state_.mutex);
  return state_.changed.wait_until(lock, deadline, [&] { return on_their_way_ == 0; });
}

void StreamOut::cancel() {
  for (Slot& slot : slots_) {
    if (slot.on_its_way) {
      libusb_cancel_transfer(slot.transfer.get());  // refused where it is done already: the callback comes all the same
    }
  }
}

void StreamOut::on_done(libusb_transfer* transfer) {
  Slot& slot = *static_cast<Slot*>(transfer->user_data);
  const std::lock_guard lock(slot.owner->state_.mutex);
  slot.owner->done(slot);
}

void StreamOut::done(Slot& slot) {
  slot.on_its_way = false;
  --on_their_way_;
  const libusb_transfer& transfer = *slot.transfer;
  const bool is_short = transfer.status == LIBUSB_TRANSFER_COMPLETED && transfer.actual_length != transfer.length;
  if (is_short || (transfer.status != LIBUSB_TRANSFER_COMPLETED && transfer.status != LIBUSB_TRANSFER_CANCELLED)) {
    state_.fail(transfer_error("sending the stream", "took", transfer));
    cancel();
  }
  state_.changed.notify_all();
}

}  // namespace gravure::usb
