#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace gravure::fpga {

/// Registers of the pulse slots of a line. One slot is one amplified laser pulse.
struct GateRegisters {
  std::uint32_t ticks_per_slot = 1;  ///< j * k, >= 1
  std::uint32_t slots_per_line = 1;  ///< np, >= 1
  std::uint32_t window_slots = 0;    ///< slots that carry pixels, <= slots_per_line and <= kMaxWindowSlots
};

/// The line buffer: 2 MiB of packed slots.
inline constexpr std::uint32_t kMaxWindowSlots = std::uint32_t{1} << 24;

enum class GateRefusal : std::uint8_t { none, ticks_per_slot, slots_per_line, window_slots };

GateRefusal check(const GateRegisters& registers) noexcept;

/// Bytes of the packed bits of `slots` slots, MSB first.
constexpr std::size_t packed_bytes(std::uint32_t slots) noexcept {
  return (static_cast<std::size_t>(slots) + 7) / 8;
}

/// The pulse gate, clock by clock: slot divider, line of np slots, marking window. One step() is one FPGA clock.
///
/// start_line() before a step makes that step the first tick of slot 0. During the slots first .. first + window - 1
/// the gate shows the line's bits, MSB first, 1 open; outside them it is closed. A fault closes it in the same clock
/// and is sticky; after acknowledge() it stays closed until the next line starts, so no part of a line is ever fired.
class PulseGate {
 public:
  struct Pins {
    bool slot = false;       ///< first tick of a slot
    bool gate = false;       ///< pulses pass
    bool line_done = false;  ///< last tick of the line
  };

  /// Nothing where check() refuses the registers.
  static std::optional<PulseGate> make(const GateRegisters& registers) noexcept;

  /// `bits` must outlive the line. Raises the fault where the window leaves the line, the bits are not packed_bytes()
  /// long, or the last line is still running.
  void start_line(std::span<const std::byte> bits, std::uint64_t first_slot) noexcept;
  void raise_fault() noexcept;
  void acknowledge() noexcept { fault_ = false; }

  Pins step() noexcept;

  bool fault() const noexcept { return fault_; }
  bool running() const noexcept { return running_; }

 private:
  explicit PulseGate(const GateRegisters& registers) noexcept : registers_(registers) {}
  bool slot_fires() const noexcept;

  GateRegisters registers_;
  std::span<const std::byte> bits_;
  std::uint32_t first_slot_ = 0;
  std::uint32_t tick_ = 0;  ///< within the slot
  std::uint32_t slot_ = 0;  ///< within the line
  bool running_ = false;
  bool open_ = false;  ///< this line may fire
  bool fault_ = false;
};

/// A whole line through the gate at once: what PulseGate would show in its window slots, packed like `bits`.
/// Both spans are packed_bytes(window_slots) long. `dark`: the fault stood when the line started.
void gate_line(std::span<const std::byte> bits, std::uint32_t window_slots, bool dark,
               std::span<std::byte> fired) noexcept;

}  // namespace gravure::fpga
