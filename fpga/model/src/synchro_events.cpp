#include "gravure/fpga/synchro_events.hpp"

namespace gravure::fpga {

void SynchroEvents::take_inputs(const Synchro::Inputs& in) noexcept {
  if (!(in == in_)) {
    in_ = in;
    since_host_ = 0;
  }
}

/// The next seed clock gives an axis something else than it was held at.
bool SynchroEvents::axes_disturbed() const noexcept {
  for (std::size_t axis = 0; axis < Synchro::kAxes; ++axis) {
    const AbPacer::Inputs inputs = axis_inputs(axis);
    if (inputs.rst || inputs.load || inputs.load_increment || inputs.enable != enabled_[axis]) {
      return true;
    }
  }
  return false;
}

/// The axes of board_ as they stand now: stepped there, or made from the closed form where that is far.
void SynchroEvents::wake_axes() noexcept {
  constexpr std::uint64_t kFar = std::uint64_t{2} * AbGenerator::kClockMultiplier * AxisTrack::kDrainSeedClocks;
  for (std::size_t axis = 0; axis < Synchro::kAxes; ++axis) {
    AbGenerator& generator = board_.axes_[axis];
    if (now_.clock - live_clock_ >= kFar) {
      generator = tracks_[axis]->at(now_.clock);
    } else {
      for (std::uint64_t clock = live_clock_; clock < now_.clock; ++clock) {
        static_cast<void>(generator.step({.enable = enabled_[axis]}));
      }
    }
    tracks_[axis].reset();
  }
  board_.seed_edge_ = true;
  tracking_ = false;
  settled_ = 0;
}

/// Before a seed clock: watches how long the axes have been left alone, and lets go of them.
void SynchroEvents::settle_axes() noexcept {
  settled_ = axes_disturbed() ? 0 : settled_ + 1;
  for (std::size_t axis = 0; axis < Synchro::kAxes; ++axis) {
    enabled_[axis] = axis_inputs(axis).enable;
    if (settled_ == AxisTrack::kDrainSeedClocks) {
      tracks_[axis].emplace(board_.axes_[axis], Synchro::kAxisWidths, enabled_[axis], now_.clock);
    }
  }
}

void SynchroEvents::step_live() noexcept {
  const bool seed = at_seed_edge();
  const Synchro::Wires was = board_.now_;
  if (seed) {
    settle_axes();
  }
  const Synchro::Outputs out = board_.step(in_);
  ++now_.clock;
  now_.axes = {AbPins{out.a, out.b}, AbPins{out.a_1, out.b_1}};
  show_logic();
  if (seed) {
    watch(was);
  } else if (settled_ >= AxisTrack::kDrainSeedClocks + kFrontClocks) {
    for (std::optional<AxisTrack>& track : tracks_) {
      while (track->next_clock() <= now_.clock) {
        static_cast<void>(track->take());  // was seen on the live pins
      }
    }
    live_clock_ = now_.clock;
    tracking_ = true;
  }
}

void SynchroEvents::step_logic() noexcept {
  const Synchro::Wires was = board_.now_;
  board_.step_seed(in_);
  show_logic();
  watch(was);
}

/// After a seed clock.
void SynchroEvents::watch(const Synchro::Wires& was) noexcept {
  Synchro::Wires expected = was;
  expected.axes = board_.now_.axes;
  still_ = expected == board_.now_ ? still_ + 1 : 0;
  ++since_host_;
  ++stepped_;
}

void SynchroEvents::show_logic() noexcept {
  now_.gate = board_.now_.gate.gate;
  now_.scan = board_.now_.scanner.scan;
  now_.fault = board_.now_.faults.fault;
  now_.fifo_level = board_.now_.bits.level;
}

void SynchroEvents::take_edges(std::uint64_t clock) noexcept {
  for (std::size_t axis = 0; axis < Synchro::kAxes; ++axis) {
    if (tracks_[axis]->next_clock() == clock) {
      now_.axes[axis] = tracks_[axis]->take();
    }
  }
}

Synchro::Outputs SynchroEvents::outputs() const noexcept {
  return {.a = now_.axes[0].a,
          .b = now_.axes[0].b,
          .a_1 = now_.axes[1].a,
          .b_1 = now_.axes[1].b,
          .gate = now_.gate,
          .scan = now_.scan,
          .fault = now_.fault,
          .read_data = board_.now_.read.read_data};
}

}  // namespace gravure::fpga
