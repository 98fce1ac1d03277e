#include "device_checks.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "gravure/core/plan.hpp"
#include "gravure/emulator/emulated_device.hpp"
#include "gravure/fpga/register_map.hpp"

namespace gravure::emulator {
namespace {

constexpr std::int64_t kMaxTick = std::numeric_limits<std::int64_t>::max();

constexpr std::int64_t most_of(const fpga::Register& one) {
  return static_cast<std::int64_t>(fpga::largest(one));
}

static_assert(kMostSeedsPerSlot == most_of(fpga::kSeedsPerSlotRegister));
static_assert(kMostClockMultiplier == fpga::kClockMultiplierRange.high);
static_assert(kMostSlotsPerLine == most_of(fpga::kSlotsPerLineRegister));

/// Collects one line for each refused field.
class Refusals {
 public:
  void add(std::string_view field, const std::string& value, std::string_view allowed, std::string_view remedy = {}) {
    text_ += text_.empty() ? "" : "\n";
    text_.append("the board refuses ")
        .append(field)
        .append(" = ")
        .append(value)
        .append(": allowed is ")
        .append(allowed);
    if (!remedy.empty()) {
      text_.append("; ").append(remedy);
    }
  }
  void range(std::string_view field, std::int64_t value, std::int64_t low, std::int64_t high) {
    if (value < low || value > high) {
      add(field, std::to_string(value), std::to_string(low) + " to " + std::to_string(high));
    }
  }
  /// A value of 1 or more in a register; false where it is refused.
  bool word(std::string_view field, std::uint64_t value, const fpga::Register& one, std::string_view remedy = {}) {
    const bool fits = value >= 1 && value <= fpga::largest(one);
    if (!fits) {
      add(field, std::to_string(value), "1 to " + std::to_string(fpga::largest(one)), remedy);
    }
    return fits;
  }
  bool empty() const { return text_.empty(); }
  Result<void> result() const { return text_.empty() ? Result<void>() : Error{ErrorCode::device, text_}; }

 private:
  std::string text_;
};

/// `prefix` is that of the fields of a channel; `registers` are its values.
void check_counter(const std::string& prefix, const fpga::AbRegisters& registers, Refusals& refusals) {
  refusals.word(prefix + "prescaler", registers.prescaler, fpga::kPrescalerRegister);
  const bool has_den = refusals.word(prefix + "fraction_den", registers.fraction_den, fpga::kFractionDenRegister,
                                     "0/1 turns the fraction off");
  if (has_den && registers.fraction_num >= registers.fraction_den) {
    refusals.add(prefix + "fraction_num", std::to_string(registers.fraction_num),
                 "0 to " + std::to_string(registers.fraction_den - 1), "put whole counts into the increment");
  }
  if (refusals.empty() && fpga::check(registers) != fpga::AbRefusal::none) {
    refusals.add(prefix + "increment", std::to_string(registers.increment),
                 "0 to " + std::to_string(fpga::max_increment(registers)),
                 "more would move A and B together: lower the prescaler or the axis speed");
  }
}

void check_counters(const DeviceSetup& setup, Refusals& refusals) {
  refusals.range("counter_bits", setup.counter_bits, fpga::kCounterBitsRange.low, fpga::kCounterBitsRange.high);
  check_counter("", ab_registers_of(setup), refusals);
  check_counter("carriage.", carriage_registers_of(setup), refusals);
  if (setup.carriage.fraction_num != 0) {
    refusals.add("carriage.fraction_num", std::to_string(setup.carriage.fraction_num), "0",
                 "the second axis has no fraction: plan the job again");
  }
}

/// A slot lasts whole seed pulses.
void check_slot(const DeviceSetup& setup, Refusals& refusals) {
  const std::int64_t multiplier = setup.clock_multiplier;
  refusals.range("clock_multiplier", multiplier, fpga::kClockMultiplierRange.low, fpga::kClockMultiplierRange.high);
  if (multiplier >= 1 && setup.ticks_per_slot % multiplier != 0) {
    refusals.add("ticks_per_slot", std::to_string(setup.ticks_per_slot),
                 "multiples of clock_multiplier = " + std::to_string(multiplier));
  } else if (multiplier >= 1) {
    refusals.range("seeds_per_slot", setup.ticks_per_slot / multiplier, 1, most_of(fpga::kSeedsPerSlotRegister));
  }
}

void check_line(const DeviceSetup& setup, Refusals& refusals) {
  check_slot(setup, refusals);
  refusals.range("slots_per_line", setup.slots_per_line, 1, most_of(fpga::kSlotsPerLineRegister));
  if (setup.window_slots > setup.slots_per_line && setup.slots_per_line >= 1) {
    refusals.add("window_slots", std::to_string(setup.window_slots), "0 to " + std::to_string(setup.slots_per_line),
                 "the window must lie inside the line");
  } else {
    refusals.range("window_slots", setup.window_slots, 0, kMaxWindowSlots);
  }
}

void check_job(const DeviceSetup& setup, Refusals& refusals) {
  refusals.range("lines_per_revolution", setup.lines_per_revolution, 1, most_of(fpga::kLinesPerRevolutionRegister));
  if (setup.lines_per_revolution >= 1) {
    refusals.range("first_line", setup.first_line, 0, setup.lines_per_revolution - 1);
  }
  refusals.range("end_revolution", setup.end_revolution, 1, most_of(fpga::kPositionRevolutionRegister) + 1);
  if (setup.end_revolution >= 1) {
    refusals.range("begin_revolution", setup.begin_revolution, 0, setup.end_revolution - 1);
  }
  if (setup.begin_revolution < setup.end_revolution) {
    refusals.range("first_revolution", setup.first_revolution, setup.begin_revolution, setup.end_revolution - 1);
  }
  if (!refusals.empty()) {
    return;
  }
  std::int64_t ticks = setup.end_revolution;
  for (const std::int64_t factor : {setup.lines_per_revolution, setup.slots_per_line, setup.ticks_per_slot}) {
    if (__builtin_mul_overflow(ticks, factor, &ticks)) {
      refusals.add("end_revolution", std::to_string(setup.end_revolution),
                   "what keeps end_revolution * lines_per_revolution * slots_per_line * ticks_per_slot at most " +
                       std::to_string(kMaxTick) + " ticks",
                   "split the job");
      return;
    }
  }
}

}  // namespace

Error board_refuses(const std::string& what) {
  return {ErrorCode::device, "the board refuses " + what};
}

fpga::AbRegisters ab_registers_of(const DeviceSetup& setup) noexcept {
  return {.bits = setup.counter_bits,
          .prescaler = setup.prescaler,
          .increment = setup.increment,
          .fraction_num = setup.fraction_num,
          .fraction_den = setup.fraction_den};
}

fpga::AbRegisters carriage_registers_of(const DeviceSetup& setup) noexcept {
  return {.bits = setup.counter_bits,
          .prescaler = setup.carriage.prescaler,
          .increment = setup.carriage.increment,
          .fraction_num = setup.carriage.fraction_num,
          .fraction_den = setup.carriage.fraction_den};
}

Result<void> check_setup(const DeviceSetup& setup) {
  Refusals refusals;
  check_counters(setup, refusals);
  check_line(setup, refusals);
  check_job(setup, refusals);
  return refusals.result();
}

}  // namespace gravure::emulator
