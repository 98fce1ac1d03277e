#pragma once

#include <cstdint>

#include "gravure/fpga/settings.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/register_read.v: what the host finds at an address.
class RegisterRead {
 public:
  static constexpr int kLatency = 2;  ///< clocks from address to read_data

  struct Inputs {
    bool rst = false;
    std::uint8_t address = 0;
    std::uint16_t status = 0;
    std::uint32_t level = 0;
    std::uint8_t faults = 0;
    std::uint32_t index_error = 0;  ///< 18 bits
    const Settings::Outputs& settings;
  };
  struct Outputs {
    std::uint32_t read_data = 0;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  explicit RegisterRead(int fifo_bits) noexcept : fifo_bits_(fifo_bits) {}
  Outputs step(const Inputs& in) noexcept {
    const Outputs out{.read_data = in.rst ? 0 : value_};
    value_ = value(in);
    return out;
  }

 private:
  std::uint32_t value(const Inputs& in) const noexcept;
  std::uint32_t of_board(const Inputs& in) const noexcept;

  int fifo_bits_;
  std::uint32_t value_ = 0;
};

}  // namespace gravure::fpga
