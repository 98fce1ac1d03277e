#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace gravure::test {

/// What goes wrong with one transfer on one endpoint.
struct UsbFault {
  enum class Kind : std::uint8_t {
    stall,      ///< after `bytes`; the endpoint stays halted until CLEAR_HALT
    cut_short,  ///< completes after `bytes`
    never,      ///< NAK for ever, this transfer and those behind it
    babble,     ///< more data than asked for
    bus_error,
    refuse,   ///< not taken by the system (ENOMEM)
    delay,    ///< completes `delay` later
    hold,     ///< completes only after `transfers` later ones, or `delay` later
    corrupt,  ///< the lowest bit of byte `bytes` is flipped on the way
    lose,     ///< completes, but arrives nowhere
    twice,    ///< arrives twice
    unplug,   ///< after `bytes` the device is gone
  };
  Kind kind = Kind::stall;
  std::size_t skip = 0;  ///< transfers on the endpoint that go well before
  std::size_t bytes = 0;
  std::size_t transfers = 1;
  std::chrono::milliseconds delay{50};
};

}  // namespace gravure::test
