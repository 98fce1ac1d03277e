#include "status_in.hpp"

#include <utility>

#include "gravure/protocol/control.hpp"
#include "transfer_error.hpp"

namespace gravure::usb {
namespace {

/// Sequence numbers wrap, and begin anew with a board that has lost its state.
bool comes_after(const BoardStatus& one, const BoardStatus& other) {
  return one.power_up != other.power_up || static_cast<std::int32_t>(one.sequence - other.sequence) > 0;
}

}  // namespace

StatusIn::StatusIn(LinkState& state, libusb_device_handle* handle, std::function<void()> on_failure)
    : state_(state), handle_(handle), on_failure_(std::move(on_failure)) {
  for (Slot& slot : slots_) {
    slot.owner = this;
    slot.transfer = Transfer(libusb_alloc_transfer(0));
  }
}

Result<void> StatusIn::start() {
  const std::lock_guard lock(state_.mutex);
  for (Slot& slot : slots_) {
    GRAVURE_CHECK(submit(slot));
  }
  return {};
}

Result<void> StatusIn::submit(Slot& slot) {
  if (!slot.transfer) {
    return usb_error("waiting for a status message", LIBUSB_ERROR_NO_MEM);
  }
  libusb_fill_bulk_transfer(slot.transfer.get(), handle_, protocol::kStatusEndpoint,
                            reinterpret_cast<unsigned char*>(slot.buffer.data()), static_cast<int>(slot.buffer.size()),
                            &StatusIn::on_done, &slot, 0);
  const int code = libusb_submit_transfer(slot.transfer.get());
  if (code != LIBUSB_SUCCESS) {
    return usb_error("waiting for a status message", code);
  }
  slot.on_its_way = true;
  ++on_their_way_;
  return {};
}

Result<std::optional<BoardStatus>> StatusIn::next(Deadline deadline) {
  std::unique_lock lock(state_.mutex);
  state_.changed.wait_until(lock, deadline, [&] { return fresh_ || state_.failure; });
  if (fresh_) {  // what a board said before it went still counts
    return std::exchange(fresh_, std::nullopt);
  }
  if (state_.failure) {
    return *state_.failure;
  }
  return std::optional<BoardStatus>();
}

bool StatusIn::wait_until_idle(Deadline deadline) {
  std::unique_lock lock(state_.mutex);
  return state_.changed.wait_until(lock, deadline, [&] { return on_their_way_ == 0; });
}

void StatusIn::cancel() {
  for (Slot& slot : slots_) {
    if (slot.on_its_way) {
      libusb_cancel_transfer(slot.transfer.get());
    }
  }
}

void StatusIn::on_done(libusb_transfer* transfer) {
  Slot& slot = *static_cast<Slot*>(transfer->user_data);
  const std::lock_guard lock(slot.owner->state_.mutex);
  slot.owner->done(slot);
}

void StatusIn::done(Slot& slot) {
  slot.on_its_way = false;
  --on_their_way_;
  const libusb_transfer& transfer = *slot.transfer;
  if (transfer.status != LIBUSB_TRANSFER_COMPLETED) {
    if (transfer.status != LIBUSB_TRANSFER_CANCELLED) {
      fail(transfer_error("waiting for a status message", "sent", transfer));
    }
  } else if (const auto status = protocol::decode_status(
                 std::span(slot.buffer).first(static_cast<std::size_t>(transfer.actual_length)));
             !status) {
    fail(status.error());
  } else {
    keep(status.value());
    if (!state_.closing && !state_.failure) {
      if (const auto again = submit(slot); !again) {
        fail(again.error());
      }
    }
  }
  state_.changed.notify_all();
}

void StatusIn::keep(const BoardStatus& status) {
  if (!newest_ || comes_after(status, *newest_)) {
    newest_ = status;
    fresh_ = status;
  }
}

void StatusIn::fail(const Error& error) {
  state_.fail(error);
  cancel();
  on_failure_();
}

}  // namespace gravure::usb
