#include "board_machine.hpp"

#include <algorithm>

#include "gravure/fpga/ab_generator.hpp"
#include "gravure/fpga/pulse_gate.hpp"
#include "gravure/protocol/status_message.hpp"

namespace gravure::emulator {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr std::uint64_t kTicksPerSeed = fpga::AbGenerator::kClockMultiplier;
constexpr std::uint64_t kForEver = ~std::uint64_t{0};
constexpr std::size_t kQueuedLines = 16;

/// Bits of the control register.
constexpr std::uint32_t kRun = 1;
constexpr std::array<std::uint32_t, 2> kEnable{2, 8};
constexpr std::uint32_t kWatch = 4;
constexpr std::uint32_t kTimed = 16;
constexpr std::uint32_t kBackward = 32;

/// Bits of the command register.
constexpr std::uint16_t kAcknowledge = 1;
constexpr std::array<std::uint16_t, 2> kLoad{2, 16};
constexpr std::array<std::uint16_t, 2> kIncrement{4, 32};
constexpr std::uint16_t kPosition = 8;
constexpr std::uint16_t kGo = 64;
constexpr std::array<std::uint16_t, 2> kAppend{128, 256};
constexpr std::uint16_t kEmpty = 512;

std::uint8_t bit_of(DeviceFault fault) noexcept {
  return static_cast<std::uint8_t>(1U << (static_cast<unsigned>(fault) - 1U));
}

}  // namespace

EmulatedBoard::Machine::Machine(BoardOptions options)
    : options_(std::move(options)),
      start_ns_(options_.now_ns ? options_.now_ns() : 0),
      registers_(options_.fifo_bits),
      stream_(options_.capacity_bytes),
      random_(options_.seed) {}

LineStream::Shape EmulatedBoard::Machine::shape() const noexcept {
  const fpga::Settings::Outputs& s = registers_.settings();
  return {s.window_slots, s.slots_per_line, s.lines_per_revolution};
}

std::uint64_t EmulatedBoard::Machine::line_seeds() const noexcept {
  const fpga::Settings::Outputs& s = registers_.settings();
  return std::uint64_t{s.slots_per_line} * s.seeds_per_slot;
}

/// Splitmix64.
std::uint64_t EmulatedBoard::Machine::draw() noexcept {
  random_ += 0x9E37'79B9'7F4A'7C15;
  std::uint64_t value = random_;
  value = (value ^ (value >> 30U)) * 0xBF58'476D'1CE4'E5B9;
  value = (value ^ (value >> 27U)) * 0x94D0'49BB'1331'11EB;
  return value ^ (value >> 31U);
}

// Time

std::uint64_t EmulatedBoard::Machine::real_clock() const {
  return static_cast<std::uint64_t>(Wide{options_.now_ns() - start_ns_} * options_.seed_hz / 1'000'000'000U);
}

/// A clock that runs freely has gone on since the last call.
void EmulatedBoard::Machine::catch_up() {
  if (!stands_still()) {
    run_until(std::max(clock_, real_clock()));
  }
}

void EmulatedBoard::Machine::pass_time() {
  run_until(stands_still() ? kForEver : std::max(clock_, real_clock()));
}

void EmulatedBoard::Machine::run_until(std::uint64_t clock) {
  const bool watched = !stands_still() && control(kWatch) && !faulty();
  const std::uint64_t silent = watched ? last_host_ + registers_.settings().silence_limit : kForEver;
  while (next_event(std::min(clock, silent))) {
  }
  if (silent < clock) {
    move_clock(silent);
    close_gate(DeviceFault::host_silence, slots_begun());
    while (next_event(clock)) {
    }
  }
  if (!stands_still()) {
    move_clock(clock);
  }
}

void EmulatedBoard::Machine::move_clock(std::uint64_t clock) {
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    axes_[axis].run((clock - clock_) * kTicksPerSeed, control(kEnable[axis]), kTicksPerSeed);
  }
  clock_ = clock;
}

/// The next thing that lines do up to `clock`, whose clock is then the board's; false: nothing.
bool EmulatedBoard::Machine::next_event(std::uint64_t clock) {
  judge_all();
  if (faulty()) {
    if (started_ && dark_until_ <= clock) {
      faults_ |= bit_of(DeviceFault::underrun);  // dark lines run out as well
    }
    return false;
  }
  if (!control(kRun)) {
    return false;
  }
  if (!started_) {
    return start_by(clock);
  }
  if (line_runs_) {
    const bool ends = line_clock_ + line_seeds() <= clock;
    if (ends) {
      end_line();
    }
    return ends;
  }
  if (stream_.lines() != 0) {
    begin_line();
    return true;
  }
  if (!stands_still()) {
    close_gate(DeviceFault::underrun, 0);
  }
  return false;
}

