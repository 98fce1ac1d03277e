#include "gravure/protocol/start_sequence.hpp"

#include <algorithm>
#include <string>

#include "gravure/fpga/register_map.hpp"

namespace gravure::protocol {
namespace {

Error refusal(const std::string& what) {
  return {ErrorCode::device, "the board refuses " + what};
}

/// A list of writes; the first value that does not fit its register is kept.
class Writes {
 public:
  void put(const fpga::Register& target, std::uint64_t value) {
    const bool not_zero = std::find(fpga::kNotZeroAddresses.begin(), fpga::kNotZeroAddresses.end(), target.address) !=
                          fpga::kNotZeroAddresses.end();
    const std::uint64_t least = not_zero ? 1 : 0;
    if ((value < least || value > fpga::largest(target)) && refused_) {
      refused_ = refusal(std::string(target.name) + " = " + std::to_string(value) + ": allowed is " +
                         std::to_string(least) + " to " + std::to_string(fpga::largest(target)));
    }
    for (int word = 0; word < (target.bits > 32 ? 2 : 1); ++word) {
      list_.push_back({static_cast<std::uint8_t>(target.address + word),
                       static_cast<std::uint32_t>(value >> static_cast<unsigned>(32 * word))});
    }
  }
  void command(std::uint32_t bits) { put(fpga::kCommandRegister, bits); }
  Result<void> refused() const { return refused_; }
  std::vector<RegisterWrite> take() { return std::move(list_); }

