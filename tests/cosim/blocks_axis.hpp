#pragma once

#include "gravure/fpga/ab_generator.hpp"
#include "gravure/fpga/increment_schedule.hpp"

namespace gravure::cosim {

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
    visit("backward", in.backward);
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
    visit("back", out.back);
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
    visit("back", in.back);
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

struct IncrementSchedulePorts {
  using Model = fpga::IncrementSchedule;
  static Model make() { return Model(4); }
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

}  // namespace gravure::cosim
