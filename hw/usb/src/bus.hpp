#pragma once

#include <libusb.h>

#include <memory>
#include <string>
#include <vector>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::usb {

struct EndUsb {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
  void operator()(libusb_device* device) const noexcept { libusb_unref_device(device); }
  void operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }
  void operator()(libusb_transfer* transfer) const noexcept { libusb_free_transfer(transfer); }
};
using Context = std::unique_ptr<libusb_context, EndUsb>;
using Device = std::unique_ptr<libusb_device, EndUsb>;
using Handle = std::unique_ptr<libusb_device_handle, EndUsb>;
using Transfer = std::unique_ptr<libusb_transfer, EndUsb>;

/// The Error for a code of libusb: "<doing>: <what it means, and what to do>".
Error usb_error(const std::string& doing, int code);

/// device where libusb cannot read the bus.
Result<Context> open_bus();
/// The boards on it, by bus and address.
Result<std::vector<Device>> find_boards(libusb_context* context);

std::string place_of(libusb_device* device);
/// Most payload bits a second that the bus carries to one bulk endpoint.
std::int64_t link_bits_per_s(libusb_device* device);
/// Serial, product, place and speed; version is not asked.
DeviceIdentity identify(libusb_device* device, libusb_device_handle* handle);

}  // namespace gravure::usb
