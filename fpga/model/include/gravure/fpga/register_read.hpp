#pragma once

#include <array>
#include <cstdint>

#include "gravure/fpga/register_map.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/register_read.v: what the host finds at an address. Registers that it writes are kept
/// here once more, as they were accepted.
/// Latency (latencies.hpp): kReadLatency.
class RegisterRead {
 public:
  struct Inputs {
    bool rst = false;
    std::uint8_t address = 0;
    std::uint16_t status = 0;
    std::uint32_t level = 0;
    std::uint8_t faults = 0;
    std::uint32_t index_error = 0;  ///< 18 bits
    std::uint32_t executed_lines = 0;
    std::uint32_t closed_slot = 0;
    bool store = false;  ///< keeps store_data, at an address of kStoredWords
    std::uint8_t store_address = 0;
    std::uint32_t store_data = 0;
  };
  struct Outputs {
    std::uint32_t read_data = 0;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  explicit RegisterRead(int fifo_bits) noexcept : fifo_bits_(fifo_bits) { forget(); }
  Outputs step(const Inputs& in) noexcept;

 private:
  void forget() noexcept;
  std::uint32_t value(const Inputs& in) const noexcept;

  int fifo_bits_;
  std::uint32_t value_ = 0;
  std::array<std::uint32_t, 256> stored_{};  ///< 0 where nothing can be stored
};

}  // namespace gravure::fpga
