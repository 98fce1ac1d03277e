#pragma once

#include "gravure/fpga/ab_accumulator.hpp"
#include "gravure/fpga/ab_pacer.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/ab_generator.v: one step() is one rising edge of the FPGA clock. The first step and
/// every second after it are edges of the seed clock too; inputs are looked at then only.
///
/// AbCounter is what this block does after one load; here are the load port, the checks and the registers on the way.
class AbGenerator {
 public:
  static constexpr int kClockMultiplier = 2;  ///< FPGA clocks a seed clock

  using Widths = AbPacer::Widths;
  using Inputs = AbPacer::Inputs;
  struct Outputs {
    bool a = false;
    bool b = false;
    bool refused = false;  ///< the last load would have broken a rule and changed nothing
    bool busy = false;     ///< a load is under way, another would be refused
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  /// Clocks from the one that takes a load, without the clock itself: AbCounter's pins after its clock c show just
  /// after load_latency() + c more.
  static constexpr int load_latency(const Widths& widths) noexcept {
    return kClockMultiplier * AbPacer::kLoadClocks + AbAccumulator::word_latency(widths) - 1;
  }
  /// Clocks until `enable` shows on the pins.
  static constexpr int enable_latency(const Widths& widths) noexcept {
    return kClockMultiplier * AbPacer::kDueLatency + AbAccumulator::word_latency(widths);
  }
  /// Clocks until a new increment does.
  static constexpr int increment_latency(const Widths& widths) noexcept {
    return kClockMultiplier * AbPacer::kStepLatency + AbAccumulator::word_latency(widths);
  }

  explicit AbGenerator(const Widths& widths) noexcept : pacer_(widths), accumulator_(widths) {}

  Outputs step(const Inputs& inputs) noexcept {
    const AbPins pins = accumulator_.step({.clear = clear_,
                                           .beat = beat_,
                                           .due = word_.due,
                                           .carry = word_.carry,
                                           .step = word_.step,
                                           .back = word_.back});
    if (seed_edge_) {
      beat_ = !inputs.rst && !beat_;
      clear_ = inputs.rst;
      word_ = pacer_.step(inputs);
    }
    seed_edge_ = !seed_edge_;
    return {.a = pins.a, .b = pins.b, .refused = word_.refused, .busy = word_.busy};
  }

 private:
  friend class AxisTrack;

  AbPacer pacer_;
  AbAccumulator accumulator_;
  AbPacer::Outputs word_;
  bool seed_edge_ = true;
  bool beat_ = false;
  bool clear_ = false;
};

}  // namespace gravure::fpga
