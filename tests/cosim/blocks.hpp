#pragma once

#include "gravure/fpga/ab_generator.hpp"
#include "gravure/fpga/crc32c.hpp"
#include "gravure/fpga/fault_latch.hpp"
#include "gravure/fpga/frame_parser.hpp"
#include "gravure/fpga/increment_schedule.hpp"
#include "gravure/fpga/line_fifo.hpp"
#include "gravure/fpga/line_sequencer.hpp"
#include "gravure/fpga/scanner_clock.hpp"
#include "gravure/fpga/slot_divider.hpp"
#include "gravure/fpga/slot_gate.hpp"
#include "gravure/fpga/synchro.hpp"
#include "gravure/fpga/watchdog.hpp"

namespace gravure::cosim {

/// For every block: its model, and its ports in order. The visitor takes (name, member, width); the same list serves
/// the model's structs and the members of the class that Verilator makes.

template <int kBits, int kPrescalerBits, int kFractionBits, int kSegmentBits, bool kFraction>
struct AbPacerPorts {
  using Model = fpga::AbPacer;
  static constexpr Model::Widths kWidths{.bits = kBits,
                                         .prescaler_bits = kPrescalerBits,
                                         .fraction_bits = kFractionBits,
                                         .fraction = kFraction,
                                         .segment_bits = kSegmentBits};
  static Model make() { return Model(kWidths); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("enable", in.enable);
    visit("load", in.load);
    visit("load_increment", in.load_increment);
    visit("increment", in.increment, kBits);
    visit("prescaler", in.prescaler, kPrescalerBits);
    visit("fraction_num", in.fraction_num, kFractionBits);
    visit("fraction_den", in.fraction_den, kFractionBits);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("due", out.due, 2);
    visit("carry", out.carry, 2);
    visit("step", out.step, kBits);
    visit("refused", out.refused);
    visit("busy", out.busy);
  }
};

template <int kBits, int kSegmentBits>
struct AbAccumulatorPorts {
  using Model = fpga::AbAccumulator;
  static Model make() { return Model({.bits = kBits, .segment_bits = kSegmentBits}); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("clear", in.clear);
    visit("beat", in.beat);
    visit("due", in.due, 2);
    visit("carry", in.carry, 2);
    visit("step", in.step, kBits);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("a", out.a);
    visit("b", out.b);
  }
};

template <int kBits, int kPrescalerBits, int kFractionBits, int kSegmentBits, bool kFraction>
struct AbGeneratorPorts {
  using Model = fpga::AbGenerator;
  using Pacer = AbPacerPorts<kBits, kPrescalerBits, kFractionBits, kSegmentBits, kFraction>;
  static Model make() { return Model(Pacer::kWidths); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    Pacer::in(in, visit);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("a", out.a);
    visit("b", out.b);
    visit("refused", out.refused);
    visit("busy", out.busy);
  }
};

struct SlotDividerPorts {
  using Model = fpga::SlotDivider;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("run", in.run);
    visit("ticks_per_slot", in.ticks_per_slot, 16);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("slot", out.slot);
  }
};

struct LineSequencerPorts {
  using Model = fpga::LineSequencer;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("slot", in.slot);
    visit("start", in.start);
    visit("slots_per_line", in.slots_per_line, 16);
    visit("first_slot", in.first_slot, 16);
    visit("window_slots", in.window_slots, 16);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("slot_out", out.slot_out);
    visit("decision", out.decision);
    visit("window", out.window);
    visit("first", out.first);
    visit("last", out.last);
    visit("running", out.running);
  }
};

struct SlotGatePorts {
  using Model = fpga::SlotGate;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("run", in.run);
    visit("clear", in.clear);
    visit("fault", in.fault);
    visit("slot", in.slot);
    visit("decision", in.decision);
    visit("window", in.window);
    visit("first", in.first);
    visit("last", in.last);
    visit("byte_valid", in.byte_valid);
    visit("byte_data", in.byte_data, 8);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("gate", out.gate);
    visit("byte_take", out.byte_take);
    visit("underrun", out.underrun);
    visit("dark", out.dark);
  }
};

