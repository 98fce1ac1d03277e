#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "gravure/fpga/axis_track.hpp"
#include "gravure/fpga/synchro.hpp"

namespace gravure::fpga {

/// The board from event to event: the pins of Synchro at every clock, without visiting the clocks at which nothing but
/// counters move.
///
/// The axes run in closed form (AxisTrack) but for the clocks around a load of their registers. All else is stepped
/// while something flows between the blocks. Once nothing has for kStillClocks, and the host has done nothing for
/// kHostClocks, only the counters of slots, lines, schedules, encoder and watchdog move, and the time until the first
/// of them does something is jumped over.
class SynchroEvents {
 public:
  /// What the pins show from a clock on.
  struct Event {
    std::uint64_t clock = 0;  ///< FPGA clock after which this shows; clocks count from 1
    std::array<AbPins, Synchro::kAxes> axes;
    bool gate = false;
    bool scan = false;
    std::uint8_t fault = 0;
    std::uint32_t fifo_level = 0;  ///< as the register of that name has it
    bool same_pins(const Event& other) const noexcept {
      return axes == other.axes && gate == other.gate && scan == other.scan && fault == other.fault &&
             fifo_level == other.fifo_level;
    }
  };

  explicit SynchroEvents(int fifo_bits, int schedule_bits = 8) : board_(fifo_bits, schedule_bits) {}

  /// Holds `in` for `clocks` FPGA clocks. Like Synchro it looks at them on seed clocks only, on each of them: a write
  /// held for two seed clocks is two writes. sink(const Event&) for every clock after which a pin or the FIFO level is
  /// another than before.
  template <class Sink>
  void run(const Synchro::Inputs& in, std::uint64_t clocks, Sink&& sink);

  std::uint64_t clock() const noexcept { return now_.clock; }
  /// As Synchro::step() returned them on the last clock.
  Synchro::Outputs outputs() const noexcept;
  /// As Synchro has it after the last clock.
  const LineProgress::Outputs& line_progress() const noexcept { return board_.line_progress(); }
  /// How many seed clocks were stepped, of all that passed: the rest was jumped over.
  std::uint64_t stepped() const noexcept { return stepped_; }

 private:
  /// Seed clocks without a change on any wire after which no register is still on its way from block to block.
  static constexpr int kStillClocks = 3;
  /// Seed clocks after a byte, a write or another input until what they set off inside a block shows.
  static constexpr int kHostClocks = 10;
  /// Seed clocks from the front of an axis to its pins, rounded up.
  static constexpr int kFrontClocks = AbGenerator::enable_latency(Synchro::kAxisWidths) / 2 + 2;
  static constexpr std::uint64_t kForEver = ~std::uint64_t{0};

  bool at_seed_edge() const noexcept { return now_.clock % AbGenerator::kClockMultiplier == 0; }
  void take_inputs(const Synchro::Inputs& in) noexcept;
  AbPacer::Inputs axis_inputs(std::size_t axis) const noexcept { return board_.axis_inputs(axis, in_.rst); }
  bool axes_disturbed() const noexcept;
  void wake_axes() noexcept;
  void settle_axes() noexcept;
  void step_live() noexcept;
  void step_logic() noexcept;
  void watch(const Synchro::Wires& was) noexcept;
  void show_logic() noexcept;

  std::uint64_t still_for() const noexcept;
  std::uint64_t slots_still_for() const noexcept;
  std::uint64_t start_still_for() const noexcept;
  std::uint64_t schedule_still_for(const IncrementSchedule& schedule) const noexcept;
  std::uint64_t reference_still_for() const noexcept;
  std::uint64_t host_still_for() const noexcept;
  void jump(std::uint64_t seed_clocks) noexcept;

  std::uint64_t next_edge() const noexcept { return std::min(tracks_[0]->next_clock(), tracks_[1]->next_clock()); }
  /// The edges on one clock.
  void take_edges(std::uint64_t clock) noexcept;
  /// Edges up to and including `last`, each clock an event of its own.
  template <class Sink>
  void show_edges(std::uint64_t last, Sink& sink);
  template <class Sink>
  void show(const Event& before, Sink& sink);
  template <class Sink>
  void advance(std::uint64_t clocks, Sink& sink);

  Synchro board_;
  Synchro::Inputs in_;
  Event now_;
  int still_ = 0;          ///< seed clocks without a change on any wire
  int since_host_ = 0;     ///< seed clocks with these inputs
  int settled_ = 0;        ///< seed clocks since an axis was disturbed
  bool tracking_ = false;  ///< the axes of board_ stand at live_clock_, and tracks_ are what counts
  std::uint64_t live_clock_ = 0;
  std::array<bool, Synchro::kAxes> enabled_{};  ///< what the axes are held at
  std::array<std::optional<AxisTrack>, Synchro::kAxes> tracks_;
  std::uint64_t stepped_ = 0;
};

template <class Sink>
void SynchroEvents::show(const Event& before, Sink& sink) {
  if (!now_.same_pins(before)) {
    sink(std::as_const(now_));
  }
}

template <class Sink>
void SynchroEvents::show_edges(std::uint64_t last, Sink& sink) {
  for (std::uint64_t clock = next_edge(); clock <= last; clock = next_edge()) {
    take_edges(clock);
    now_.clock = clock;
    sink(std::as_const(now_));
  }
  now_.clock = last;
}

/// At least one clock, `clocks` at most.
template <class Sink>
void SynchroEvents::advance(std::uint64_t clocks, Sink& sink) {
  const Event before = now_;
  if (!tracking_) {
    step_live();
    show(before, sink);
    return;
  }
  if (!at_seed_edge()) {
    show_edges(now_.clock + 1, sink);
    return;
  }
  const std::uint64_t seed_clocks = std::min(still_for(), clocks / AbGenerator::kClockMultiplier);
  if (seed_clocks != 0) {
    jump(seed_clocks);
    show_edges(now_.clock + seed_clocks * AbGenerator::kClockMultiplier, sink);
    return;
  }
  take_edges(++now_.clock);
  step_logic();
  show(before, sink);
}

template <class Sink>
void SynchroEvents::run(const Synchro::Inputs& in, std::uint64_t clocks, Sink&& sink) {
  take_inputs(in);
  const std::uint64_t end = now_.clock + clocks;
  while (now_.clock < end) {
    if (tracking_ && at_seed_edge() && axes_disturbed()) {
      wake_axes();
    }
    advance(end - now_.clock, sink);
  }
}

}  // namespace gravure::fpga
