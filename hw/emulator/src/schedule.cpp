#include "gravure/emulator/schedule.hpp"

#include "device_checks.hpp"
#include "gravure/fpga/register_map.hpp"

namespace gravure::emulator {
namespace {

std::uint64_t ticks_of(const ScheduleSegment& segment, std::int64_t ticks_per_seed) {
  return segment.seeds * static_cast<std::uint64_t>(ticks_per_seed);
}

AxisState make_state(fpga::Uint128 counts, fpga::Uint128 edges) {
  return {.edges = static_cast<std::int64_t>(edges),
          .counts_high = static_cast<std::int64_t>(counts >> 64U),
          .counts_low = static_cast<std::uint64_t>(counts)};
}

unsigned edge_shift(const fpga::AbRegisters& registers) {
  return static_cast<unsigned>(registers.bits - 2);
}

}  // namespace

Result<void> check_schedule(const std::string& field, const std::vector<ScheduleSegment>& segments,
                            const fpga::AbRegisters& registers, std::int64_t ticks_per_seed) {
  if (segments.empty()) {
    return {};
  }
  if (segments.size() > kScheduleSegments) {
    return board_refuses(field + " of " + std::to_string(segments.size()) + " segments: its list holds " +
                         std::to_string(kScheduleSegments));
  }
  for (const ScheduleSegment& segment : segments) {
    if (segment.increment > fpga::max_increment(registers)) {
      return board_refuses(field + " increment = " + std::to_string(segment.increment) + ": allowed is 0 to " +
                           std::to_string(fpga::max_increment(registers)));
    }
    if (segment.seeds < 1 || segment.seeds > fpga::largest(fpga::kScheduleSeedsRegister)) {
      return board_refuses(field + " seeds = " + std::to_string(segment.seeds) + ": allowed is 1 to " +
                           std::to_string(fpga::largest(fpga::kScheduleSeedsRegister)));
    }
    const bool stands = segment.increment == 0 && registers.fraction_num == 0;
    if (!stands && ticks_of(segment, ticks_per_seed) % registers.prescaler != 0) {
      return board_refuses(field + " seeds = " + std::to_string(segment.seeds) +
                           ": must be whole steps of the prescaler, " + std::to_string(registers.prescaler) + " ticks");
    }
  }
  return {};
}

Result<void> check_lead(const std::string& field, const std::vector<ScheduleSegment>& segments) {
  std::uint64_t seeds = 0;
  for (const ScheduleSegment& segment : segments) {
    seeds += segment.seeds;
  }
  if (seeds > fpga::largest(fpga::kFirstTickRegister)) {
    return board_refuses(field + " of " + std::to_string(seeds) + " seed clocks: first_tick counts to " +
                         std::to_string(fpga::largest(fpga::kFirstTickRegister)));
  }
  return {};
}

void AxisWalk::load(const fpga::AbRegisters& registers) noexcept {
  registers_ = registers;
  accumulator_ = since_step_ = 0;
}

void AxisWalk::run(std::uint64_t ticks) noexcept {
  const fpga::Uint128 waited = fpga::Uint128{since_step_} + ticks;
  const fpga::Uint128 steps = waited / registers_.prescaler;
  since_step_ = static_cast<std::uint64_t>(waited % registers_.prescaler);
  const fpga::Uint128 gathered = accumulator_ + steps * registers_.fraction_num;
  counts_ += steps * registers_.increment + gathered / registers_.fraction_den;
  accumulator_ = static_cast<std::uint64_t>(gathered % registers_.fraction_den);
}

AxisState AxisWalk::state() const noexcept {
  return make_state(counts_, counts_ >> edge_shift(registers_));
}

ScheduleEnd run_schedule(const std::vector<ScheduleSegment>& segments, const fpga::AbRegisters& registers,
                         std::int64_t ticks_per_seed, const ScheduleEnd& from) noexcept {
  AxisWalk walk(registers, from.counts, from.accumulator);
  for (const ScheduleSegment& segment : segments) {
    walk.set_increment(segment.increment);  // the fraction runs on through all of them
    walk.run(ticks_of(segment, ticks_per_seed));
  }
  return {.counts = walk.counts(), .accumulator = walk.accumulator()};
}

ScheduleEnd mark(const ScheduleEnd& from, const fpga::AbRegisters& registers, std::int64_t ticks) noexcept {
  const fpga::AbPosition position = fpga::position_after(registers, static_cast<std::uint64_t>(ticks));
  const fpga::Uint128 gathered = fpga::Uint128{position.accumulator} + from.accumulator;
  const bool carry = gathered >= registers.fraction_den;
  return {.counts = from.counts + position.counts + (carry ? 1U : 0U),
          .accumulator = static_cast<std::uint64_t>(gathered - (carry ? registers.fraction_den : 0U))};
}

AxisState state_of(const ScheduleEnd& end, const fpga::AbRegisters& registers) noexcept {
  return make_state(end.counts, end.counts >> edge_shift(registers));
}

AxisState mirrored(const AxisState& state) noexcept {
  return {.edges = -state.edges,
          .counts_high = static_cast<std::int64_t>(~static_cast<std::uint64_t>(state.counts_high) +
                                                   (state.counts_low == 0 ? 1U : 0U)),
          .counts_low = ~state.counts_low + 1U};
}

AxisState axis_after(const ScheduleEnd& end, const fpga::AbRegisters& registers, std::int64_t tick) noexcept {
  const fpga::Uint128 counts = mark(end, registers, tick).counts - end.counts;
  const fpga::Uint128 begun = end.counts & ((fpga::Uint128{1} << edge_shift(registers)) - 1U);
  return make_state(counts, (begun + counts) >> edge_shift(registers));
}

}  // namespace gravure::emulator
