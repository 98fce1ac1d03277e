#include "bus.hpp"

#include <algorithm>
#include <array>

#include "gravure/protocol/control.hpp"

namespace gravure::usb {
namespace {

// USB 2.0, 5.8.4: at most 19 transactions of 64 bytes in a frame of 1 ms, 13 of 512 in a microframe of 125 us.
constexpr std::int64_t kFullSpeedBits = std::int64_t{8} * 19 * 64 * 1000;
constexpr std::int64_t kHighSpeedBits = std::int64_t{8} * 13 * 512 * 8000;

bool is_board(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  return libusb_get_device_descriptor(device, &descriptor) == LIBUSB_SUCCESS &&
         descriptor.idVendor == protocol::kVendorId && descriptor.idProduct == protocol::kProductId;
}

int order_of(const Device& device) {
  return libusb_get_bus_number(device.get()) * 256 + libusb_get_device_address(device.get());
}

std::string text_of(libusb_device_handle* handle, std::uint8_t index) {
  std::array<unsigned char, 256> text{};
  const int length =
      index == 0 ? 0 : libusb_get_string_descriptor_ascii(handle, index, text.data(), static_cast<int>(text.size()));
  return {text.begin(), text.begin() + std::max(length, 0)};
}

}  // namespace

Error usb_error(const std::string& doing, int code) {
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return {ErrorCode::device,
              doing + ": the board was unplugged or has lost its power; its gate is dark. Plug it in again"};
    case LIBUSB_ERROR_ACCESS:
      return {ErrorCode::device,
              doing +
                  ": permission denied; copy share/gravure/70-gravure.rules from where gravure is installed (below "
                  "the prefix of cmake --install, /usr/local unless another was given) to "
                  "/etc/udev/rules.d, run `udevadm control --reload`, plug the board in again"};
    case LIBUSB_ERROR_BUSY:
      return {ErrorCode::device, doing + ": another program uses the board; end that one first"};
    case LIBUSB_ERROR_PIPE:
      return {ErrorCode::device, doing + ": the board refused (stalled)"};
    case LIBUSB_ERROR_OVERFLOW:
      return {ErrorCode::device, doing + ": the board sent more than it was asked for (babble)"};
    case LIBUSB_ERROR_TIMEOUT:
      return {ErrorCode::timeout, doing + ": no answer in time; check the cable and the board's power"};
    case LIBUSB_ERROR_NO_MEM:
      return {ErrorCode::io, doing + ": the system has no memory for USB transfers (usbcore.usbfs_memory_mb)"};
    case LIBUSB_ERROR_IO:
      return {ErrorCode::device, doing + ": bus error; check the cable"};
    default:
      return {ErrorCode::device, doing + ": " + libusb_error_name(code)};
  }
}

Result<Context> open_bus() {
  libusb_context* context = nullptr;
  const int code = libusb_init(&context);
  if (code != LIBUSB_SUCCESS) {
    return Error{ErrorCode::device, std::string("USB: the bus cannot be read (") + libusb_error_name(code) + ")"};
  }
  return Context(context);
}

Result<std::vector<Device>> find_boards(libusb_context* context) {
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  if (count < 0) {
    return usb_error("USB: listing the bus", static_cast<int>(count));
  }
  std::vector<Device> boards;
  for (ssize_t i = 0; i < count; ++i) {
    Device device(list[i]);
    if (is_board(device.get())) {
      boards.push_back(std::move(device));
    }
  }
  libusb_free_device_list(list, 0);
  std::sort(boards.begin(), boards.end(), [](const Device& a, const Device& b) { return order_of(a) < order_of(b); });
  return boards;
}

std::string place_of(libusb_device* device) {
  return "bus " + std::to_string(libusb_get_bus_number(device)) + ", device " +
         std::to_string(libusb_get_device_address(device));
}

std::int64_t link_bits_per_s(libusb_device* device) {
  switch (libusb_get_device_speed(device)) {
    case LIBUSB_SPEED_FULL:
      return kFullSpeedBits;
    case LIBUSB_SPEED_UNKNOWN:
    case LIBUSB_SPEED_LOW:  // has no bulk endpoints
      return 0;
    default:
      return kHighSpeedBits;  // a faster bus carries at least that
  }
}

DeviceIdentity identify(libusb_device* device, libusb_device_handle* handle) {
  DeviceIdentity identity;
  identity.place = place_of(device);
  identity.link_bits_per_s = link_bits_per_s(device);
  libusb_device_descriptor descriptor{};
  if (handle != nullptr && libusb_get_device_descriptor(device, &descriptor) == LIBUSB_SUCCESS) {
    identity.serial = text_of(handle, descriptor.iSerialNumber);
    identity.product = text_of(handle, descriptor.iProduct);
  }
  return identity;
}

}  // namespace gravure::usb