struct LineFifoPorts {
  using Model = fpga::LineFifo;
  static Model make() { return Model(4); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("flush", in.flush);
    visit("push", in.push);
    visit("commit", in.commit);
    visit("rollback", in.rollback);
    visit("pop", in.pop);
    visit("push_data", in.push_data, 8);
    visit("low_level", in.low_level, 6);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("valid", out.valid);
    visit("data", out.data, 8);
    visit("level", out.level, 6);
    visit("almost_empty", out.almost_empty);
    visit("full", out.full);
    visit("overflow", out.overflow);
  }
};

struct Crc32cPorts {
  using Model = fpga::Crc32c;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("start", in.start);
    visit("valid", in.valid);
    visit("data", in.data, 8);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("crc", out.crc, 32);
  }
};

struct ScannerClockPorts {
  using Model = fpga::ScannerClock;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("decision", in.decision);
    visit("first", in.first);
    visit("slots_per_microvector", in.slots_per_microvector, 16);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("scan", out.scan);
  }
};

struct WatchdogPorts {
  using Model = fpga::Watchdog;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("enable", in.enable);
    visit("kick", in.kick);
    visit("clear", in.clear);
    visit("limit", in.limit, 32);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("expired", out.expired);
  }
};

struct FaultLatchPorts {
  using Model = fpga::FaultLatch;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("acknowledge", in.acknowledge);
    visit("sequence_error", in.sequence_error);
    visit("checksum_error", in.checksum_error);
    visit("shape_error", in.shape_error);
    visit("underrun", in.underrun);
    visit("host_silence", in.host_silence);
    visit("interlock", in.interlock);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("fault", out.fault, 3);
    visit("any", out.any);
  }
};

struct FrameParserPorts {
  using Model = fpga::FrameParser;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("clear", in.clear);
    visit("in_valid", in.in_valid);
    visit("position_load", in.position_load);
    visit("in_data", in.in_data, 8);
    visit("slots_per_line", in.slots_per_line, 16);
    visit("window_slots", in.window_slots, 16);
    visit("lines_per_revolution", in.lines_per_revolution, 32);
    visit("position_revolution", in.position_revolution, 32);
    visit("position_line", in.position_line, 32);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("push", out.push);
    visit("commit", out.commit);
    visit("rollback", out.rollback);
    visit("line_valid", out.line_valid);
    visit("sequence_error", out.sequence_error);
    visit("shape_error", out.shape_error);
    visit("checksum_error", out.checksum_error);
    visit("push_data", out.push_data, 8);
    visit("first_slot", out.first_slot, 16);
    visit("revolution", out.revolution, 32);
    visit("line", out.line, 32);
  }
};

struct IncrementSchedulePorts {
  using Model = fpga::IncrementSchedule;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("flush", in.flush);
    visit("run", in.run);
    visit("push", in.push);
    visit("push_increment", in.push_increment, 32);
    visit("push_clocks", in.push_clocks, 32);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("load_increment", out.load_increment);
    visit("busy", out.busy);
    visit("full", out.full);
    visit("overflow", out.overflow);
    visit("increment", out.increment, 32);
  }
};

struct SynchroPorts {
  using Model = fpga::Synchro;
  static Model make() { return Model(6); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("write", in.write);
    visit("in_valid", in.in_valid);
    visit("start", in.start);
    visit("interlock", in.interlock);
    visit("address", in.address, 8);
    visit("in_data", in.in_data, 8);
    visit("write_data", in.write_data, 32);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("a", out.a);
    visit("b", out.b);
    visit("gate", out.gate);
    visit("scan", out.scan);
    visit("fault", out.fault, 3);
    visit("read_data", out.read_data, 32);
  }
};

}  // namespace gravure::cosim
