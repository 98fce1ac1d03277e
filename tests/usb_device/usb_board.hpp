#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::test {

/// What sits behind the endpoints of a test device. Called by one thread at a time.
class UsbBoard {
 public:
  virtual ~UsbBoard() = default;
  /// An Error stalls endpoint 0.
  virtual Result<std::uint32_t> read_register(std::uint8_t address) = 0;
  virtual Result<void> write_register(std::uint8_t address, std::uint32_t value) = 0;
  /// How many bytes of the stream were taken; fewer where there is no room for more.
  virtual std::size_t take(std::span<const std::byte> stream) = 0;
  /// Runs what can run by now.
  virtual void pass_time() {}
  /// `sequence` is the device's to fill in.
  virtual BoardStatus status() = 0;
};

}  // namespace gravure::test
