#include "gravure/fpga/synchro.hpp"

#include <algorithm>

#include "control_bits.hpp"

namespace gravure::fpga {
namespace {

/// Bits of the command register.
enum Command : std::uint16_t {
  kAcknowledge = 1,
  kLoad0 = 2,
  kIncrement0 = 4,
  kPosition = 8,
  kLoad1 = 16,
  kIncrement1 = 32,
  kGo = 64,
  kAppend0 = 128,
  kAppend1 = 256,
  kEmpty = 512
};

bool has(const Settings::Outputs& settings, Control bit) noexcept {
  return (settings.control & bit) != 0;
}
bool has(const Settings::Outputs& settings, Command bit) noexcept {
  return (settings.command & bit) != 0;
}

constexpr std::uint32_t kOddLine = 0x100'0000;  ///< in an entry of the line queue

}  // namespace

Synchro::Synchro(int fifo_bits, int schedule_bits)
    : fifo_bits_(fifo_bits),
      schedules_{IncrementSchedule(schedule_bits), IncrementSchedule(schedule_bits)},
      axes_{AbGenerator(kAxisWidths), AbGenerator(kAxis1Widths)},
      bits_(fifo_bits),
      queue_(4),
      read_(fifo_bits) {}

AbGenerator::Inputs Synchro::axis_inputs(std::size_t axis, bool rst) const noexcept {
  const Settings::Outputs& s = now_.settings;
  const IncrementSchedule::Outputs& schedule = now_.schedules[axis];
  const bool one = axis == 1;
  const std::uint32_t increment = one ? s.increment_1 : s.increment;
  return {.rst = rst,
          .enable = has(s, one ? kEnable1 : kEnable0),
          .load = has(s, one ? kLoad1 : kLoad0),
          .backward = has(s, one ? kBackward1 : kBackward0),
          .load_increment = has(s, one ? kIncrement1 : kIncrement0) || schedule.load_increment,
          .increment = schedule.load_increment ? schedule.increment : increment,
          .prescaler = one ? s.prescaler_1 : s.prescaler,
          .fraction_num = one ? s.fraction_num_1 : s.fraction_num,
          .fraction_den = one ? s.fraction_den_1 : s.fraction_den};
}

void Synchro::step_axes(const Inputs& in, const Wires& was) noexcept {
  const Settings::Outputs& s = was.settings;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    now_.schedules[axis] = schedules_[axis].step({.rst = in.rst,
                                                  .flush = has(s, kEmpty),
                                                  .run = was.schedules_run,
                                                  .push = has(s, axis == 0 ? kAppend0 : kAppend1),
                                                  .push_increment = s.schedule_increment,
                                                  .push_clocks = s.schedule_seeds});
  }
  now_.schedules_run = !in.rst && !has(s, kEmpty) && (was.schedules_run || has(s, kGo));
}

void Synchro::step_stream(const Inputs& in, const Wires& was) noexcept {
  const Settings::Outputs& s = was.settings;
  const bool clear = has(s, kAcknowledge);
  now_.parser = parser_.step({.rst = in.rst,
                              .clear = clear,
                              .in_valid = in.in_valid,
                              .position_load = has(s, kPosition),
                              .in_data = in.in_data,
                              .slots_per_line = s.slots_per_line,
                              .window_slots = s.window_slots,
                              .lines_per_revolution = s.lines_per_revolution,
                              .position_revolution = s.position_revolution,
                              .position_line = s.position_line});
  const std::uint32_t most = (std::uint32_t{4} << static_cast<unsigned>(fifo_bits_)) - 1;
  now_.bits = bits_.step({.rst = in.rst,
                          .flush = clear,
                          .push = was.parser.push,
                          .commit = was.parser.commit,
                          .rollback = was.parser.rollback,
                          .pop = was.gate.byte_take,
                          .push_data = was.parser.push_data,
                          .low_level = std::min<std::uint32_t>(s.low_level, most)});
  now_.queue = queue_.step({.rst = in.rst,
                            .flush = clear,
                            .push = was.parser.line_valid,
                            .commit = was.queue_commit,
                            .pop = was.line.first,
                            .push_data = was.parser.first_slot | (was.parser.odd ? kOddLine : 0)});
  now_.queue_commit = was.parser.line_valid && !in.rst;
}

void Synchro::step_lines(const Inputs& in, const Wires& was) noexcept {
  const Settings::Outputs& s = was.settings;
  const bool run = has(s, kRun);
  const bool missing =
      was.slots.slot && was.start.started && !was.line.running && s.slots_per_line != 0 && !was.queue.valid;
  now_.line_missing = missing && !in.rst && !has(s, kAcknowledge);
  now_.was_missing = was.line_missing && !in.rst && !has(s, kAcknowledge);
  now_.slots = slots_.step({.rst = in.rst,
                            .run = start_.slots_run(run, has(s, kTimed)),
                            .seeds_per_slot = s.seeds_per_slot,
                            .adjust = was.reference.adjust,
                            .amount = was.reference.amount});
  now_.start = start_.step({.rst = in.rst,
                            .run = run,
                            .timed = has(s, kTimed),
                            .strobe = in.start,
                            .go = has(s, kGo),
                            .first_tick = s.first_tick});
  now_.line = line_.step({.rst = in.rst || !run,
                          .slot = was.slots.slot,
                          .start = was.start.started,
                          .slots_per_line = s.slots_per_line,
                          .first_slot = was.queue.data & (kOddLine - 1),
                          .window_slots = s.window_slots});
  now_.scanner = scanner_.step({.rst = in.rst,
                                .decision = was.line.decision,
                                .first = was.line.first,
                                .slots_per_microvector = s.slots_per_microvector});
  now_.reference = reference_.step({.rst = in.rst,
                                    .clear = has(s, kAcknowledge),
                                    .enable = has(s, kReference) && run,
                                    .index = in.index,
                                    .line_end = was.line.last,
                                    .revolution = s.revolution_seeds,
                                    .window = s.index_window,
                                    .limit = s.correction_limit});
}

