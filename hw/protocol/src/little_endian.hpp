#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gravure::protocol {

/// Writes and reads unsigned integers, low byte first, one after the other. The caller knows that they fit.
class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::byte> bytes) : bytes_(bytes) {}
  void put(std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      bytes_[at_++] = static_cast<std::byte>(value >> (8 * i));
    }
  }

 private:
  std::span<std::byte> bytes_;
  std::size_t at_ = 0;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint64_t take(std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value |= std::uint64_t{std::to_integer<std::uint8_t>(bytes_[at_++])} << (8 * i);
    }
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace gravure::protocol
