#include "run_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/frame.hpp"

namespace gravure::session {
namespace {

using protocol::RegisterWrite;
using std::chrono::milliseconds;

/// Frames are packed and handed over in pieces of about so many bytes, two of them in turn: one on its way, one packed.
constexpr std::size_t kPieceBytes = std::size_t{64} << 10U;
constexpr milliseconds kTick{5};
constexpr milliseconds kSettleTime{2'000};

/// Bits go first in time first, high bit first.
void clear_first_bits(std::vector<std::byte>& bits, std::int64_t count) {
  const std::size_t whole = std::min(bits.size(), static_cast<std::size_t>(count / 8));
  std::fill_n(bits.begin(), whole, std::byte{0});
  if (whole < bits.size()) {
    bits[whole] &= std::byte{0xFF} >> static_cast<unsigned>(count % 8);
  }
}

Error device_error(const std::string& text) {
  return {ErrorCode::device, text};
}

}  // namespace

PartRun::PartRun(LineSource& program, DeviceLink& link, Journal& journal, PartSettings settings,
                 const RunOptions& options, RunObserver& observer, const CancelToken& cancel)
    : program_(program),
      link_(link),
      journal_(journal),
      settings_(std::move(settings)),
      options_(options),
      observer_(observer),
      cancel_(cancel),
      feed_(program, settings_.first.line, settings_.end_line, options.memory_bytes),
      last_spoken_(Clock::now()),
      last_moved_(Clock::now()) {}

PartOutcome PartRun::run() {
  return conclude(run_lines());
}

Result<void> PartRun::run_lines() {
  const Clock::time_point counted_from = Clock::now();
  GRAVURE_CHECK(load_board());
  GRAVURE_CHECK(fill());
  GRAVURE_CHECK(wait_out_old_count(counted_from));
  GRAVURE_CHECK(start());
  return stream();
}

// Before go

Result<void> PartRun::load_board() {
  GRAVURE_CHECK(link_.abandon());
  GRAVURE_CHECK(write(settings_.sequence.settings));
  GRAVURE_CHECK(check_refused(
      protocol::kStatusSettingRefused | protocol::kStatusLoad0Refused | protocol::kStatusLoad1Refused, "settings"));
  // Seen in between, what the position brings is news even where the board was filling before.
  GRAVURE_TRY([[maybe_unused]] const std::optional<BoardStatus> between, link_.next_status(kTick));
  GRAVURE_CHECK(write(settings_.sequence.prepare));
  GRAVURE_CHECK(check_refused(protocol::kStatusSettingRefused | protocol::kStatusScheduleOverflow, "schedules"));
  // Messages from before the position was set are still on their way.
  const Clock::time_point until = Clock::now() + kSettleTime;
  while (Clock::now() < until) {
    GRAVURE_TRY(const std::optional<BoardStatus> status, link_.next_status(kTick));
    if (status && status->state == BoardState::filling && status->executed_lines == 0 && status->taken_lines == 0) {
      return take_status(*status);
    }
    if (!status) {
      std::this_thread::sleep_for(milliseconds(1));
    }
  }
  return Error{ErrorCode::timeout, "the board does not say that it is ready for lines"};
}

Result<void> PartRun::check_refused(std::uint32_t bits, const char* when) {
  GRAVURE_TRY(const std::uint32_t status, link_.read_register(fpga::kStatusRegister.address));
  if ((status & bits) == 0) {
    return {};
  }
  return device_error(
      fmt::format("the board refuses its {} (status register 0x{:04x}{}{}{}{}): plan the job for this "
                  "board and compile again",
                  when, status, (status & protocol::kStatusSettingRefused) != 0 ? ", a setting" : "",
                  (status & protocol::kStatusLoad0Refused) != 0 ? ", A-B of axis 0" : "",
                  (status & protocol::kStatusLoad1Refused) != 0 ? ", A-B of axis 1" : "",
                  (status & protocol::kStatusScheduleOverflow) != 0 ? ", too many segments" : ""));
}

Result<void> PartRun::fill() {
  last_moved_ = Clock::now();
  while (level_bytes_ < settings_.reserve_bytes && taken_ != lines()) {
    GRAVURE_CHECK(pump());
  }
  return {};
}

/// A board goes on counting to first_tick from an earlier go, even while no slots run: lines must not be allowed to run
/// while that count may come to its end. Once they are, the watchdog closes the gate of a host that does not say go.
Result<void> PartRun::wait_out_old_count(Clock::time_point counted_from) {
  const std::chrono::duration<double> end = seconds_of(settings_.sequence.first_tick) + milliseconds(2);
  const std::chrono::duration<double> margin = 2 * seconds_of(settings_.timing.silence_seeds) + milliseconds(100);
  while (true) {
    const std::chrono::duration<double> passed = Clock::now() - counted_from;
    if (passed > end || passed + margin < end) {
      return {};
    }
    GRAVURE_CHECK(await_status(kTick));
    if (cancel_.cancelled()) {
      return Error{ErrorCode::cancelled, "stopped on request"};
    }
  }
}

Result<void> PartRun::start() {
  const std::int64_t capacity_lines = settings_.capacity_bytes / settings_.frame_bytes + 1;
  const std::int64_t ahead = 2 * capacity_lines + JournalWriter::kMostLines;
  Acknowledged now = acknowledged();
  now.sent_limit = std::min(settings_.end_line, now.sent_line + ahead);
  GRAVURE_CHECK(journal_.started(now.sent_limit));
  writer_ = std::make_unique<JournalWriter>(journal_, now, ahead, settings_.end_line);
  started_ = true;
  last_moved_ = go_ = Clock::now();
  GRAVURE_CHECK(write(settings_.sequence.start));
  return check_refused(protocol::kStatusSettingRefused, "start");
}

// Streaming

Result<void> PartRun::stream() {
  while (!all_executed()) {
    GRAVURE_CHECK(pump());
  }
  return {};
}

Result<void> PartRun::pump() {
  if (cancel_.cancelled()) {
    return Error{ErrorCode::cancelled, "stopped on request"};
  }
  if (const std::optional<Error> error = writer_ ? writer_->error() : std::nullopt) {
    return *error;
  }
  GRAVURE_CHECK(pack());
  GRAVURE_TRY(const bool moved, send());
  GRAVURE_CHECK(await_status(moved ? milliseconds(0) : kTick));
  GRAVURE_CHECK(keep_alive());
  return check_stall();
}

Result<void> PartRun::pack() {
  if (pending_sent_ == pending_.size()) {
    pending_.clear();
    pending_sent_ = 0;
  }
  const std::int64_t limit = writer_ ? writer_->sent_limit() : settings_.end_line;
  const LineSource& program = program_;
  const std::int64_t per_revolution = program.header().plan.rotary.lines_per_revolution;
  while (pending_.size() < kPieceBytes && settings_.first.line + packed_lines_ < limit) {
    GRAVURE_TRY(const std::optional<FeedLine> line, feed_.next());
    if (!line) {
      break;
    }
    const bool backward = ((line->revolution * per_revolution + line->line) & 1) != 0;
    GRAVURE_TRY(const std::int64_t first_slot,
                protocol::framed_first_slot(line->first_slot, backward, settings_.timing));
    std::span<const std::byte> bits = line->bits;
    if (packed_lines_ == 0 && settings_.first.slots > first_slot) {
      masked_.assign(bits.begin(), bits.end());
      clear_first_bits(masked_, settings_.first.slots - first_slot);
      bits = masked_;
    }
    protocol::append_frame(pending_,
                           {.sequence = static_cast<std::uint32_t>(packed_lines_),
                            .revolution = static_cast<std::uint32_t>(line->revolution),
                            .line = static_cast<std::uint32_t>(line->line),
                            .first_slot = static_cast<std::uint32_t>(first_slot)},
                           bits);
    ++packed_lines_;
  }
  return {};
}

/// As much as the board has room for beside what is on its way, or waits in it; true where something went.
Result<bool> PartRun::send() {
  const std::int64_t in_board = sent_bytes_ - executed_ * settings_.frame_bytes;
  const std::int64_t credit = std::max(settings_.capacity_bytes - in_board, std::int64_t{0});
  const std::span<const std::byte> rest = std::span(pending_).subspan(pending_sent_);
  const std::span<const std::byte> piece = rest.first(std::min(rest.size(), static_cast<std::size_t>(credit)));
  waits_for_board_ = piece.empty() && (!rest.empty() || packed_lines_ == lines());
  if (piece.empty()) {
    return false;
  }
  GRAVURE_TRY(const std::size_t taken, link_.send(piece, milliseconds(0)));
  waits_for_board_ = taken == 0;
  pending_sent_ += taken;
  sent_bytes_ += static_cast<std::int64_t>(taken);
  if (taken != 0) {
    last_spoken_ = last_moved_ = Clock::now();
  }
  return taken != 0;
}

Result<void> PartRun::await_status(Milliseconds patience) {
  const Clock::time_point asked = Clock::now();
  GRAVURE_TRY(const std::optional<BoardStatus> status, link_.next_status(patience));
  if (status) {
    return take_status(*status);
  }
  if (patience.count() != 0 && Clock::now() - asked < milliseconds(1)) {
    std::this_thread::sleep_for(milliseconds(1));  // a link that does not wait
  }
  return {};
}

Result<void> PartRun::take_status(const BoardStatus& status) {
  if (status.power_up != settings_.power_up) {
    power_lost_ = true;
    return device_error("the board has lost its power and its state");
  }
  if (newest_ && static_cast<std::int32_t>(status.sequence - *newest_) <= 0) {
    return {};  // overtaken by another
  }
  newest_ = status.sequence;
  const auto forward = [](std::int64_t known, std::uint32_t now) {
    return known + static_cast<std::int64_t>(std::uint32_t{now - static_cast<std::uint32_t>(known)});
  };
  const std::int64_t executed = forward(executed_, status.executed_lines);
  const std::int64_t taken = forward(taken_, status.taken_lines);
  if (taken > sent_lines() || executed > taken) {
    out_of_reach_ = true;
    return device_error(fmt::format("the board says that it has taken {} lines and executed {}, {} were sent", taken,
                                    executed, sent_lines()));
  }
  // A clock that goes on is no movement by itself, but for the count to the first line.
  if (executed != executed_ || taken != taken_ || status.level_bytes != level_bytes_) {
    last_moved_ = Clock::now();
  }
  executed_ = executed;
  taken_ = taken;
  tick_ = status.tick;
  level_bytes_ = status.level_bytes;
  closed_slot_ = status.partial_line ? std::optional(status.closed_slot) : std::nullopt;
  ran_ = ran_ || status.state == BoardState::running;
  if (writer_) {
    writer_->post(acknowledged());
  }
  observer_.on_counts(counts());
  if (status.state == BoardState::stopped) {
    stopped_ = status;
    return all_executed() ? Result<void>() : device_error("board fault: " + to_string(status.fault));
  }
  if (ran_ && status.state == BoardState::idle && !all_executed()) {
    return device_error("the board has stopped without a fault");
  }
  return {};
}

/// The watchdog of the board takes a host for dead that says nothing: while there is nothing to send, a register is
/// written that changes nothing.
Result<void> PartRun::keep_alive() {
  const std::chrono::duration<double> limit(static_cast<double>(settings_.timing.silence_seeds) /
                                            static_cast<double>(settings_.seed_hz));
  if (!started_ || settings_.timing.silence_seeds == 0 || Clock::now() - last_spoken_ < limit / 4) {
    return {};
  }
  return write({{fpga::kLowLevelRegister.address, 0}});
}

Result<void> PartRun::check_stall() {
  if (!waits_for_board_) {
    last_moved_ = std::max(last_moved_, Clock::now() - options_.stall / 2);
    return {};
  }
  const bool counts = started_ && executed_ == 0 && since_go() < seconds_of(settings_.sequence.first_tick);
  if (counts) {
    last_moved_ = Clock::now();
  }
  if (Clock::now() - last_moved_ < options_.stall) {
    return {};
  }
  return Error{ErrorCode::timeout,
               fmt::format("the board neither takes nor executes anything for {} ms, {} bytes are under way",
                           options_.stall.count(), sent_bytes_ - taken_ * settings_.frame_bytes)};
}

Result<void> PartRun::write(const std::vector<RegisterWrite>& writes) {
  for (const RegisterWrite& one : writes) {
    GRAVURE_CHECK(link_.write_register(one.address, one.value));
  }
  last_spoken_ = Clock::now();
  return {};
}

// The end

/// Waits until the board says that nothing runs any more: then its counts are exact. A message from before the gate was
/// closed says that lines run, or that none has begun.
Result<void> PartRun::settle() {
  const Clock::time_point until = Clock::now() + options_.stall / 5;
  while (Clock::now() < until) {
    GRAVURE_TRY(const std::optional<BoardStatus> status, link_.next_status(kTick));
    if (!status) {
      std::this_thread::sleep_for(milliseconds(1));
      continue;
    }
    static_cast<void>(take_status(*status));
    const bool at_rest = status->state == BoardState::idle || status->state == BoardState::stopped;
    if (power_lost_ || out_of_reach_ || (at_rest && newest_ == status->sequence)) {
      return {};
    }
  }
  return Error{ErrorCode::timeout, "the board does not say that its lines have stopped"};
}

std::chrono::duration<double> PartRun::seconds_of(std::uint64_t seeds) const {
  return std::chrono::duration<double>(static_cast<double>(seeds) / static_cast<double>(settings_.seed_hz));
}

/// By the clock of the host, or of the board where that is further on: one that is emulated leaps.
std::chrono::duration<double> PartRun::since_go() const {
  const std::chrono::duration<double> passed = Clock::now() - go_;
  return std::max(passed, seconds_of(tick_ / static_cast<std::uint64_t>(settings_.ticks_per_seed)));
}

/// The control register while the axes move and no lines run: they go on the way they went.
std::uint32_t PartRun::axes_on() const {
  const bool moving = started_ && settings_.stop_time.count() != 0;
  const std::uint32_t way = settings_.sequence.start.front().value & protocol::kControlAxis0Backward;
  return moving ? protocol::kControlAxis0 | protocol::kControlAxis1 | way : 0;
}

/// An axis that never moved has nothing to come down from. One in its ramp comes to its end first: a schedule down
/// begins at the marking speed. Where the schedule of the start ends at rest, and is about to or does already, nothing
/// is to be added to it.
Result<void> PartRun::bring_to_rest() {
  if (axes_on() == 0) {
    return write({{fpga::kControlRegister.address, 0}});
  }
  constexpr milliseconds kLeastAhead{100};
  const bool goes_down = all_executed() || since_go() + kLeastAhead > seconds_of(settings_.marking_end_seeds);
  if (!settings_.sequence.ends_at_rest || !goes_down) {
    while (!ran_ && executed_ == 0 && since_go() < seconds_of(settings_.ramp_seeds)) {
      std::this_thread::sleep_for(kTick);
    }
    std::vector<RegisterWrite> stop = settings_.stop;
    stop.front().value |= axes_on();
    GRAVURE_CHECK(write(stop));
    // The segments went through the register that holds the mark of this attempt.
    GRAVURE_CHECK(write({{fpga::kScheduleIncrementRegister.address, settings_.timing.mark}}));
  }
  GRAVURE_CHECK(wait_for_rest());
  return write({{fpga::kControlRegister.address, 0}});
}

Result<void> PartRun::wait_for_rest() {
  const Clock::time_point until = Clock::now() + settings_.stop_time + settings_.stop_time / 2 + milliseconds(300);
  Clock::time_point ticked = Clock::now();
  std::uint64_t tick = tick_;
  while (Clock::now() < until && Clock::now() - ticked < milliseconds(300)) {
    GRAVURE_TRY(const std::optional<BoardStatus> status, link_.next_status(milliseconds(20)));
    if (status && status->tick != tick) {
      tick = status->tick;
      ticked = Clock::now();  // the clock of an emulated board may stand still
    }
    GRAVURE_TRY(const std::uint32_t word, link_.read_register(fpga::kStatusRegister.address));
    if ((word & protocol::kStatusScheduleBusy) == 0) {
      return {};
    }
    std::this_thread::sleep_for(milliseconds(5));
  }
  return {};
}

/// The gate first of all. Whatever goes wrong here, the watchdog of the board closes it.
void PartRun::close_gate() {
  gate_closed_ = write({{fpga::kControlRegister.address, axes_on()}}) || stopped_.has_value() || !started_;
  if (!gate_closed_ || (started_ && !stopped_ && !settle())) {
    out_of_reach_ = true;
  }
}

/// What was fired is on disk before the axes are brought to rest, which takes its time.
PartOutcome PartRun::conclude(Result<void> ran) {
  close_gate();
  if (writer_) {
    writer_->stop();
  }
  PartOutcome outcome;
  outcome.ran = std::move(ran);
  if (all_executed()) {
    outcome.ran = {};  // whatever came behind the last line
  }
  outcome.fault = stopped_ && !all_executed() ? stopped_->fault : DeviceFault::none;
  outcome.exact = !started_ || all_executed() || !(out_of_reach_ || power_lost_);
  const std::int64_t line = settings_.first.line + executed_;
  const std::int64_t before = executed_ == 0 ? settings_.first.slots : 0;
  outcome.executed = {line, before};
  if (outcome.exact && closed_slot_ && !all_executed()) {
    outcome.executed.slots = std::max(before, std::int64_t{*closed_slot_});
  }
  outcome.sent_limit = outcome.exact ? std::max(line, settings_.first.line) : settings_.first.line + sent_lines();
  outcome.counts = counts();
  if (!outcome.ran) {
    outcome.ran = describe(outcome.ran.error(), outcome);
  }
  const std::string why = outcome.ran ? "every line of this part was executed" : outcome.ran.error().message;
  const AttemptState known = outcome.exact ? AttemptState::ended : AttemptState::lost;
  const Result<void> noted =
      journal_.ended(started_ ? known : AttemptState::prepared, outcome.executed, outcome.sent_limit, why);
  if (!noted && (outcome.ran || outcome.ran.error().message.find(noted.error().message) == std::string::npos)) {
    outcome.ran = Error{noted.error().code, (outcome.ran ? std::string() : why + "\n") + noted.error().message};
  }
  if (!out_of_reach_) {
    static_cast<void>(bring_to_rest());
  }
  return outcome;
}

Error PartRun::describe(const Error& cause, const PartOutcome& outcome) const {
  const Plan& plan = program_.header().plan;
  std::string text = cause.message;
  if (gate_closed_) {
    text += ": the gate is closed. ";
  } else if (settings_.timing.silence_seeds != 0) {
    text += fmt::format(": the board cannot be told to close its gate, it does so by itself within {:.3f} s. ",
                        seconds_of(settings_.timing.silence_seeds).count());
  } else {
    text += ": the board cannot be told to close its gate; switch the laser off. ";
  }
  if (!started_) {
    text += "Nothing was fired in this run";
  } else if (outcome.exact && outcome.executed == Place{}) {
    text += "Nothing was fired";
  } else if (outcome.exact) {
    text += fmt::format("Fired is all before {}", line_text(plan, outcome.executed.line));
    if (outcome.executed.slots != 0) {
      text += fmt::format(", and slots 0 to {} of that line", outcome.executed.slots - 1);
    }
  } else {
    text += fmt::format("Known to be fired is all before {}; what comes then, before {}, may have been",
                        line_text(plan, outcome.executed.line), line_text(plan, outcome.sent_limit));
  }
  return {cause.code, text + "; go on with --resume"};
}

std::int64_t PartRun::sent_lines() const {
  return (sent_bytes_ + settings_.frame_bytes - 1) / settings_.frame_bytes;
}

RunCounts PartRun::counts() const {
  const std::int64_t first = settings_.first.line;
  return {first + sent_bytes_ / settings_.frame_bytes, first + taken_, first + executed_ - settings_.skipped_lines,
          settings_.total_lines};
}

Acknowledged PartRun::acknowledged() const {
  const std::int64_t first = settings_.first.line;
  return {first + executed_, first + taken_, first + sent_lines(), 0};
}

}  // namespace gravure::session
