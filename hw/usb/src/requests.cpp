#include "requests.hpp"

#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "bus.hpp"
#include "gravure/protocol/control.hpp"
#include "gravure/protocol/status_message.hpp"

namespace gravure::usb {
namespace {

std::string hex(std::uint8_t address) {
  std::array<char, 8> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "0x%02x", static_cast<unsigned>(address)));
  return text.data();
}

/// What the board sends, or nothing where it takes; all of it, or an error.
Result<std::vector<std::byte>> transfer(libusb_device_handle* handle, const protocol::ControlRequest& request,
                                        const std::string& doing, std::chrono::milliseconds patience) {
  protocol::ControlPacket packet = protocol::encode_control(request);
  packet.data.resize(packet.setup.length);
  const protocol::Setup& setup = packet.setup;
  const int done = libusb_control_transfer(handle, setup.request_type, setup.request, setup.value, setup.index,
                                           reinterpret_cast<unsigned char*>(packet.data.data()), setup.length,
                                           static_cast<unsigned>(patience.count()));
  if (done < 0) {
    return usb_error(doing, done);
  }
  packet.data.resize(static_cast<std::size_t>(done));
  return std::move(packet.data);
}

}  // namespace

Result<std::uint32_t> read_register(libusb_device_handle* handle, std::uint8_t address,
                                    std::chrono::milliseconds patience) {
  const std::string doing = "reading register " + hex(address);
  GRAVURE_TRY(const std::vector<std::byte> data, transfer(handle, protocol::ReadRegister{address}, doing, patience));
  const auto word = protocol::decode_word(data);
  return word ? word : Error{word.error().code, doing + ": " + word.error().message};
}

Result<void> write_register(libusb_device_handle* handle, std::uint8_t address, std::uint32_t value,
                            std::chrono::milliseconds patience) {
  const std::string doing = "writing " + std::to_string(value) + " to register " + hex(address);
  GRAVURE_TRY(const std::vector<std::byte> data,
              transfer(handle, protocol::WriteRegister{address, value}, doing, patience));
  if (data.size() != protocol::kWordBytes) {
    return Error{ErrorCode::device, doing + ": the board took " + std::to_string(data.size()) + " of 4 bytes"};
  }
  return {};
}

Result<BoardStatus> ask_status(libusb_device_handle* handle, std::chrono::milliseconds patience) {
  GRAVURE_TRY(const std::vector<std::byte> data, transfer(handle, protocol::AskStatus{protocol::kProtocolVersion},
                                                          "asking the board for its status", patience));
  return protocol::decode_status(data);
}

}  // namespace gravure::usb