void Synchro::step_gate(const Inputs& in, const Wires& was) noexcept {
  const Settings::Outputs& s = was.settings;
  const bool clear = has(s, kAcknowledge);
  const bool run = has(s, kRun);
  now_.delayed = delay_.step({.rst = in.rst || !run,
                              .delay = s.reverse_delay,
                              .reverse = (was.queue.data & kOddLine) != 0 && has(s, kBackward),
                              .slot_in = was.line.slot_out,
                              .decision_in = was.line.decision,
                              .window_in = was.line.window,
                              .first_in = was.line.first,
                              .last_in = was.line.last});
  const bool bad = was.faults.any || was.was_missing || was.host.expired || was.stream_error;
  now_.gate = gate_.step({.rst = in.rst,
                          .run = run,
                          .clear = clear,
                          .fault = in.interlock || (!clear && bad),
                          .slot = was.delayed.slot,
                          .decision = was.delayed.decision,
                          .window = was.delayed.window,
                          .first = was.delayed.first,
                          .last = was.delayed.last,
                          .byte_valid = was.bits.valid,
                          .byte_data = was.bits.data});
  now_.progress = progress_.step({.rst = in.rst,
                                  .clear = clear,
                                  .load = has(s, kPosition),
                                  .run = run,
                                  .begins = was.line.first,
                                  .queued = was.queue.valid,
                                  .slot = was.delayed.slot,
                                  .passed = was.gate.passed,
                                  .open = was.gate.open,
                                  .dark = was.gate.dark});
}

void Synchro::step_faults(const Inputs& in, const Wires& was) noexcept {
  const Settings::Outputs& s = was.settings;
  const bool clear = has(s, kAcknowledge);
  const bool overflow = was.bits.overflow || was.queue.overflow;
  const FrameParser::Outputs& parser = was.parser;
  now_.stream_error =
      !in.rst && !clear && (overflow || parser.sequence_error || parser.shape_error || parser.checksum_error);
  now_.host = host_.step({.rst = in.rst,
                          .enable = has(s, kWatch),
                          .kick = in.in_valid || in.write,
                          .clear = clear,
                          .limit = s.silence_limit});
  now_.faults = faults_.step({.rst = in.rst,
                              .acknowledge = clear,
                              .sequence_error = parser.sequence_error && !clear,
                              .checksum_error = parser.checksum_error && !clear,
                              .shape_error = (parser.shape_error || overflow) && !clear,
                              .underrun = (was.gate.underrun || was.was_missing) && !clear,
                              .host_silence = was.host.expired && !clear,
                              .interlock = in.interlock});
}

std::uint16_t Synchro::status(const Wires& was) const noexcept {
  const bool bits[] = {was.gate.dark,           was.line.running,
                       was.axes[0].refused,     was.bits.overflow || was.queue.overflow,
                       was.axes[1].refused,     was.schedules[0].busy,
                       was.schedules[1].busy,   was.schedules[0].overflow || was.schedules[1].overflow,
                       was.settings.refused,    was.reference.lost,
                       was.start.started,       was.bits.almost_empty,
                       was.reference.referenced};
  unsigned value = was.faults.fault;
  unsigned at = 3;
  for (const bool bit : bits) {
    value |= bit ? 1U << at : 0U;
    ++at;
  }
  return static_cast<std::uint16_t>(value);
}

/// A seed clock: all but the axes.
void Synchro::step_seed(const Inputs& in) noexcept {
  const Wires was = now_;
  now_.read = read_.step({.rst = in.rst,
                          .address = in.address,
                          .status = status(was),
                          .level = was.bits.level,
                          .faults = was.faults.seen,
                          .index_error = was.reference.error,
                          .executed_lines = was.progress.executed,
                          .closed_slot = was.progress.closed_slot(),
                          .store = was.settings.store,
                          .store_address = was.settings.store_address,
                          .store_data = was.settings.store_data});
  now_.settings = settings_.step({.rst = in.rst,
                                  .clear = has(was.settings, kAcknowledge),
                                  .write = in.write,
                                  .address = in.address,
                                  .write_data = in.write_data});
  step_axes(in, was);
  step_stream(in, was);
  step_lines(in, was);
  step_gate(in, was);
  step_faults(in, was);
}

Synchro::Outputs Synchro::step(const Inputs& in) noexcept {
  std::array<AbGenerator::Outputs, kAxes> axes;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    axes[axis] = axes_[axis].step(axis_inputs(axis, in.rst));
  }
  if (seed_edge_) {
    step_seed(in);
  }
  seed_edge_ = !seed_edge_;
  now_.axes = axes;
  return {.a = axes[0].a,
          .b = axes[0].b,
          .a_1 = axes[1].a,
          .b_1 = axes[1].b,
          .gate = now_.gate.gate,
          .scan = now_.scanner.scan,
          .fault = now_.faults.fault,
          .read_data = now_.read.read_data};
}

}  // namespace gravure::fpga