/// Whether first_tick has come by then.
bool EmulatedBoard::Machine::start_by(std::uint64_t clock) {
  const std::uint64_t begin = go_clock_ + registers_.settings().first_tick;
  if (!gone_ || !control(kTimed) || begin < clock_ || begin > clock) {
    return false;
  }
  started_ = true;
  gone_ = false;
  move_clock(begin);
  return true;
}

// Lines

/// Whether the FPGA's FIFO and queue take one line more.
bool EmulatedBoard::Machine::has_room() const noexcept {
  const std::size_t bytes = fpga::packed_bytes(registers_.settings().window_slots);
  const std::size_t fifo = std::size_t{1} << static_cast<unsigned>(options_.fifo_bits);
  return stream_.lines() < kQueuedLines && (stream_.lines() + 1) * bytes <= fifo;
}

/// Judges one frame; false where there is none, or no room for it.
bool EmulatedBoard::Machine::judge_next() {
  if (faulty() || !stream_.next_frame(shape())) {
    return false;
  }
  if (!has_room()) {
    overflow_ = stream_.lines() == 0;  // no line so long fits at all
    if (overflow_) {
      strike(DeviceFault::shape);
    }
    return false;
  }
  const DeviceFault fault = stream_.judge_frame(shape());
  if (fault != DeviceFault::none) {
    strike(fault);
  }
  return fault == DeviceFault::none;
}

void EmulatedBoard::Machine::judge_all() {
  while (judge_next()) {
  }
}

/// Runs lines as long as a frame that is there waits for room.
void EmulatedBoard::Machine::make_room() {
  judge_all();
  while (!faulty() && stream_.next_frame(shape()) && next_event(kForEver)) {
  }
}

void EmulatedBoard::Machine::begin_line() {
  line_runs_ = true;
  line_clock_ = clock_;
  if (options_.observer != nullptr) {
    axes_at_start_ = {axes_[0].state(), axes_[1].state()};
  }
}

void EmulatedBoard::Machine::end_line() {
  show_line(registers_.settings().slots_per_line);
  move_clock(line_clock_ + line_seeds());
  drop_line();
  ++executed_;
  place_.line = place_.line + 1 >= registers_.settings().lines_per_revolution ? 0 : place_.line + 1;
  place_.revolution += place_.line == 0 ? 1U : 0U;
}

void EmulatedBoard::Machine::drop_line() {
  stream_.pop();
  line_runs_ = false;
}

/// Shows what fires of the line that runs, up to `slots` of it.
void EmulatedBoard::Machine::show_line(std::uint32_t slots) {
  if (options_.observer == nullptr) {
    return;
  }
  const LineStream::Line line = stream_.front();
  const fpga::Settings::Outputs& s = registers_.settings();
  const auto ordinal =
      std::int64_t{line.place.revolution} * std::int64_t{s.lines_per_revolution} + std::int64_t{line.place.line};
  const bool late = control(kBackward) && (ordinal & 1) != 0;
  const std::uint64_t start = line_clock_ - go_clock_ + (late ? s.reverse_delay : 0U);
  fired_.assign(line.bits.begin(), line.bits.end());
  if (slots < s.slots_per_line) {
    cut_line(fired_, line.first_slot, slots);
  }
  options_.observer->on_line({.start_tick = static_cast<std::int64_t>(start * kTicksPerSeed),
                              .ordinal = ordinal,
                              .first_slot = line.first_slot,
                              .fired = fired_,
                              .axis_at_start = axes_at_start_[0],
                              .carriage_at_start = axes_at_start_[1]});
}

/// Of the line that runs now.
std::uint32_t EmulatedBoard::Machine::slots_begun() const noexcept {
  const std::uint64_t seeds = clock_ - line_clock_;
  const std::uint64_t each = registers_.settings().seeds_per_slot;
  return line_runs_ ? static_cast<std::uint32_t>((seeds + each - 1) / each) : 0;
}

/// A fault that the stream brings: now, or where the clock stands still at any moment of the lines that are to run.
void EmulatedBoard::Machine::strike(DeviceFault fault) {
  const bool running = control(kRun) && (started_ || (stands_still() && start_by(kForEver)));
  if (!stands_still() || !running || stream_.lines() == 0) {
    close_gate(fault, slots_begun());
    return;
  }
  std::uint64_t before = draw() % stream_.lines();
  const auto slots = static_cast<std::uint32_t>(draw() % registers_.settings().slots_per_line);
  for (; before != 0; --before) {
    begin_line();
    end_line();
  }
  begin_line();
  close_gate(fault, slots);
}

