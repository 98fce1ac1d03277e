#include "board_machine.hpp"

#include <algorithm>
#include <utility>

#include "gravure/fpga/pulse_gate.hpp"
#include "gravure/protocol/start_sequence.hpp"

namespace gravure::emulator {
namespace {

constexpr std::uint64_t kForEver = ~std::uint64_t{0};
constexpr std::size_t kQueuedLines = 16;

constexpr std::array<std::uint32_t, 2> kEnable{protocol::kControlAxis0, protocol::kControlAxis1};

std::uint8_t bit_of(DeviceFault fault) noexcept {
  return static_cast<std::uint8_t>(1U << (static_cast<unsigned>(fault) - 1U));
}

}  // namespace

BoardMachine::BoardMachine(const Setup& setup, PinObserver& observer)
    : setup_(setup),
      observer_(&observer),
      planned_(setup.faults),
      registers_(setup.fifo_bits),
      stream_(setup.capacity_bytes) {}

LineStream::Shape BoardMachine::shape() const noexcept {
  const fpga::Settings::Outputs& s = registers_.settings();
  return {s.window_slots, s.slots_per_line, s.lines_per_revolution};
}

/// Over the whole job; of any registers, so that it may be more than 63 bits hold.
std::int64_t BoardMachine::ordinal_of(LineStream::Place place) const noexcept {
  const std::uint64_t lines = registers_.settings().lines_per_revolution;
  return static_cast<std::int64_t>(place.revolution * lines + place.line);
}

std::uint64_t BoardMachine::line_seeds() const noexcept {
  const fpga::Settings::Outputs& s = registers_.settings();
  return std::uint64_t{s.slots_per_line} * s.seeds_per_slot;
}

/// Splitmix64.
std::uint64_t BoardMachine::draw() noexcept {
  setup_.random += 0x9E37'79B9'7F4A'7C15;
  std::uint64_t value = setup_.random;
  value = (value ^ (value >> 30U)) * 0xBF58'476D'1CE4'E5B9;
  value = (value ^ (value >> 27U)) * 0x94D0'49BB'1331'11EB;
  return value ^ (value >> 31U);
}

// Time

/// A clock that runs freely has gone on since the last call.
void BoardMachine::catch_up(std::uint64_t clock) {
  if (!stands_still()) {
    run_until(std::max(clock_, clock));
  }
}

void BoardMachine::pass_time(std::uint64_t clock) {
  run_until(stands_still() ? kForEver : std::max(clock_, clock));
}

/// Whatever the watchdog makes of it: where it is off the lines run out.
void BoardMachine::lose_host() {
  const auto goes_on = [this] {
    return !faulty() && !power_lost_ && control(protocol::kControlRun) && (started_ || gone_);
  };
  if (stands_still()) {
    run_until(kForEver);
    if (goes_on() && started_) {
      close_gate(DeviceFault::underrun, 0);
    }
    return;
  }
  if (goes_on() && !started_ && control(protocol::kControlTimed)) {
    run_until(std::max(clock_, go_clock_ + registers_.settings().first_tick));
  }
  while (goes_on() && started_) {
    run_until(clock_ + line_seeds());
  }
}

bool BoardMachine::can_run() const noexcept {
  if (power_lost_ || !control(protocol::kControlRun)) {
    return false;
  }
  if (faulty()) {
    return (started_ || gone_) && (faults_ & bit_of(DeviceFault::underrun)) == 0;
  }
  return stream_.level() != 0 || gone_ || frame_lost_;
}

void BoardMachine::run_until(std::uint64_t clock) {
  const bool watched = !stands_still() && control(protocol::kControlWatchdog) && !faulty();
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

void BoardMachine::move_clock(std::uint64_t clock) {
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    axes_[axis].run((clock - clock_) * kTicksPerSeed, control(kEnable[axis]), kTicksPerSeed);
  }
  clock_ = clock;
}

/// The next thing that lines do up to `clock`, whose clock is then the board's; false: nothing.
bool BoardMachine::next_event(std::uint64_t clock) {
  judge_all();
  if (power_lost_) {
    return false;
  }
  if (faulty()) {
    run_dark(clock);
    return false;
  }
  if (!control(protocol::kControlRun)) {
    return false;
  }
  if (!started_) {
    return start_by(clock);
  }
  if (line_runs_ && due_) {
    return meet_fault(clock);
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
  if (!stands_still() || frame_lost_) {
    close_gate(DeviceFault::underrun, 0);
  }
  return false;
}

/// A fault stands: lines begin and run out, but none fires.
void BoardMachine::run_dark(std::uint64_t clock) {
  if (control(protocol::kControlRun) && !started_ && start_by(clock)) {
    dark_until_ = clock_ + stream_.lines() * line_seeds();
  }
  if (started_ && dark_until_ <= clock) {
    faults_ |= bit_of(DeviceFault::underrun);
  }
}

/// Whether first_tick has come by then.
bool BoardMachine::start_by(std::uint64_t clock) {
  const std::uint64_t begin = go_clock_ + registers_.settings().first_tick;
  if (!gone_ || !control(protocol::kControlTimed) || begin < clock_ || begin > clock) {
    return false;
  }
  started_ = true;
  gone_ = false;
  move_clock(begin);
  return true;
}

// Lines

/// Whether the FPGA's FIFO and queue take one line more.
bool BoardMachine::has_room() const noexcept {
  const std::size_t bytes = fpga::packed_bytes(registers_.settings().window_slots);
  const std::size_t fifo = std::size_t{1} << static_cast<unsigned>(setup_.fifo_bits);
  return stream_.lines() < kQueuedLines && (stream_.lines() + 1) * bytes <= fifo;
}

/// Judges one frame; false where there is none, or no room for it.
bool BoardMachine::judge_next() {
  if (faulty() || power_lost_ || !stream_.next_frame(shape())) {
    return false;
  }
  if (!has_room()) {
    overflow_ = stream_.lines() == 0;  // no line so long fits at all
    if (overflow_) {
      strike(DeviceFault::shape);
    }
    return false;
  }
  if (spoil_frame()) {
    return true;
  }
  const DeviceFault fault = stream_.judge_frame(shape());
  if (fault != DeviceFault::none) {
    strike(fault);
  }
  return fault == DeviceFault::none;
}

void BoardMachine::judge_all() {
  while (judge_next()) {
  }
}

/// Runs lines as long as a frame that is there waits for room.
void BoardMachine::make_room() {
  judge_all();
  while (!faulty() && !power_lost_ && stream_.next_frame(shape()) && next_event(kForEver)) {
  }
}

void BoardMachine::begin_line() {
  line_runs_ = true;
  line_clock_ = clock_;
  axes_at_start_ = {axes_[0].state(), axes_[1].state()};
  due_ = planned_.at_line(ordinal_of(stream_.front().place));
}

void BoardMachine::end_line() {
  const std::uint64_t end = line_clock_ + line_seeds();
  complete_line();
  move_clock(end);
}

void BoardMachine::complete_line() {
  show_line(registers_.settings().slots_per_line);
  drop_line();
  ++executed_;
  place_.line = place_.line + 1 >= registers_.settings().lines_per_revolution ? 0 : place_.line + 1;
  place_.revolution += place_.line == 0 ? 1U : 0U;
}

void BoardMachine::drop_line() {
  stream_.pop();
  line_runs_ = false;
  due_.reset();
}

/// Shows what fires of the line that runs, up to `slots` of it.
void BoardMachine::show_line(std::uint32_t slots) {
  const LineStream::Line line = stream_.front();
  const fpga::Settings::Outputs& s = registers_.settings();
  const std::int64_t ordinal = ordinal_of(line.place);
  const std::uint64_t start = line_clock_ - go_clock_ + delay_of(line.place);
  fired_.assign(line.bits.begin(), line.bits.end());
  if (slots < s.slots_per_line) {
    cut_line(fired_, line.first_slot, slots);
  }
  observer_->on_line({.start_tick = static_cast<std::int64_t>(start * kTicksPerSeed),
                      .ordinal = ordinal,
                      .first_slot = line.first_slot,
                      .fired = fired_,
                      .axis_at_start = axes_at_start_[0],
                      .carriage_at_start = axes_at_start_[1]});
}

/// Of the line that runs now.
std::uint32_t BoardMachine::slots_begun() const noexcept {
  const fpga::Settings::Outputs& s = registers_.settings();
  const std::uint64_t begin = line_clock_ + (line_runs_ ? delay_of(stream_.front().place) : 0U);
  if (!line_runs_ || clock_ <= begin) {
    return 0;
  }
  const std::uint64_t slots = (clock_ - begin + s.seeds_per_slot - 1) / s.seeds_per_slot;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(slots, s.slots_per_line));
}

/// Seed clocks by which the slots of a line come later than those of a forward one.
std::uint32_t BoardMachine::delay_of(LineStream::Place place) const noexcept {
  const bool backward = control(protocol::kControlBackward) && (ordinal_of(place) & 1) != 0;
  return backward ? registers_.settings().reverse_delay : 0U;
}

/// A fault that the stream brings: now, or where the clock stands still at any moment of the lines that are to run.
void BoardMachine::strike(DeviceFault fault) {
  const bool running = control(protocol::kControlRun) && (started_ || (stands_still() && start_by(kForEver)));
  if (!stands_still() || !running || stream_.lines() == 0) {
    close_gate(fault, slots_begun());
    return;
  }
  std::uint64_t before = draw() % stream_.lines();
  const auto slots = static_cast<std::uint32_t>(draw() % registers_.settings().slots_per_line);
  for (; before != 0; --before) {
    begin_line();
    if (due_) {
      break;
    }
    end_line();
  }
  if (!line_runs_) {
    begin_line();
  }
  if (!due_) {
    close_gate(fault, slots);
  } else {
    meet_fault(kForEver);  // it comes first
  }
}

/// The fault stands from now on, `slots` after the line that runs began.
void BoardMachine::close_gate(DeviceFault fault, std::uint32_t slots) {
  faults_ |= bit_of(fault);
  if (faulty()) {
    return;
  }
  fault_ = fault;
  const std::uint64_t begun = line_runs_ ? line_clock_ : clock_;
  dark_until_ = begun + stream_.lines() * line_seeds();
  cut_short(slots);
}

/// The line that runs does not go on. Once its last slot has begun it is whole.
void BoardMachine::cut_short(std::uint32_t slots) {
  if (!line_runs_) {
    return;
  }
  if (slots >= registers_.settings().slots_per_line) {
    complete_line();
    return;
  }
  partial_ = slots != 0;
  closed_slot_ = slots;
  if (partial_) {
    show_line(slots);
  }
  drop_line();
}

// The stream

/// Of `wanted` bytes, where some are planned never to be taken.
std::size_t BoardMachine::most_taken(std::size_t wanted) const {
  const std::optional<std::int64_t> full = planned_.first_byte(WireFaultKind::full);
  const std::size_t room = std::min(wanted, stream_.room());
  return full ? std::min(room, static_cast<std::size_t>(std::max<std::int64_t>(*full - taken_bytes_, 0))) : room;
}

std::size_t BoardMachine::room(std::uint64_t clock) {
  catch_up(clock);
  return power_lost_ ? 0 : most_taken(stream_.room());
}

std::size_t BoardMachine::take(std::span<const std::byte> stream, std::uint64_t clock) {
  catch_up(clock);
  const std::size_t taken = power_lost_ ? 0 : most_taken(stream.size());
  if (taken == 0) {
    return 0;
  }
  last_host_ = clock_;
  stream_.append(stream.first(taken));
  const std::int64_t end = taken_bytes_ + static_cast<std::int64_t>(taken);
  while (const std::optional<WireFault> fault = planned_.at_byte(WireFaultKind::corrupt, taken_bytes_, end)) {
    stream_.spoil(static_cast<std::size_t>(end - fault->byte));
  }
  taken_bytes_ = end;
  if (stands_still()) {
    make_room();
  } else {
    judge_all();
  }
  return taken;
}

void BoardMachine::open_interlock(std::uint64_t clock) {
  catch_up(clock);
  strike(DeviceFault::interlock);
}

// Planned faults

/// The one in the line that runs, if its slot comes by then.
bool BoardMachine::meet_fault(std::uint64_t clock) {
  const fpga::Settings::Outputs& s = registers_.settings();
  const auto slot = static_cast<std::uint32_t>(std::min<std::int64_t>(due_->slot, s.slots_per_line - 1));
  const std::uint64_t when = line_clock_ + std::uint64_t{slot} * s.seeds_per_slot;
  if (when > clock) {
    return false;
  }
  move_clock(std::max(clock_, when));
  const WireFaultKind kind = due_->kind;
  if (kind == WireFaultKind::power) {
    cut_short(slot);
    power_lost_ = true;
  } else {
    close_gate(kind == WireFaultKind::silence     ? DeviceFault::host_silence
               : kind == WireFaultKind::interlock ? DeviceFault::interlock
                                                  : DeviceFault::underrun,
               slot);
  }
  return true;
}

/// What is planned for the next frame is done to it; true: it is there no more.
bool BoardMachine::spoil_frame() {
  const std::span<std::byte> frame = *stream_.next_frame(shape());
  if (frame.size() == 1) {
    return false;
  }
  const std::optional<WireFault> fault = planned_.at_frame(ordinal_of(stream_.next_place()));
  if (!fault) {
    return false;
  }
  switch (fault->kind) {
    case WireFaultKind::lost:
      frame_lost_ = true;
      stream_.drop_frame(shape());
      return true;
    case WireFaultKind::duplicate:
      stream_.repeat_frame(shape());
      return false;
    case WireFaultKind::shape:
      LineStream::leave_line(frame);
      return false;
    default:
      frame.back() ^= std::byte{1};
      return false;
  }
}

}  // namespace gravure::emulator
