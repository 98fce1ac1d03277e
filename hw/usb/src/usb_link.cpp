#include "gravure/usb/usb_link.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "bus.hpp"
#include "event_thread.hpp"
#include "gravure/protocol/control.hpp"
#include "link_state.hpp"
#include "requests.hpp"
#include "status_in.hpp"
#include "stream_out.hpp"

namespace gravure::usb {
namespace {

class UsbLink final : public DeviceLink {
 public:
  UsbLink(Context context, Handle handle, DeviceIdentity identity, const UsbOptions& options)
      : context_(std::move(context)),
        handle_(std::move(handle)),
        identity_(std::move(identity)),
        patience_(options.control_timeout),
        stream_(state_, handle_.get(), options.transfers, options.transfer_bytes),
        status_(state_, handle_.get(), [this] { stream_.cancel(); }),
        events_(std::in_place, context_.get()) {}
  ~UsbLink() override { close(); }
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;

  Result<void> start() { return status_.start(); }

  const DeviceIdentity& identity() const noexcept override { return identity_; }

  Result<std::uint32_t> read_register(std::uint8_t address) override {
    GRAVURE_CHECK(alive());
    return usb::read_register(handle_.get(), address, patience_);
  }
  /// Also where a bulk endpoint has failed: endpoint 0 may still take the word that closes the gate.
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    return usb::write_register(handle_.get(), address, value, patience_);
  }

  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override {
    return stream_.send(stream, deadline_after(patience));
  }
  Result<bool> drain(Milliseconds patience) override {
    const bool idle = stream_.wait_until_idle(deadline_after(patience));
    GRAVURE_CHECK(alive());
    return idle;
  }
  Result<void> abandon() override {
    GRAVURE_CHECK(alive());
    {
      const std::lock_guard lock(state_.mutex);
      stream_.cancel();
    }
    if (!stream_.wait_until_idle(deadline_after(patience_))) {
      return usb_error("taking back the stream", LIBUSB_ERROR_TIMEOUT);
    }
    return {};
  }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override {
    return status_.next(deadline_after(patience));
  }

 private:
  Result<void> alive() {
    const std::lock_guard lock(state_.mutex);
    return state_.failure ? Result<void>(*state_.failure) : Result<void>();
  }

  /// Transfers come back while the events still run. One that does not in time is taken out of libusb's books by
  /// closing, after which no callback can come.
  void close() {
    {
      const std::lock_guard lock(state_.mutex);
      state_.closing = true;
      stream_.cancel();
      status_.cancel();
    }
    const Deadline deadline = deadline_after(patience_);
    static_cast<void>(stream_.wait_until_idle(deadline) && status_.wait_until_idle(deadline));
    events_.reset();
    libusb_release_interface(handle_.get(), protocol::kInterface);
    handle_.reset();
  }

  Context context_;
  Handle handle_;
  DeviceIdentity identity_;
  Milliseconds patience_;
  LinkState state_;
  StreamOut stream_;
  StatusIn status_;
  std::optional<EventThread> events_;
};

Result<void> check(const UsbOptions& options) {
  constexpr std::size_t kMostTransfers = 64;
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  if (options.transfers < 1 || options.transfers > kMostTransfers || options.transfer_bytes < 1 ||
      options.transfer_bytes > kMostBytes || options.control_timeout.count() < 1) {
    return Error{ErrorCode::bad_argument,
                 "USB: 1 to 64 transfers of 1 to 1048576 bytes and a time-out from 1 ms on, not " +
                     std::to_string(options.transfers) + " of " + std::to_string(options.transfer_bytes) + " and " +
                     std::to_string(options.control_timeout.count()) + " ms"};
  }
  return {};
}

Result<Handle> open_device(libusb_device* device) {
  libusb_device_handle* handle = nullptr;
  const int code = libusb_open(device, &handle);
  if (code != LIBUSB_SUCCESS) {
    return usb_error("opening the board on " + place_of(device), code);
  }
  return Handle(handle);
}

struct Opened {
  Handle handle;
  DeviceIdentity identity;
};

Error none_fits(const std::string& serial, const std::string& seen) {
  return {ErrorCode::device, serial.empty() ? "USB: no board (1209:0001) on the bus; `gravure devices` lists them"
                                            : "USB: no board with serial number \"" + serial +
                                                  "\"; on the bus: " + (seen.empty() ? "none" : seen)};
}

/// The only board, or the one with that serial number.
Result<Opened> pick_board(libusb_context* context, const std::string& serial) {
  GRAVURE_TRY(const std::vector<Device> boards, find_boards(context));
  if (serial.empty() && boards.size() > 1) {
    return Error{ErrorCode::device, "USB: " + std::to_string(boards.size()) +
                                        " boards on the bus; say which: usb:SERIAL (`gravure devices` lists them)"};
  }
  std::string seen;
  std::optional<Error> closed;
  for (const Device& device : boards) {
    Result<Handle> handle = open_device(device.get());
    if (!handle) {
      closed = handle.error();
      continue;
    }
    DeviceIdentity identity = identify(device.get(), handle.value().get());
    if (serial.empty() || identity.serial == serial) {
      return Opened{std::move(handle).value(), std::move(identity)};
    }
    seen += (seen.empty() ? "" : ", ") + identity.serial;
  }
  return closed ? *closed : none_fits(serial, seen);
}

Result<void> claim(libusb_device_handle* handle, const std::string& board) {
  if (const int code = libusb_claim_interface(handle, protocol::kInterface); code != LIBUSB_SUCCESS) {
    return usb_error("claiming " + board, code);
  }
  for (const std::uint8_t endpoint : {protocol::kStreamEndpoint, protocol::kStatusEndpoint}) {
    if (const int code = libusb_clear_halt(handle, endpoint); code != LIBUSB_SUCCESS) {
      return usb_error("clearing endpoint " + std::to_string(endpoint) + " of " + board, code);
    }
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<DeviceLink>> open_usb_link(const UsbOptions& options) {
  GRAVURE_CHECK(check(options));
  GRAVURE_TRY(Context context, open_bus());
  GRAVURE_TRY(Opened board, pick_board(context.get(), options.serial));
  GRAVURE_CHECK(claim(board.handle.get(), "the board " + board.identity.serial));
  GRAVURE_TRY(const BoardStatus status, ask_status(board.handle.get(), options.control_timeout));
  board.identity.protocol_version = status.protocol_version;
  auto link =
      std::make_unique<UsbLink>(std::move(context), std::move(board.handle), std::move(board.identity), options);
  GRAVURE_CHECK(link->start());
  return std::unique_ptr<DeviceLink>(std::move(link));
}

}  // namespace gravure::usb
