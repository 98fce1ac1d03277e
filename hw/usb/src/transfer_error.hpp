#pragma once

#include <string>

#include "bus.hpp"

namespace gravure::usb {

/// Why a bulk transfer ended as it did: "<doing>: <cause>; the board <took> N of M bytes of a transfer on endpoint E".
inline Error transfer_error(const std::string& doing, const std::string& took, const libusb_transfer& transfer) {
  const std::string count = "endpoint " + std::to_string(transfer.endpoint) + ", the board " + took + " " +
                            std::to_string(transfer.actual_length) + " of " + std::to_string(transfer.length) +
                            " bytes";
  switch (transfer.status) {
    case LIBUSB_TRANSFER_NO_DEVICE:
      return usb_error(doing + " (" + count + ")", LIBUSB_ERROR_NO_DEVICE);
    case LIBUSB_TRANSFER_STALL:
      return usb_error(doing + " (" + count + ")", LIBUSB_ERROR_PIPE);
    case LIBUSB_TRANSFER_OVERFLOW:
      return usb_error(doing + " (" + count + ")", LIBUSB_ERROR_OVERFLOW);
    case LIBUSB_TRANSFER_TIMED_OUT:
      return usb_error(doing + " (" + count + ")", LIBUSB_ERROR_TIMEOUT);
    case LIBUSB_TRANSFER_COMPLETED:
      return {ErrorCode::device, doing + " (" + count + "): short transfer, the stream is out of step"};
    default:
      return usb_error(doing + " (" + count + ")", LIBUSB_ERROR_IO);
  }
}

}  // namespace gravure::usb
