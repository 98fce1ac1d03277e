#pragma once

#include <cstdint>

#include "gravure/fpga/ab_generator.hpp"
#include "gravure/fpga/ab_registers.hpp"

namespace gravure::fpga {

/// An AbGenerator whose inputs stand still, in closed form: its edges one after another, and its whole state at any
/// later clock.
///
/// The pipelines of the generator are emptied on a copy by holding `enable` low, which leaves prescaler, fraction and
/// counter as they are at the entry ("front"). From there all is arithmetic: a step every `period` clocks, edges by the
/// recurrence of AbEdges, seen at the pins enable_latency() later. A state is made by going on at the front and filling
/// the pipelines again.
class AxisTrack {
 public:
  /// Seed clocks that empty or fill every pipeline of the generator and take a load all the way through.
  static constexpr int kDrainSeedClocks = 16;
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  /// `generator` as it is after FPGA clock `clock`, an even one, with no load for kDrainSeedClocks and `enable` held.
  AxisTrack(const AbGenerator& generator, const AbGenerator::Widths& widths, bool enable, std::uint64_t clock) noexcept;

  /// FPGA clocks from one that steps the front to the pins, without the clock itself.
  std::uint64_t latency() const noexcept { return latency_; }
  /// Clock after which the pins change next; edges up to latency() after the start may be missing. kNever: none comes.
  std::uint64_t next_clock() const noexcept { return next_clock_; }
  /// What the pins show from then on; goes on to the edge after it.
  AbPins take() noexcept;
  /// The generator after `clock`, by an even number of clocks and at least 2 kDrainSeedClocks later than the start.
  AbGenerator at(std::uint64_t clock) const noexcept;

 private:
  void advance(Uint128 steps) noexcept;
  std::uint64_t turned(std::uint64_t turn, std::uint64_t quarters) const noexcept {
    return back_ ? turn - quarters : turn + quarters;
  }

  AbGenerator front_;
  bool enable_;
  std::uint64_t clock_;
  std::uint64_t latency_;
  std::uint64_t count_ = 0;
  std::uint64_t accumulator_ = 0;
  std::uint64_t den_ = 1;

  std::uint64_t next_clock_ = kNever;
  std::uint64_t quarter_ = 0;  ///< of the counter at the start
  std::uint64_t turn_ = 0;     ///< of the pins, modulo 4
  bool back_ = false;
  Uint128 per_step_ = 0;  ///< P, in counts * den
  Uint128 per_edge_ = 0;  ///< Q
  Uint128 over_ = 0;      ///< by how much the pending edge's step goes past it, < P
  Uint128 gap_ = 0;       ///< Q / P
  Uint128 rest_ = 0;      ///< Q mod P
};

}  // namespace gravure::fpga
