#pragma once

#include "gravure/fpga/crc32c.hpp"
#include "gravure/fpga/descriptor_rom.hpp"
#include "gravure/fpga/fault_latch.hpp"
#include "gravure/fpga/frame_parser.hpp"
#include "gravure/fpga/line_fifo.hpp"
#include "gravure/fpga/settings.hpp"
#include "gravure/fpga/synchro.hpp"
#include "gravure/fpga/watchdog.hpp"

namespace gravure::cosim {

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
    visit("slots_per_line", in.slots_per_line, 24);
    visit("window_slots", in.window_slots, 24);
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
    visit("first_slot", out.first_slot, 24);
    visit("odd", out.odd);
    visit("revolution", out.revolution, 32);
    visit("line", out.line, 32);
  }
};

struct SettingsPorts {
  using Model = fpga::Settings;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("clear", in.clear);
    visit("write", in.write);
    visit("address", in.address, 8);
    visit("write_data", in.write_data, 32);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("control", out.control, 9);
    visit("command", out.command, 10);
    visit("increment", out.increment, 32);
    visit("prescaler", out.prescaler, 32);
    visit("fraction_num", out.fraction_num, 34);
    visit("fraction_den", out.fraction_den, 34);
    visit("increment_1", out.increment_1, 32);
    visit("prescaler_1", out.prescaler_1, 32);
    visit("fraction_num_1", out.fraction_num_1, 34);
    visit("fraction_den_1", out.fraction_den_1, 34);
    visit("seeds_per_slot", out.seeds_per_slot, 16);
    visit("slots_per_line", out.slots_per_line, 24);
    visit("window_slots", out.window_slots, 24);
    visit("slots_per_microvector", out.slots_per_microvector, 24);
    visit("lines_per_revolution", out.lines_per_revolution, 32);
    visit("position_revolution", out.position_revolution, 32);
    visit("position_line", out.position_line, 32);
    visit("silence_limit", out.silence_limit, 32);
    visit("first_tick", out.first_tick, 32);
    visit("reverse_delay", out.reverse_delay, 16);
    visit("low_level", out.low_level, 16);
    visit("correction_limit", out.correction_limit, 8);
    visit("index_window", out.index_window, 16);
    visit("revolution_seeds", out.revolution_seeds, 48);
    visit("schedule_increment", out.schedule_increment, 32);
    visit("schedule_seeds", out.schedule_seeds, 32);
    visit("store", out.store);
    visit("store_address", out.store_address, 8);
    visit("store_data", out.store_data, 32);
    visit("refused", out.refused);
  }
};

struct DescriptorRomPorts {
  using Model = fpga::DescriptorRom;
  static Model make() { return Model(); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("number", in.number, 6);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("word", out.word, 32);
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
    visit("seen", out.seen, 6);
    visit("any", out.any);
  }
};

struct SynchroPorts {
  using Model = fpga::Synchro;
  static Model make() { return Model(6, 4); }
  template <class In, class Visitor>
  static void in(In& in, Visitor&& visit) {
    visit("rst", in.rst);
    visit("write", in.write);
    visit("in_valid", in.in_valid);
    visit("start", in.start);
    visit("index", in.index);
    visit("interlock", in.interlock);
    visit("address", in.address, 8);
    visit("in_data", in.in_data, 8);
    visit("write_data", in.write_data, 32);
  }
  template <class Out, class Visitor>
  static void out(Out& out, Visitor&& visit) {
    visit("a", out.a);
    visit("b", out.b);
    visit("a_1", out.a_1);
    visit("b_1", out.b_1);
    visit("gate", out.gate);
    visit("scan", out.scan);
    visit("fault", out.fault, 3);
    visit("read_data", out.read_data, 32);
  }
};

}  // namespace gravure::cosim
