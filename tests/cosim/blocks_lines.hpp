#pragma once

#include "gravure/fpga/direction_delay.hpp"
#include "gravure/fpga/index_reference.hpp"
#include "gravure/fpga/line_progress.hpp"
#include "gravure/fpga/line_sequencer.hpp"
#include "gravure/fpga/line_start.hpp"
#include "gravure/fpga/scanner_clock.hpp"
#include "gravure/fpga/slot_divider.hpp"
#include "gravure/fpga/slot_gate.hpp"

namespace gravure::cosim {

struct LineStartPorts {
  using Model = fpga::LineStart;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("run", in.run);
    visit("timed", in.timed);
    visit("strobe", in.strobe);
    visit("go", in.go);
    visit("first_tick", in.first_tick, 32);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("slots_run", out.slots_run);
    visit("started", out.started);
  }
};

struct SlotDividerPorts {
  using Model = fpga::SlotDivider;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("run", in.run);
    visit("seeds_per_slot", in.seeds_per_slot, 16);
    visit("adjust", in.adjust);
    visit("amount", in.amount, 9);
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
    visit("slots_per_line", in.slots_per_line, 24);
    visit("first_slot", in.first_slot, 24);
    visit("window_slots", in.window_slots, 24);
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

struct DirectionDelayPorts {
  using Model = fpga::DirectionDelay;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("delay", in.delay, 16);
    visit("reverse", in.reverse);
    visit("slot_in", in.slot_in);
    visit("decision_in", in.decision_in);
    visit("window_in", in.window_in);
    visit("first_in", in.first_in);
    visit("last_in", in.last_in);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("slot", out.slot);
    visit("decision", out.decision);
    visit("window", out.window);
    visit("first", out.first);
    visit("last", out.last);
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
    visit("passed", out.passed);
    visit("open", out.open);
  }
};

struct LineProgressPorts {
  using Model = fpga::LineProgress;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("clear", in.clear);
    visit("load", in.load);
    visit("run", in.run);
    visit("begins", in.begins);
    visit("queued", in.queued);
    visit("slot", in.slot);
    visit("passed", in.passed);
    visit("open", in.open);
    visit("dark", in.dark);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("executed", out.executed, 32);
    visit("slots", out.slots, 24);
    visit("partial", out.partial);
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
    visit("slots_per_microvector", in.slots_per_microvector, 24);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("scan", out.scan);
  }
};

struct IndexReferencePorts {
  using Model = fpga::IndexReference;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("clear", in.clear);
    visit("enable", in.enable);
    visit("index", in.index);
    visit("line_end", in.line_end);
    visit("revolution", in.revolution, 48);
    visit("window", in.window, 16);
    visit("limit", in.limit, 8);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("adjust", out.adjust);
    visit("amount", out.amount, 9);
    visit("error", out.error, 18);
    visit("referenced", out.referenced);
    visit("lost", out.lost);
  }
};

}  // namespace gravure::cosim