 private:
  std::vector<RegisterWrite> list_;
  Result<void> refused_;
};

std::uint64_t seeds_of(const std::vector<ScheduleSegment>& segments) {
  std::uint64_t seeds = 0;
  for (const ScheduleSegment& segment : segments) {
    seeds += std::min(segment.seeds, fpga::largest(fpga::kScheduleSeedsRegister));
  }
  return seeds;
}

void put_axes(Writes& writes, const DeviceSetup& setup, bool marking) {
  writes.put(fpga::kIncrementRegister, marking ? setup.increment : 0);
  writes.put(fpga::kPrescalerRegister, setup.prescaler);
  writes.put(fpga::kFractionNumRegister, setup.fraction_num);
  writes.put(fpga::kFractionDenRegister, setup.fraction_den);
  writes.put(fpga::kIncrement1Register, marking ? setup.carriage.increment : 0);
  writes.put(fpga::kPrescaler1Register, setup.carriage.prescaler);
  writes.put(fpga::kFractionNum1Register, setup.carriage.fraction_num);
  writes.put(fpga::kFractionDen1Register, setup.carriage.fraction_den);
}

/// Both axes stand though they are enabled: a load keeps the counter, and an increment of 0 does not move it.
void put_rest(Writes& writes) {
  put_axes(writes, DeviceSetup{}, false);
  writes.command(kCommandLoad0 | kCommandLoad1);
}

void append_segment(Writes& writes, std::uint32_t command, const ScheduleSegment& segment) {
  writes.put(fpga::kScheduleIncrementRegister, segment.increment);
  writes.put(fpga::kScheduleSeedsRegister, segment.seeds);
  writes.command(command);
}

/// A channel at rest for `wait` seed clocks, then its ramp, then its marking speed for `marking_seeds`, and its ramp to
/// rest; without that ramp the marking speed for ever.
using Schedule = std::vector<ScheduleSegment>;
Schedule schedule_of(std::uint64_t wait, const Schedule& up, std::uint64_t increment, std::uint64_t marking_seeds,
                     const Schedule* down) {
  Schedule schedule{{0, kStartLead}};  // comes during the load, where it is refused
  if (wait != 0) {
    schedule.push_back({0, wait});
  }
  schedule.insert(schedule.end(), up.begin(), up.end());
  if (down == nullptr) {
    schedule.push_back({increment, 1});
    return schedule;
  }
  const std::uint64_t most = fpga::largest(fpga::kScheduleSeedsRegister);
  for (std::uint64_t left = marking_seeds; left != 0 && schedule.size() <= kMostSegments;
       left -= std::min(left, most)) {
    schedule.push_back({increment, std::min(left, most)});
  }
  schedule.insert(schedule.end(), down->begin(), down->end());
  schedule.push_back({0, 1});
  return schedule;
}

Result<void> append_schedule(Writes& writes, std::uint32_t command, const Schedule& schedule) {
  if (schedule.size() > kMostSegments) {
    return refusal("a schedule of " + std::to_string(schedule.size()) + " segments: its list holds " +
                   std::to_string(kMostSegments));
  }
  for (const ScheduleSegment& segment : schedule) {
    append_segment(writes, command, segment);
  }
  return {};
}

struct Schedules {
  Schedule axis;
  Schedule carriage;
  bool ends_at_rest = false;
};

/// Both channels end their ramps at one moment. Where both come to rest only if both lists have room for it.
Schedules schedules_of(const DeviceSetup& setup, const LineTiming& timing, std::uint64_t line_seeds) {
  const std::uint64_t ramp_0 = seeds_of(setup.spin_up);
  const std::uint64_t ramp_1 = seeds_of(setup.carriage.spin_up);
  const std::uint64_t ramp = std::max(ramp_0, ramp_1);
  const bool stops = timing.stop_at_end || !setup.spin_down.empty() || !setup.carriage.spin_down.empty();
  if (ramp == 0 && !stops) {
    return {};
  }
  const std::uint64_t wait = timing.lead_seeds - kStartLead + ramp;
  const std::int64_t lines =
      (setup.end_revolution - setup.first_revolution) * setup.lines_per_revolution - setup.first_line;
  const std::uint64_t marking = (timing.lines_before + static_cast<std::uint64_t>(lines)) * line_seeds;
  const auto with = [&](bool to_rest) {
    Schedules both;
    both.axis =
        schedule_of(wait - ramp_0, setup.spin_up, setup.increment, marking, to_rest ? &setup.spin_down : nullptr);
    if (setup.carriage.increment != 0) {
      both.carriage = schedule_of(wait - ramp_1, setup.carriage.spin_up, setup.carriage.increment, marking,
                                  to_rest ? &setup.carriage.spin_down : nullptr);
    }
    both.ends_at_rest = to_rest;
    return both;
  };
  Schedules both = with(stops);
  const bool fit = both.axis.size() <= kMostSegments && both.carriage.size() <= kMostSegments;
  return fit ? both : with(false);
}

void put_lines(Writes& writes, const DeviceSetup& setup, const LineTiming& timing, std::uint64_t delay_seeds) {
  const auto put = [&writes](const fpga::Register& target, std::int64_t value) {
    writes.put(target, static_cast<std::uint64_t>(value));
  };
  put(fpga::kSeedsPerSlotRegister, setup.ticks_per_slot / setup.clock_multiplier);
  put(fpga::kSlotsPerLineRegister, setup.slots_per_line);
  put(fpga::kWindowSlotsRegister, setup.window_slots);
  put(fpga::kSlotsPerMicrovectorRegister, timing.slots_per_microvector);
  put(fpga::kLinesPerRevolutionRegister, setup.lines_per_revolution);
  writes.put(fpga::kReverseDelayRegister, delay_seeds);
  writes.put(fpga::kLowLevelRegister, 0);
  writes.put(fpga::kCorrectionLimitRegister, 0);
  if (timing.silence_seeds != 0) {
    writes.put(fpga::kSilenceLimitRegister, timing.silence_seeds);
  }
}

struct Delay {
  std::uint64_t seeds = 0;
  bool backward = false;  ///< control bit 5
};

/// A delay is less than a slot and never negative: to come earlier is to begin a slot earlier and wait for the rest.
Result<Delay> delay_of(const DeviceSetup& setup, const LineTiming& timing) {
  GRAVURE_CHECK(check_backward_delay(timing.backward_later_ticks, setup.clock_multiplier));
  const std::int64_t ticks = timing.backward_later_ticks + (timing.backward_later_ticks < 0 ? setup.ticks_per_slot : 0);
  return Delay{static_cast<std::uint64_t>(ticks / setup.clock_multiplier), ticks != 0};
}

Result<std::uint64_t> first_tick_of(const LineTiming& timing, std::uint64_t line_seeds, std::uint64_t ramp) {
  const std::uint64_t most = fpga::largest(fpga::kFirstTickRegister);
  const std::uint64_t wait = timing.lead_seeds + ramp;
  std::uint64_t lines = 0;
  if (__builtin_mul_overflow(timing.lines_before, line_seeds, &lines) || wait > most || lines > most - wait) {
    const std::uint64_t fit = wait > most ? 0 : (most - wait) / line_seeds;
    return Error{ErrorCode::out_of_range, "line " + std::to_string(timing.lines_before) +
                                              " of a revolution to begin with: the board counts " +
                                              std::to_string(most) + " seed clocks to the first line, lines 0 to " +
                                              std::to_string(fit) + " come within that"};
  }
  return wait + lines;
}

}  // namespace

Result<void> check_backward_delay(std::int64_t later_ticks, std::int64_t clock_multiplier) {
  if (later_ticks % clock_multiplier == 0) {
    return {};
  }
  const std::string multiplier = std::to_string(clock_multiplier);
  return refusal("a bidirectional offset that leaves " + std::to_string(later_ticks) +
                 " ticks beside whole slots: it delays by whole seed clocks of " + multiplier +
                 " ticks; make scanner.bidirectional_offset_ticks a multiple of " + multiplier);
}

Result<std::int64_t> framed_first_slot(std::int64_t first_slot, bool backward, const LineTiming& timing) {
  if (!backward || timing.backward_later_ticks >= 0) {
    return first_slot;
  }
  if (first_slot == 0) {
    return refusal("a backward line in slot 0 that should begin earlier by part of a slot");
  }
  return first_slot - 1;
}

Result<StartSequence> start_sequence(const DeviceSetup& setup, const LineTiming& timing) {
  const auto seeds_per_slot = static_cast<std::uint64_t>(setup.ticks_per_slot / setup.clock_multiplier);
  const std::uint64_t line_seeds = static_cast<std::uint64_t>(setup.slots_per_line) * seeds_per_slot;
  const std::uint64_t ramp = std::max(seeds_of(setup.spin_up), seeds_of(setup.carriage.spin_up));
  const Schedules schedules = schedules_of(setup, timing, line_seeds);
  const bool scheduled = !schedules.axis.empty();
  StartSequence sequence;
  sequence.ends_at_rest = schedules.ends_at_rest;
  GRAVURE_TRY(sequence.first_tick, first_tick_of(timing, line_seeds, ramp));
  GRAVURE_TRY(const Delay delay, delay_of(setup, timing));

  Writes settings;
  settings.put(fpga::kControlRegister, 0);
  settings.command(
      kCommandGo);  // the count to first_tick begins anew: that of an earlier start must not come to an end
  settings.command(kCommandStopSchedules | kCommandAcknowledge);
  put_axes(settings, setup, true);
  settings.command(kCommandLoad0 | kCommandLoad1);
  put_lines(settings, setup, timing, delay.seeds);
  settings.put(fpga::kFirstTickRegister, sequence.first_tick);
  GRAVURE_CHECK(settings.refused());

  Writes prepare;
  put_rest(prepare);
  prepare.put(fpga::kControlRegister, kControlAxis0 | kControlAxis1);
  put_axes(prepare, setup, !scheduled);
  GRAVURE_CHECK(append_schedule(prepare, kCommandAppend0, schedules.axis));
  GRAVURE_CHECK(append_schedule(prepare, kCommandAppend1, schedules.carriage));
  prepare.put(fpga::kPositionRevolutionRegister, static_cast<std::uint64_t>(setup.first_revolution));
  prepare.put(fpga::kPositionLineRegister, static_cast<std::uint64_t>(setup.first_line));
  prepare.put(fpga::kScheduleIncrementRegister, timing.mark);
  prepare.command(kCommandPosition);
  GRAVURE_CHECK(prepare.refused());

  const std::uint32_t watchdog = timing.silence_seeds != 0 ? kControlWatchdog : 0;
  const std::uint32_t backward = (delay.backward ? kControlBackward : 0) | (setup.backward ? kControlAxis0Backward : 0);
  Writes start;
  start.put(fpga::kControlRegister, kControlRun | kControlAxis0 | kControlAxis1 | kControlTimed | watchdog | backward);
  start.command(kCommandLoad0 | kCommandLoad1 | kCommandGo);
  sequence.settings = settings.take();
  sequence.prepare = prepare.take();
  sequence.start = start.take();
  return sequence;
}

std::vector<RegisterWrite> stop_sequence(std::span<const ScheduleSegment> axis,
                                         std::span<const ScheduleSegment> carriage) {
  Writes writes;
  if (axis.empty() && carriage.empty()) {
    writes.put(fpga::kControlRegister, 0);
    return writes.take();
  }
  writes.put(fpga::kControlRegister, kControlAxis0 | kControlAxis1);
  writes.command(kCommandStopSchedules);
  for (const auto& [segments, command] : {std::pair(axis, kCommandAppend0), std::pair(carriage, kCommandAppend1)}) {
    for (const ScheduleSegment& segment : segments) {
      append_segment(writes, command, segment);
    }
    append_segment(writes, command, {0, 1});
  }
  writes.command(kCommandGo);
  return writes.take();
}

}  // namespace gravure::protocol
