#pragma once

#include <cstdint>
#include <deque>

#include "gravure/emulator/schedule.hpp"

namespace gravure::emulator {

/// One A-B channel of a board with the schedule of its increments, in closed form. The registers' way to the pins,
/// always the same few clocks, is left out.
class BoardAxis {
 public:
  /// `with_fraction`: the channel has the second accumulator.
  explicit BoardAxis(bool with_fraction) noexcept : with_fraction_(with_fraction) {}

  /// Refused where a value breaks a rule; the channel then goes on as before.
  void load(const fpga::AbRegisters& registers) noexcept;
  void load_increment(std::uint64_t increment) noexcept;
  void append(const ScheduleSegment& segment);
  void go() noexcept { runs_ = true; }
  void empty() noexcept;
  /// FPGA ticks with the channel enabled or held, `ticks_per_seed` a seed clock.
  void run(std::uint64_t ticks, bool enabled, std::uint64_t ticks_per_seed) noexcept;

  AxisState state() const noexcept { return walk_.state(); }
  bool refused() const noexcept { return refused_; }
  bool busy() const noexcept { return left_ != 0 || (runs_ && !segments_.empty()); }
  bool has_segments() const noexcept { return left_ != 0 || !segments_.empty(); }
  bool overflow() const noexcept { return overflow_; }

 private:
  bool with_fraction_;
  AxisWalk walk_;
  std::deque<ScheduleSegment> segments_;
  std::uint64_t left_ = 0;  ///< ticks of the segment that runs
  bool runs_ = false;
  bool refused_ = false;
  bool overflow_ = false;  ///< until empty()
};

}  // namespace gravure::emulator
