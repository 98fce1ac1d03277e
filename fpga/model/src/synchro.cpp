#include "gravure/fpga/synchro.hpp"

namespace gravure::fpga {
namespace {

constexpr std::uint64_t joined(std::uint32_t high, std::uint32_t low) noexcept {
  return (static_cast<std::uint64_t>(high & 3U) << 32U) | low;
}

constexpr std::uint32_t high_word(std::uint64_t value) noexcept {
  return static_cast<std::uint32_t>(value >> 32U);
}

}  // namespace

Synchro::Synchro(int fifo_bits) : fifo_bits_(fifo_bits), axis_(kAxisWidths), bits_(fifo_bits), queue_(4) {}

void Synchro::write(Registers& r, std::uint8_t address, std::uint32_t data) noexcept {
  const auto low_half = static_cast<std::uint16_t>(data);
  switch (address) {
    case kControlRegister.address:
      r.control = data & 7U;
      break;
    case kCommandRegister.address:
      r.command = data & 15U;
      break;
    case kIncrementRegister.address:
      r.increment = data;
      break;
    case kPrescalerRegister.address:
      r.prescaler = data;
      break;
    case kFractionNumRegister.address:
      r.num_low = data;
      break;
    case kFractionNumRegister.address + 1:
      r.fraction_num = joined(data, r.num_low);
      break;
    case kFractionDenRegister.address:
      r.den_low = data;
      break;
    case kFractionDenRegister.address + 1:
      r.fraction_den = joined(data, r.den_low);
      break;
    case kTicksPerSlotRegister.address:
      r.ticks_per_slot = low_half;
      break;
    case kSlotsPerLineRegister.address:
      r.slots_per_line = low_half;
      break;
    case kWindowSlotsRegister.address:
      r.window_slots = low_half;
      break;
    case kSlotsPerMicrovectorRegister.address:
      r.slots_per_microvector = low_half;
      break;
    case kLinesPerRevolutionRegister.address:
      r.lines_per_revolution = data;
      break;
    case kPositionRevolutionRegister.address:
      r.position_revolution = data;
      break;
    case kPositionLineRegister.address:
      r.position_line = data;
      break;
    case kSilenceLimitRegister.address:
      r.silence_limit = data;
      break;
    default:
      break;
  }
}

std::uint32_t Synchro::read(std::uint8_t address) const noexcept {
  const Registers& r = registers_;
  switch (address) {
    case kMagicRegister.address:
      return kMagicRegister.reset;
    case kVersionRegister.address:
      return kVersionRegister.reset;
    case kCounterBitsRegister.address:
      return kCounterBitsRegister.reset;
    case kFifoBitsRegister.address:
      return static_cast<std::uint32_t>(fifo_bits_);
    case kClockMultiplierRegister.address:
      return kClockMultiplierRegister.reset;
    case kControlRegister.address:
      return r.control;
    case kStatusRegister.address:
      return now_.faults.fault | (now_.gate.dark ? 8U : 0U) | (now_.line.running ? 16U : 0U) |
             (now_.axis.refused ? 32U : 0U) | (now_.bits.overflow || now_.queue.overflow ? 64U : 0U);
    case kFifoLevelRegister.address:
      return now_.bits.level;
    case kIncrementRegister.address:
      return r.increment;
    case kPrescalerRegister.address:
      return r.prescaler;
    case kFractionNumRegister.address:
      return static_cast<std::uint32_t>(r.fraction_num);
    case kFractionNumRegister.address + 1:
      return high_word(r.fraction_num);
    case kFractionDenRegister.address:
      return static_cast<std::uint32_t>(r.fraction_den);
    case kFractionDenRegister.address + 1:
      return high_word(r.fraction_den);
    case kTicksPerSlotRegister.address:
      return r.ticks_per_slot;
    case kSlotsPerLineRegister.address:
      return r.slots_per_line;
    case kWindowSlotsRegister.address:
      return r.window_slots;
    case kSlotsPerMicrovectorRegister.address:
      return r.slots_per_microvector;
    case kLinesPerRevolutionRegister.address:
      return r.lines_per_revolution;
    case kPositionRevolutionRegister.address:
      return r.position_revolution;
    case kPositionLineRegister.address:
      return r.position_line;
    case kSilenceLimitRegister.address:
      return r.silence_limit;
    default:
      return 0;
  }
}

void Synchro::step_stream(const Inputs& in, const Wires& was) noexcept {
  const bool clear = acknowledge();
  now_.parser = parser_.step({.rst = in.rst,
                              .clear = clear,
                              .in_valid = in.in_valid,
                              .position_load = (registers_.command & 8U) != 0,
                              .in_data = in.in_data,
                              .slots_per_line = registers_.slots_per_line,
                              .window_slots = registers_.window_slots,
                              .lines_per_revolution = registers_.lines_per_revolution,
                              .position_revolution = registers_.position_revolution,
                              .position_line = registers_.position_line});
  now_.bits = bits_.step({.rst = in.rst,
                          .flush = clear,
                          .push = was.parser.push,
                          .commit = was.parser.commit,
                          .rollback = was.parser.rollback,
                          .pop = was.gate.byte_take,
                          .push_data = was.parser.push_data});
  now_.queue = queue_.step({.rst = in.rst,
                            .flush = clear,
                            .push = was.parser.line_valid,
                            .commit = was.queue_commit,
                            .pop = was.line.first,
                            .push_data = was.parser.first_slot});
  now_.queue_commit = was.parser.line_valid && !in.rst;
}

void Synchro::step_lines(const Inputs& in, const Wires& was) noexcept {
  now_.slots = slots_.step({.rst = in.rst, .run = run(), .ticks_per_slot = registers_.ticks_per_slot});
  now_.started = !in.rst && run() && (was.started || in.start);
  now_.line = line_.step({.rst = in.rst || !run(),
                          .slot = was.slots.slot,
                          .start = was.started,
                          .slots_per_line = registers_.slots_per_line,
                          .first_slot = was.queue.data,
                          .window_slots = registers_.window_slots});
  now_.scanner = scanner_.step({.rst = in.rst,
                                .decision = was.line.decision,
                                .first = was.line.first,
                                .slots_per_microvector = registers_.slots_per_microvector});
}

void Synchro::step_faults(const Inputs& in, const Wires& was, bool missing) noexcept {
  const bool clear = acknowledge();
  const bool overflow = was.bits.overflow || was.queue.overflow;
  const FrameParser::Outputs& parser = was.parser;
  const bool bad = was.faults.any || was.was_missing || was.host.expired || overflow || parser.sequence_error ||
                   parser.shape_error || parser.checksum_error;
  now_.gate = gate_.step({.rst = in.rst,
                          .run = run(),
                          .clear = clear,
                          .fault = in.interlock || (!clear && bad),
                          .slot = was.line.slot_out,
                          .decision = was.line.decision,
                          .window = was.line.window,
                          .first = was.line.first,
                          .last = was.line.last,
                          .byte_valid = was.bits.valid,
                          .byte_data = was.bits.data});
  now_.host = host_.step({.rst = in.rst,
                          .enable = (registers_.control & 4U) != 0,
                          .kick = in.in_valid || in.write,
                          .clear = clear,
                          .limit = registers_.silence_limit});
  now_.faults = faults_.step({.rst = in.rst,
                              .acknowledge = clear,
                              .sequence_error = parser.sequence_error && !clear,
                              .checksum_error = parser.checksum_error && !clear,
                              .shape_error = (parser.shape_error || overflow) && !clear,
                              .underrun = (was.gate.underrun || was.was_missing) && !clear,
                              .host_silence = was.host.expired && !clear,
                              .interlock = in.interlock});
  now_.was_missing = missing && !in.rst && !clear;
}

/// A seed clock: all but the axis.
void Synchro::step_seed(const Inputs& in) noexcept {
  const Wires was = now_;
  now_.read_data = in.rst ? 0 : read(in.address);
  const bool missing =
      was.slots.slot && was.started && !was.line.running && registers_.slots_per_line != 0 && !was.queue.valid;
  step_stream(in, was);
  step_lines(in, was);
  step_faults(in, was, missing);
  registers_.command = 0;
  if (in.rst) {
    registers_ = {};
  } else if (in.write) {
    write(registers_, in.address, in.write_data);
  }
}

Synchro::Outputs Synchro::step(const Inputs& in) noexcept {
  const AbGenerator::Outputs axis = axis_.step({.rst = in.rst,
                                                .enable = (registers_.control & 2U) != 0,
                                                .load = (registers_.command & 2U) != 0,
                                                .load_increment = (registers_.command & 4U) != 0,
                                                .increment = registers_.increment,
                                                .prescaler = registers_.prescaler,
                                                .fraction_num = registers_.fraction_num,
                                                .fraction_den = registers_.fraction_den});
  if (seed_edge_) {
    step_seed(in);
  }
  seed_edge_ = !seed_edge_;
  now_.axis = axis;
  return {.a = axis.a,
          .b = axis.b,
          .gate = now_.gate.gate,
          .scan = now_.scanner.scan,
          .fault = now_.faults.fault,
          .read_data = now_.read_data};
}

}  // namespace gravure::fpga
