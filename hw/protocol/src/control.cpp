#include "gravure/protocol/control.hpp"

#include <string>

#include "gravure/protocol/status_message.hpp"
#include "little_endian.hpp"

namespace gravure::protocol {
namespace {

constexpr std::uint8_t kToHost = 0xC0;
constexpr std::uint8_t kToBoard = 0x40;
constexpr std::uint8_t kReadRegister = 1;
constexpr std::uint8_t kWriteRegister = 2;
constexpr std::uint8_t kAskStatus = 3;
constexpr std::uint16_t kMostAddress = 0xFF;

template <class... F>
struct Each : F... {
  using F::operator()...;
};
template <class... F>
Each(F...) -> Each<F...>;

Error unknown(const Setup& setup, const std::string& what) {
  return {ErrorCode::device, "control request " + std::to_string(setup.request) + " of type " +
                                 std::to_string(setup.request_type) + ": " + what};
}

/// Whether direction, index and length are those of the request.
bool has_shape(const Setup& setup, std::uint8_t type, std::size_t length) {
  return setup.request_type == type && setup.index == 0 && setup.length == length;
}

}  // namespace

ControlPacket encode_control(const ControlRequest& request) {
  return std::visit(
      Each{[](const ReadRegister& read) {
             return ControlPacket{{kToHost, kReadRegister, read.address, 0, kWordBytes}, {}};
           },
           [](const WriteRegister& write) {
             const auto word = encode_word(write.value);
             return ControlPacket{{kToBoard, kWriteRegister, write.address, 0, kWordBytes}, {word.begin(), word.end()}};
           },
           [](const AskStatus& ask) {
             return ControlPacket{{kToHost, kAskStatus, ask.host_version, 0, kStatusBytes}, {}};
           }},
      request);
}

Result<ControlRequest> decode_control(const Setup& setup, std::span<const std::byte> data) {
  if (setup.request == kAskStatus && has_shape(setup, kToHost, kStatusBytes)) {
    return ControlRequest(AskStatus{setup.value});
  }
  if (setup.value > kMostAddress) {
    return unknown(setup, "value " + std::to_string(setup.value) + ", an address is at most 255");
  }
  const auto address = static_cast<std::uint8_t>(setup.value);
  if (setup.request == kReadRegister && has_shape(setup, kToHost, kWordBytes)) {
    return ControlRequest(ReadRegister{address});
  }
  if (setup.request == kWriteRegister && has_shape(setup, kToBoard, kWordBytes)) {
    GRAVURE_TRY(const std::uint32_t value, decode_word(data));
    return ControlRequest(WriteRegister{address, value});
  }
  return unknown(setup, "not known with index " + std::to_string(setup.index) + " and length " +
                            std::to_string(setup.length) + " (docs/protocol.md lists the requests)");
}

std::array<std::byte, kSetupBytes> encode_setup(const Setup& setup) {
  std::array<std::byte, kSetupBytes> bytes{};
  ByteWriter out(bytes);
  out.put(setup.request_type, 1);
  out.put(setup.request, 1);
  for (const std::uint16_t field : {setup.value, setup.index, setup.length}) {
    out.put(field, 2);
  }
  return bytes;
}

Setup decode_setup(std::span<const std::byte, kSetupBytes> bytes) {
  ByteReader in(bytes);
  Setup setup;
  setup.request_type = static_cast<std::uint8_t>(in.take(1));
  setup.request = static_cast<std::uint8_t>(in.take(1));
  for (std::uint16_t* field : {&setup.value, &setup.index, &setup.length}) {
    *field = static_cast<std::uint16_t>(in.take(2));
  }
  return setup;
}

std::array<std::byte, kWordBytes> encode_word(std::uint32_t value) {
  std::array<std::byte, kWordBytes> bytes{};
  ByteWriter(bytes).put(value, kWordBytes);
  return bytes;
}

Result<std::uint32_t> decode_word(std::span<const std::byte> bytes) {
  if (bytes.size() != kWordBytes) {
    return Error{ErrorCode::device,
                 "a word of " + std::to_string(bytes.size()) + " bytes, must be " + std::to_string(kWordBytes)};
  }
  return static_cast<std::uint32_t>(ByteReader(bytes).take(kWordBytes));
}

}  // namespace gravure::protocol
