#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::protocol {

// Which device on the bus is a board, and its endpoints.
inline constexpr std::uint16_t kVendorId = 0x1209;
inline constexpr std::uint16_t kProductId = 0x0001;  ///< for tests, by the register of such numbers
inline constexpr int kInterface = 0;
inline constexpr std::uint8_t kStreamEndpoint = 0x01;  ///< bulk OUT: frames
inline constexpr std::uint8_t kStatusEndpoint = 0x81;  ///< bulk IN: status messages

/// The first stage of a USB control transfer (USB 2.0, table 9-2).
struct Setup {
  std::uint8_t request_type = 0;  ///< C0: vendor, device, to the host; 40: likewise, to the board
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;  ///< of the data stage
  friend bool operator==(const Setup&, const Setup&) = default;
};
inline constexpr std::size_t kSetupBytes = 8;
inline constexpr std::size_t kWordBytes = 4;

/// Answered by a word.
struct ReadRegister {
  std::uint8_t address = 0;
  friend bool operator==(const ReadRegister&, const ReadRegister&) = default;
};
struct WriteRegister {
  std::uint8_t address = 0;
  std::uint32_t value = 0;
  friend bool operator==(const WriteRegister&, const WriteRegister&) = default;
};
/// The handshake: answered by a status message, whose version stands in the same place in every version.
struct AskStatus {
  std::uint16_t host_version = 0;
  friend bool operator==(const AskStatus&, const AskStatus&) = default;
};
using ControlRequest = std::variant<ReadRegister, WriteRegister, AskStatus>;

/// A request as it goes out: the data are empty where the board sends them.
struct ControlPacket {
  Setup setup;
  std::vector<std::byte> data;
  friend bool operator==(const ControlPacket&, const ControlPacket&) = default;
};

ControlPacket encode_control(const ControlRequest& request);
/// What the board makes of it. device where it is none of ours: the board stalls endpoint 0.
Result<ControlRequest> decode_control(const Setup& setup, std::span<const std::byte> data);

std::array<std::byte, kSetupBytes> encode_setup(const Setup& setup);
Setup decode_setup(std::span<const std::byte, kSetupBytes> bytes);

std::array<std::byte, kWordBytes> encode_word(std::uint32_t value);
/// device where it is of another length.
Result<std::uint32_t> decode_word(std::span<const std::byte> bytes);

}  // namespace gravure::protocol
