#include "gravure/emulator/machine_waves.hpp"

#include <algorithm>

#include "device_checks.hpp"

namespace gravure::emulator {
namespace {

constexpr std::size_t place(Signal signal) noexcept {
  return static_cast<std::size_t>(signal);
}

bool fires(const ExecutedLine& line, std::int64_t window_slots, std::int64_t slot) {
  const std::int64_t at = slot - line.first_slot;
  if (at < 0 || at >= window_slots) {
    return false;
  }
  const unsigned byte = std::to_integer<unsigned>(line.fired[static_cast<std::size_t>(at / 8)]);
  return ((byte >> static_cast<unsigned>(7 - at % 8)) & 1U) != 0;
}

/// An axis that runs backward has its pins exchanged.
fpga::AbPins shown(fpga::AbPins pins, bool backward) {
  return backward ? fpga::AbPins{pins.b, pins.a} : pins;
}

}  // namespace

MachineWaves::MachineWaves(const Setup& setup, WaveSink& sink)
    : setup_(setup), sink_(sink), edges_(*fpga::AbEdges::make(ab_registers_of(setup.device))) {
  start_run(setup.device);
}

void MachineWaves::start_run(const DeviceSetup& device) {
  const auto begin = static_cast<std::uint64_t>(device.begin_revolution * device.lines_per_revolution *
                                                device.slots_per_line * device.ticks_per_slot);
  if (begin > 0) {
    fall_by(begin - 1);
    edges_to(begin - 1);
  }
  setup_.device = device;
  run_tick_ = begin;
  edges_ = *fpga::AbEdges::make(ab_registers_of(device));
  const std::uint64_t shown_from = std::max(begin, setup_.first_tick);
  const fpga::AbPins pins = shown(fpga::position_after(edges_.registers(), shown_from - begin).pins, device.backward);
  set(shown_from, Signal::a, pins.a ? 1 : 0);
  set(shown_from, Signal::b, pins.b ? 1 : 0);
  edges_.seek(shown_from - begin);
  take_edge();
}

void MachineWaves::take_edge() {
  const auto edge = edges_.next_edge();
  edges_left_ = edge.has_value();
  if (edges_left_) {
    next_edge_ = {edge->clock + run_tick_, shown(edge->pins, setup_.device.backward)};
  }
}

void MachineWaves::open_window() {
  if (!open_) {
    open_ = true;
    stopped_ = !sink_.begin(setup_.first_tick, values_);
  }
}

void MachineWaves::set(std::uint64_t tick, Signal signal, std::uint64_t value) {
  std::uint64_t& now = values_[place(signal)];
  if (now == value || tick > setup_.last_tick || stopped_) {
    return;
  }
  if (tick > setup_.first_tick) {
    open_window();
    stopped_ = stopped_ || !sink_.change(tick, signal, value);
  }
  now = value;
}

/// A and B up to and including `tick`.
void MachineWaves::edges_to(std::uint64_t tick) {
  while (edges_left_ && !stopped_ && next_edge_.clock <= tick) {
    set(next_edge_.clock, Signal::a, next_edge_.pins.a ? 1 : 0);
    set(next_edge_.clock, Signal::b, next_edge_.pins.b ? 1 : 0);
    take_edge();
  }
}

/// Both strobes low, if that is due by `tick`.
void MachineWaves::fall_by(std::uint64_t tick) {
  if (!strobes_high_ || strobes_fall_ > tick) {
    return;
  }
  edges_to(strobes_fall_);
  set(strobes_fall_, Signal::line_start, 0);
  set(strobes_fall_, Signal::scanner_clock, 0);
  strobes_high_ = false;
}

void MachineWaves::slot(const ExecutedLine& line, std::int64_t number, std::uint64_t tick) {
  if (tick != 0) {
    fall_by(tick - 1);
  }
  edges_to(tick);
  if (number == 0) {
    set(tick, Signal::revolution, static_cast<std::uint64_t>(line.ordinal / setup_.device.lines_per_revolution));
    set(tick, Signal::line, static_cast<std::uint64_t>(line.ordinal % setup_.device.lines_per_revolution));
  }
  const bool microvector = number % setup_.slots_per_microvector == 0;
  set(tick, Signal::line_start, number == 0 ? 1 : 0);
  set(tick, Signal::scanner_clock, microvector ? 1 : 0);
  set(tick, Signal::gate, fires(line, setup_.device.window_slots, number) ? 1 : 0);
  strobes_high_ = microvector;
  strobes_fall_ = tick + static_cast<std::uint64_t>(setup_.ticks_per_seed_clock);
}

void MachineWaves::on_line(const ExecutedLine& line) {
  const std::int64_t ticks_per_slot = setup_.device.ticks_per_slot;
  const auto start = static_cast<std::uint64_t>(line.start_tick);
  const std::uint64_t end = start + static_cast<std::uint64_t>(ticks_per_slot * setup_.device.slots_per_line);
  if (end < setup_.first_tick || start > setup_.last_tick) {
    return;
  }
  for (std::int64_t number = 0; number < setup_.device.slots_per_line && !stopped_; ++number) {
    const std::uint64_t tick = start + static_cast<std::uint64_t>(number * ticks_per_slot);
    if (tick > setup_.last_tick) {
      return;
    }
    slot(line, number, tick);
  }
  fall_by(end);
}

void MachineWaves::finish() {
  fall_by(setup_.last_tick);
  edges_to(setup_.last_tick);
  open_window();
}

}  // namespace gravure::emulator