/// The fault stands from now on, `slots` after the line that runs began.
void EmulatedBoard::Machine::close_gate(DeviceFault fault, std::uint32_t slots) {
  faults_ |= bit_of(fault);
  if (faulty()) {
    return;
  }
  fault_ = fault;
  const std::uint64_t begun = line_runs_ ? line_clock_ : clock_;
  dark_until_ = begun + stream_.lines() * line_seeds();
  cut_short(slots);
}

/// The line that runs does not go on.
void EmulatedBoard::Machine::cut_short(std::uint32_t slots) {
  if (!line_runs_) {
    return;
  }
  closed_slot_ = slots;
  if (slots != 0) {
    show_line(slots);
  }
  drop_line();
}

// Registers

void EmulatedBoard::Machine::write_register(std::uint8_t address, std::uint32_t value) {
  catch_up();
  last_host_ = clock_;
  const bool ran = control(kRun);
  obey(registers_.write(address, value));
  if (ran && !control(kRun)) {
    stop();
  }
}

void EmulatedBoard::Machine::load_axis(std::size_t axis) {
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

void EmulatedBoard::Machine::obey(std::uint16_t command) {
  const fpga::Settings::Outputs& s = registers_.settings();
  if ((command & kAcknowledge) != 0) {
    acknowledge();
  }
  if ((command & kPosition) != 0) {
    place_ = {s.position_revolution, s.position_line};
    stream_.set_place(place_);
    executed_ = closed_slot_ = 0;
    positioned_ = true;
  }
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    if ((command & kEmpty) != 0) {
      axes_[axis].empty();
    }
    if ((command & kLoad[axis]) != 0) {
      load_axis(axis);
    }
    if ((command & kIncrement[axis]) != 0) {
      axes_[axis].load_increment(axis == 0 ? s.increment : s.increment_1);
    }
    if ((command & kAppend[axis]) != 0) {
      axes_[axis].append({s.schedule_increment, s.schedule_seeds});
    }
    if ((command & kGo) != 0) {
      axes_[axis].go();
    }
  }
  if ((command & kGo) != 0) {
    go_clock_ = clock_;
    gone_ = true;
    started_ = false;
  }
}

/// Also empties the buffers.
void EmulatedBoard::Machine::acknowledge() noexcept {
  fault_ = DeviceFault::none;
  faults_ = 0;
  closed_slot_ = 0;
  overflow_ = line_runs_ = positioned_ = false;
  stream_.flush();
}

/// Slots run no more.
void EmulatedBoard::Machine::stop() {
  cut_short(slots_begun());
  gone_ = started_ = positioned_ = false;
}

std::uint32_t EmulatedBoard::Machine::fifo_level() const noexcept {
  return static_cast<std::uint32_t>(stream_.lines() * fpga::packed_bytes(registers_.settings().window_slots));
}

/// As fpga::Synchro puts it together.
std::uint16_t EmulatedBoard::Machine::status_word() const noexcept {
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

std::uint32_t EmulatedBoard::Machine::read_register(std::uint8_t address) {
  catch_up();
  return registers_.read(address, {.status = status_word(), .level = fifo_level(), .faults = faults_});
}

// The stream

std::size_t EmulatedBoard::Machine::take(std::span<const std::byte> stream) {
  catch_up();
  const std::size_t taken = std::min(stream.size(), stream_.room());
  if (taken != 0) {
    last_host_ = clock_;
    stream_.append(stream.first(taken));
    if (stands_still()) {
      make_room();
    } else {
      judge_all();
    }
  }
  return taken;
}

void EmulatedBoard::Machine::open_interlock() {
  catch_up();
  strike(DeviceFault::interlock);
}

BoardStatus EmulatedBoard::Machine::status() const {
  BoardStatus status;
  status.protocol_version = protocol::kProtocolVersion;
  status.state = faulty()                    ? BoardState::stopped
                 : started_ && control(kRun) ? BoardState::running
                 : positioned_               ? BoardState::filling
                                             : BoardState::idle;
  status.fault = fault_;
  status.faults = faults_;
  status.gate_dark = faulty();
  status.partial_line = closed_slot_ != 0;
  status.power_up = options_.power_up;
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
