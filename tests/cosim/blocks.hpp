#pragma once

#include "gravure/fpga/ab_generator.hpp"

namespace gravure::cosim {

/// For every block: its model, and its ports in order. The visitor takes (name, member, width); the same list serves
/// the model's structs and the members of the class that Verilator makes.

template <int kBits, int kPrescalerBits, int kFractionBits>
struct AbGeneratorPorts {
  using Model = fpga::AbGenerator;
  static Model make() {
    return Model({.bits = kBits, .prescaler_bits = kPrescalerBits, .fraction_bits = kFractionBits});
  }
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
    visit("a", out.a);
    visit("b", out.b);
    visit("refused", out.refused);
    visit("count", out.count, kBits);
  }
};

}  // namespace gravure::cosim
