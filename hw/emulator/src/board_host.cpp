#include "gravure/emulator/board_host.hpp"

#include <array>
#include <string>

#include "device_checks.hpp"
#include "gravure/core/crc32c.hpp"
#include "gravure/fpga/frame_parser.hpp"
#include "gravure/fpga/register_map.hpp"

namespace gravure::emulator {
namespace {

using fpga::AbGenerator;

constexpr std::uint64_t kSeedClock = AbGenerator::kClockMultiplier;
constexpr std::uint64_t kFrameOverhead = fpga::FrameParser::kFrameBytes;
/// Seed clocks from `go` to tick 0 of the first line: room for two frames and more.
constexpr std::uint64_t kLead = 64;

/// What every board refuses, and what this one does: its clocks and counters.
Result<void> check_board(const DeviceSetup& setup) {
  if (setup.clock_multiplier != AbGenerator::kClockMultiplier) {
    const std::string own = std::to_string(AbGenerator::kClockMultiplier);
    return board_refuses("clock_multiplier = " + std::to_string(setup.clock_multiplier) + ": it has " + own +
                         " FPGA clocks a seed clock; set fpga.clock_multiplier = " + own);
  }
  if (setup.counter_bits != fpga::Synchro::kAxisWidths.bits) {
    return board_refuses("counter_bits = " + std::to_string(setup.counter_bits) + ": its counters have " +
                         std::to_string(fpga::Synchro::kAxisWidths.bits));
  }
  return check_setup(setup);
}

}  // namespace

Result<void> check_backward_delay(std::int64_t later_ticks, std::int64_t clock_multiplier) {
  if (later_ticks % clock_multiplier == 0) {
    return {};
  }
  return board_refuses(
      "a bidirectional offset that leaves " + std::to_string(later_ticks) +
      " ticks beside whole slots: it delays by whole seed clocks of " + std::to_string(clock_multiplier) +
      " ticks; make scanner.bidirectional_offset_ticks a multiple of " + std::to_string(clock_multiplier));
}

Result<void> BoardHost::write(const fpga::Register& target, std::uint64_t value) {
  if (value > fpga::largest(target)) {
    return board_refuses(std::string(target.name) + " = " + std::to_string(value) + ": allowed is 0 to " +
                         std::to_string(fpga::largest(target)));
  }
  for (int word = 0; word < (target.bits > 32 ? 2 : 1); ++word) {
    fpga::Synchro::Inputs in;
    in.write = true;
    in.address = static_cast<std::uint8_t>(target.address + word);
    in.write_data = static_cast<std::uint32_t>(value >> static_cast<unsigned>(32 * word));
    GRAVURE_CHECK(wires_(in, kSeedClock));
    ++now_;
  }
  return {};
}

Result<void> BoardHost::write_axis(const DeviceSetup& setup) {
  GRAVURE_CHECK(write(fpga::kIncrementRegister, setup.increment));
  GRAVURE_CHECK(write(fpga::kPrescalerRegister, setup.prescaler));
  GRAVURE_CHECK(write(fpga::kFractionNumRegister, setup.fraction_num));
  GRAVURE_CHECK(write(fpga::kFractionDenRegister, setup.fraction_den));
  GRAVURE_CHECK(write(fpga::kIncrement1Register, setup.carriage.increment));
  return write(fpga::kPrescaler1Register, setup.carriage.prescaler);
}

Result<void> BoardHost::start_axis(const DeviceSetup& setup) {
  GRAVURE_CHECK(check_board(setup));
  constexpr std::uint64_t kEnable = 2U | 8U;
  constexpr std::uint64_t kLoad = 2U | 16U;
  fpga::Synchro::Inputs reset;
  reset.rst = true;
  GRAVURE_CHECK(wires_(reset, 4 * kSeedClock));
  GRAVURE_CHECK(write_axis(setup));
  GRAVURE_CHECK(write(fpga::kControlRegister, kEnable));
  return write(fpga::kCommandRegister, kLoad);
}

/// A delay is less than a slot and never negative: to come earlier is to begin a slot earlier and wait for the rest.
Result<void> BoardHost::write_delay(const DeviceSetup& setup, std::int64_t later_ticks) {
  constexpr auto kTicks = static_cast<std::int64_t>(kSeedClock);
  GRAVURE_CHECK(check_backward_delay(later_ticks, kTicks));
  backward_one_earlier_ = later_ticks < 0;
  const std::int64_t delay = later_ticks + (backward_one_earlier_ ? setup.ticks_per_slot : 0);
  if (delay != 0) {
    constexpr std::uint64_t kBackward = 32;
    control_ |= kBackward;
  }
  return write(fpga::kReverseDelayRegister, static_cast<std::uint64_t>(delay / kTicks));
}

bool BoardHost::is_backward(const LineFrame& frame) const {
  return ((frame.revolution * lines_per_revolution_ + frame.line) & 1) != 0;
}

Result<void> BoardHost::start_lines(const DeviceSetup& setup, const Lines& lines) {
  GRAVURE_CHECK(check_board(setup));
  if (!setup.spin_up.empty() || !setup.carriage.spin_up.empty()) {
    return Error{ErrorCode::bad_argument,
                 "the lines of a job whose axes are spun up from rest: this host starts its counters with line 0"};
  }
  control_ = 1U | 2U | 8U | 16U;  // run slots, enable both axes, lines begin at the tick
  lines_per_revolution_ = setup.lines_per_revolution;
  constexpr std::uint64_t kAcknowledge = 1;
  constexpr std::uint64_t kPositionAndGo = 8U | 64U;
  const auto bytes = static_cast<std::uint64_t>((setup.window_slots + 7) / 8);
  const auto seeds_per_slot = static_cast<std::uint64_t>(setup.ticks_per_slot) / kSeedClock;
  line_seeds_ = static_cast<std::uint64_t>(setup.slots_per_line) * seeds_per_slot;
  if (2 * bytes > std::uint64_t{1} << static_cast<unsigned>(fifo_bits_)) {
    return board_refuses("window_slots = " + std::to_string(setup.window_slots) +
                         ": two lines must fit into its FIFO of " +
                         std::to_string(std::uint64_t{1} << static_cast<unsigned>(fifo_bits_)) + " bytes");
  }
  if (bytes + kFrameOverhead + kLead > line_seeds_) {
    return board_refuses("lines of " + std::to_string(line_seeds_) + " seed clocks: a frame of " +
                         std::to_string(bytes + kFrameOverhead) + " bytes takes longer");
  }
  GRAVURE_CHECK(start_axis(setup));
  GRAVURE_CHECK(write(fpga::kSeedsPerSlotRegister, seeds_per_slot));
  GRAVURE_CHECK(write(fpga::kSlotsPerLineRegister, static_cast<std::uint64_t>(setup.slots_per_line)));
  GRAVURE_CHECK(write(fpga::kWindowSlotsRegister, static_cast<std::uint64_t>(setup.window_slots)));
  GRAVURE_CHECK(write(fpga::kSlotsPerMicrovectorRegister, static_cast<std::uint64_t>(lines.slots_per_microvector)));
  GRAVURE_CHECK(write_delay(setup, lines.backward_later_ticks));
  GRAVURE_CHECK(write(fpga::kLinesPerRevolutionRegister, static_cast<std::uint64_t>(setup.lines_per_revolution)));
  GRAVURE_CHECK(write(fpga::kPositionRevolutionRegister, static_cast<std::uint64_t>(setup.first_revolution)));
  GRAVURE_CHECK(write(fpga::kPositionLineRegister, static_cast<std::uint64_t>(setup.first_line)));
  const std::uint64_t lead = kLead + bytes + kFrameOverhead;
  GRAVURE_CHECK(write(fpga::kFirstTickRegister, lead));
  GRAVURE_CHECK(write(fpga::kCommandRegister, kAcknowledge));
  GRAVURE_CHECK(wait(kLead * kSeedClock));
  GRAVURE_CHECK(write(fpga::kControlRegister, control_));
  GRAVURE_CHECK(write(fpga::kCommandRegister, kPositionAndGo));
  now_ = 0;
  first_line_ = lead;
  sent_ = 0;
  return {};
}

Result<void> BoardHost::wait_until(std::uint64_t seed_clock) {
  if (seed_clock > now_) {
    GRAVURE_CHECK(wait((seed_clock - now_) * kSeedClock));
    now_ = seed_clock;
  }
  return {};
}

Result<void> BoardHost::byte(std::uint8_t data) {
  fpga::Synchro::Inputs in;
  in.in_valid = true;
  in.in_data = data;
  ++now_;
  return wires_(in, kSeedClock);
}

Result<void> BoardHost::bytes(std::span<const std::byte> data) {
  for (const std::byte each : data) {
    GRAVURE_CHECK(byte(std::to_integer<std::uint8_t>(each)));
  }
  return {};
}

Result<void> BoardHost::send(const LineFrame& frame) {
  if (sent_ > 0) {
    GRAVURE_CHECK(wait_until(first_line_ + (sent_ - 1) * line_seeds_ + kLead / 2));
  }
  ++sent_;
  if (!backward_one_earlier_ || !is_backward(frame)) {
    return put(frame);
  }
  if (frame.first_slot == 0) {
    return board_refuses("a backward line in slot 0 that should begin earlier by part of a slot");
  }
  LineFrame earlier = frame;
  --earlier.first_slot;
  earlier.crc32c = frame_crc32c(earlier);
  return put(earlier);
}

/// As fpga::FrameParser takes it. What was wrong with the checksum of the frame is wrong on the wire, too.
Result<void> BoardHost::put(const LineFrame& frame) {
  std::array<std::byte, fpga::FrameParser::kHeadBytes> head;
  std::size_t at = 0;
  for (const std::uint32_t field :
       {fpga::FrameParser::kKind, static_cast<std::uint32_t>(sent_ - 1), static_cast<std::uint32_t>(frame.revolution),
        static_cast<std::uint32_t>(frame.line), static_cast<std::uint32_t>(frame.first_slot),
        static_cast<std::uint32_t>(frame.bits.size())}) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      head[at++] = static_cast<std::byte>(field >> shift);
    }
  }
  const std::uint32_t crc = ~crc32c_continue(crc32c_continue(kCrc32cStart, head), frame.bits);
  GRAVURE_CHECK(byte(fpga::FrameParser::kMark));
  GRAVURE_CHECK(bytes(head));
  GRAVURE_CHECK(bytes(frame.bits));
  const std::uint32_t sent = crc ^ frame.crc32c ^ frame_crc32c(frame);
  for (unsigned shift = 0; shift < 32; shift += 8) {
    GRAVURE_CHECK(byte(static_cast<std::uint8_t>(sent >> shift)));
  }
  return {};
}

Result<void> BoardHost::finish() {
  return wait_until(first_line_ + sent_ * line_seeds_);
}

Result<void> BoardHost::close() {
  GRAVURE_CHECK(wait_until(now_ + kLead));
  return write(fpga::kControlRegister, 0);
}

}  // namespace gravure::emulator
