#include <array>
#include <utility>

#include "board_machine.hpp"
#include "gravure/fpga/line_progress.hpp"
#include "gravure/fpga/pulse_gate.hpp"
#include "gravure/protocol/start_sequence.hpp"
#include "gravure/protocol/status_message.hpp"

// What the registers of a board do, and what it says of itself.
namespace gravure::emulator {
namespace {

constexpr std::array<std::uint32_t, 2> kLoadCommands{protocol::kCommandLoad0, protocol::kCommandLoad1};
constexpr std::array<std::uint32_t, 2> kIncrement{4, 32};
constexpr std::array<std::uint32_t, 2> kAppend{protocol::kCommandAppend0, protocol::kCommandAppend1};

}  // namespace

std::uint16_t BoardMachine::write_register(std::uint8_t address, std::uint32_t value, std::uint64_t clock) {
  catch_up(clock);
  last_host_ = clock_;
  const bool ran = control(protocol::kControlRun);
  const std::uint32_t slots = slots_begun();
  const std::uint16_t command = registers_.write(address, value);
  obey(command);
  if (ran && !control(protocol::kControlRun)) {
    cut_short(slots);
    gone_ = started_ = positioned_ = false;
  }
  return command;
}

void BoardMachine::load_axis(std::size_t axis) {
  const fpga::Settings::Outputs& s = registers_.settings();
  axes_[axis].load(axis == 0 ? fpga::AbRegisters{.prescaler = s.prescaler,
                                                 .increment = s.increment,
                                                 .fraction_num = s.fraction_num,
                                                 .fraction_den = s.fraction_den}
                             : fpga::AbRegisters{.prescaler = s.prescaler_1,
                                                 .increment = s.increment_1,
                                                 .fraction_num = s.fraction_num_1,
                                                 .fraction_den = s.fraction_den_1});
}

void BoardMachine::obey(std::uint16_t command) {
  const fpga::Settings::Outputs& s = registers_.settings();
  if ((command & protocol::kCommandAcknowledge) != 0) {
    acknowledge();
  }
  if ((command & protocol::kCommandPosition) != 0) {
    place_ = {s.position_revolution, s.position_line};
    stream_.set_place(place_);
    executed_ = closed_slot_ = 0;
    partial_ = false;
    positioned_ = true;
  }
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    if ((command & protocol::kCommandStopSchedules) != 0) {
      axes_[axis].empty();
    }
    if ((command & kLoadCommands[axis]) != 0) {
      load_axis(axis);
    }
    if ((command & kIncrement[axis]) != 0) {
      axes_[axis].load_increment(axis == 0 ? s.increment : s.increment_1);
    }
    if ((command & kAppend[axis]) != 0) {
      axes_[axis].append({s.schedule_increment, s.schedule_seeds});
    }
    if ((command & protocol::kCommandGo) != 0) {
      axes_[axis].go();
    }
  }
  if ((command & protocol::kCommandGo) != 0) {
    go_clock_ = clock_;
    gone_ = true;
    started_ = false;
  }
}

/// Also empties the buffers.
void BoardMachine::acknowledge() noexcept {
  fault_ = DeviceFault::none;
  faults_ = 0;
  closed_slot_ = 0;
  overflow_ = line_runs_ = partial_ = positioned_ = frame_lost_ = false;
  due_.reset();
  stream_.flush();
}

std::uint32_t BoardMachine::fifo_level() const noexcept {
  return static_cast<std::uint32_t>(stream_.lines() * fpga::packed_bytes(registers_.settings().window_slots));
}

/// As fpga::Synchro puts it together.
std::uint16_t BoardMachine::status_word() const noexcept {
  const bool bits[] = {faulty(),
                       line_runs_,
                       axes_[0].refused(),
                       overflow_,
                       axes_[1].refused(),
                       axes_[0].busy(),
                       axes_[1].busy(),
                       axes_[0].overflow() || axes_[1].overflow(),
                       registers_.refused(),
                       false,  // no encoder, no index
                       started_,
                       fifo_level() <= registers_.settings().low_level};
  auto value = static_cast<unsigned>(fault_);
  unsigned at = 3;
  for (const bool bit : bits) {
    value |= bit ? 1U << at : 0U;
    ++at;
  }
  return static_cast<std::uint16_t>(value);
}

std::uint32_t BoardMachine::read_register(std::uint8_t address, std::uint64_t clock) {
  catch_up(clock);
  const std::uint32_t slots = partial_ ? closed_slot_ | fpga::LineProgress::kPartialBit : slots_begun();
  return registers_.read(address, {.status = status_word(),
                                   .level = fifo_level(),
                                   .faults = faults_,
                                   .executed_lines = executed_,
                                   .closed_slot = slots});
}

bool BoardMachine::rests() const noexcept {
  return !control(protocol::kControlRun) && !axes_[0].has_segments() && !axes_[1].has_segments();
}

void BoardMachine::restore(const Counters& counters) noexcept {
  executed_ = counters.executed;
  place_ = counters.place;
  const std::uint64_t lines = registers_.settings().lines_per_revolution;
  const std::uint64_t line = place_.line + std::uint64_t{counters.taken} - counters.executed;
  stream_.set_place(
      {static_cast<std::uint32_t>(place_.revolution + line / lines), static_cast<std::uint32_t>(line % lines)},
      counters.taken);
}

const BoardMachine::Setup& BoardMachine::setup_from_now() {
  planned_.rebase(std::exchange(taken_bytes_, 0));
  setup_.faults = planned_.left();
  return setup_;
}

void BoardMachine::set_up(const Setup& setup) {
  setup_.random = setup.random;
  setup_.stands_still = setup.stands_still;
  planned_ = WireFaults(setup.faults);
  taken_bytes_ = 0;
}

BoardStatus BoardMachine::status() const {
  BoardStatus status;
  status.protocol_version = protocol::kProtocolVersion;
  status.state = faulty()                                     ? BoardState::stopped
                 : started_ && control(protocol::kControlRun) ? BoardState::running
                 : positioned_                                ? BoardState::filling
                                                              : BoardState::idle;
  status.fault = fault_;
  status.faults = faults_;
  status.gate_dark = faulty();
  status.partial_line = partial_;
  status.tick = (clock_ - go_clock_) * kTicksPerSeed;
  status.revolution = place_.revolution;
  status.line = place_.line;
  status.taken_lines = stream_.taken();
  status.executed_lines = executed_;
  status.closed_slot = closed_slot_;
  status.level_bytes = static_cast<std::uint32_t>(stream_.level());
  status.capacity_bytes = static_cast<std::uint32_t>(stream_.capacity());
  return status;
}

}  // namespace gravure::emulator
