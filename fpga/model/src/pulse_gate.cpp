#include "gravure/fpga/pulse_gate.hpp"

#include <algorithm>

namespace gravure::fpga {

GateRefusal check(const GateRegisters& registers) noexcept {
  if (registers.ticks_per_slot == 0) {
    return GateRefusal::ticks_per_slot;
  }
  if (registers.slots_per_line == 0) {
    return GateRefusal::slots_per_line;
  }
  if (registers.window_slots > std::min(registers.slots_per_line, kMaxWindowSlots)) {
    return GateRefusal::window_slots;
  }
  return GateRefusal::none;
}

std::optional<PulseGate> PulseGate::make(const GateRegisters& registers) noexcept {
  if (check(registers) != GateRefusal::none) {
    return std::nullopt;
  }
  return PulseGate(registers);
}

void PulseGate::raise_fault() noexcept {
  fault_ = true;
  open_ = false;
}

void PulseGate::start_line(std::span<const std::byte> bits, std::uint64_t first_slot) noexcept {
  const bool fits = first_slot <= registers_.slots_per_line - registers_.window_slots &&
                    bits.size() == packed_bytes(registers_.window_slots);
  if (running_ || !fits) {
    raise_fault();
  }
  open_ = !fault_;
  if (running_) {
    return;  // the line in progress ends in its own time, dark
  }
  running_ = true;
  bits_ = bits;
  first_slot_ = static_cast<std::uint32_t>(open_ ? first_slot : 0);
  tick_ = 0;
  slot_ = 0;
}

bool PulseGate::slot_fires() const noexcept {
  const std::uint32_t place = slot_ - first_slot_;
  if (slot_ < first_slot_ || place >= registers_.window_slots) {
    return false;
  }
  return ((std::to_integer<unsigned>(bits_[place / 8]) >> (7 - place % 8)) & 1U) != 0;
}

PulseGate::Pins PulseGate::step() noexcept {
  if (!running_) {
    return {};
  }
  Pins pins;
  pins.slot = tick_ == 0;
  pins.gate = open_ && !fault_ && slot_fires();
  if (++tick_ == registers_.ticks_per_slot) {
    tick_ = 0;
    if (++slot_ == registers_.slots_per_line) {
      pins.line_done = true;
      running_ = false;
      open_ = false;
    }
  }
  return pins;
}

void gate_line(std::span<const std::byte> bits, std::uint32_t window_slots, bool dark,
               std::span<std::byte> fired) noexcept {
  if (dark) {
    std::fill(fired.begin(), fired.end(), std::byte{0});
    return;
  }
  std::copy(bits.begin(), bits.end(), fired.begin());
  if (window_slots % 8 != 0) {
    fired.back() &= static_cast<std::byte>(0xFF00U >> (window_slots % 8));  // slots past the window stay dark
  }
}

}  // namespace gravure::fpga
