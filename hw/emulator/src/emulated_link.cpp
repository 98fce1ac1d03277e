#include "gravure/emulator/emulated_link.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "gravure/emulator/board_name.hpp"
#include "gravure/protocol/status_message.hpp"

namespace gravure::emulator {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kLook = std::chrono::milliseconds(1);  ///< how often to look at a board whose clock runs

constexpr int kDelayedCalls = 3;

bool says_the_same(BoardStatus one, const BoardStatus& other) {
  one.sequence = other.sequence;
  one.tick = other.tick;  // alone it is no news
  return protocol::encode_status(one) == protocol::encode_status(other);
}

}  // namespace

EmulatedLink::EmulatedLink(std::shared_ptr<EmulatedBoard> board)
    : board_(std::move(board)),
      identity_{.serial = board_->options().serial,
                .product = "emulated board",
                .place = board_->folder().empty() ? "this process" : board_->folder(),
                .protocol_version = protocol::kProtocolVersion},
      planned_(board_->options().faults) {
  const BoardState state = board_->status().state;
  if (state == BoardState::running || state == BoardState::filling) {
    board_->lose_host();  // the one it had before
  }
}

Result<std::unique_ptr<EmulatedLink>> EmulatedLink::open(std::string_view name) {
  GRAVURE_TRY(BoardName parsed, parse_board_name(name));
  GRAVURE_TRY(EmulatedBoard board, EmulatedBoard::open(parsed.folder, std::move(parsed.options)));
  return std::make_unique<EmulatedLink>(std::move(board));
}

Error EmulatedLink::fail(ErrorCode code, const std::string& what) {
  const Error error{code, "emulated board " + identity_.serial + " (" + identity_.place + "): " + what};
  failed_ = error;
  return error;
}

Result<void> EmulatedLink::check() {
  GRAVURE_CHECK(failed_);
  failed_ = board_->health();
  return failed_;
}

Result<std::uint32_t> EmulatedLink::read_register(std::uint8_t address) {
  GRAVURE_CHECK(check());
  if (dead_) {
    return fail(ErrorCode::timeout, "no answer when register " + std::to_string(address) + " was read");
  }
  return board_->read_register(address);
}

Result<void> EmulatedLink::write_register(std::uint8_t address, std::uint32_t value) {
  GRAVURE_CHECK(check());
  if (dead_) {
    return fail(ErrorCode::timeout, "no answer when register " + std::to_string(address) + " was written");
  }
  board_->write_register(address, value);
  return check();
}

/// The one that is planned for the byte that comes next.
Result<void> EmulatedLink::meet_fault() {
  const auto due = [this](WireFaultKind kind) { return planned_.at_byte(kind, 0, sent_ + 1).has_value(); };
  if (due(WireFaultKind::stall)) {
    return fail(ErrorCode::device, "the stream stalled at byte " + std::to_string(sent_));
  }
  if (due(WireFaultKind::disconnect)) {
    board_->lose_host();
    return fail(ErrorCode::device, "unplugged at byte " + std::to_string(sent_) + " of the stream");
  }
  dead_ = dead_ || due(WireFaultKind::timeout);
  static_cast<void>(due(WireFaultKind::short_take));  // the transfer before it was short
  delayed_ = due(WireFaultKind::delay) ? kDelayedCalls : delayed_;
  reorder_ = reorder_ || due(WireFaultKind::reorder);
  return {};
}

Result<std::size_t> EmulatedLink::send(std::span<const std::byte> stream, Milliseconds patience) {
  GRAVURE_CHECK(check());
  GRAVURE_CHECK(meet_fault());
  if (dead_ || stream.empty()) {
    return std::size_t{0};
  }
  for (const WireFaultKind kind : {WireFaultKind::stall, WireFaultKind::disconnect, WireFaultKind::timeout,
                                   WireFaultKind::short_take, WireFaultKind::delay, WireFaultKind::reorder}) {
    const std::int64_t before = planned_.first_byte(kind).value_or(sent_ + static_cast<std::int64_t>(stream.size()));
    stream = stream.first(std::min(stream.size(), static_cast<std::size_t>(before - sent_)));
  }
  const auto until = Clock::now() + patience;
  std::size_t taken = board_->take(stream);
  while (taken == 0 && Clock::now() < until) {
    board_->pass_time();
    taken = board_->take(stream);
    if (taken == 0 && board_->waits_for_host()) {
      break;
    }
    if (taken == 0) {
      std::this_thread::sleep_for(kLook);
    }
  }
  GRAVURE_CHECK(check());
  sent_ += static_cast<std::int64_t>(taken);
  return taken;
}

Result<bool> EmulatedLink::drain(Milliseconds /*patience*/) {
  GRAVURE_CHECK(check());
  return !dead_;  // what was taken is in the board
}

Result<void> EmulatedLink::abandon() {
  return check();
}

/// What the board says now, if it is another thing than it said last.
std::optional<BoardStatus> EmulatedLink::news() {
  board_->pass_time();
  BoardStatus now = board_->status();
  if (given_ && says_the_same(now, *given_)) {
    return std::nullopt;
  }
  now.sequence = sequence_++;
  given_ = now;
  return now;
}

/// Where that is planned, the status comes behind the one after it.
std::optional<BoardStatus> EmulatedLink::out_of_turn(BoardStatus status) {
  if (reorder_) {
    reorder_ = false;
    held_ = status;
    return std::nullopt;
  }
  return status;
}

Result<std::optional<BoardStatus>> EmulatedLink::next_status(Milliseconds patience) {
  const auto until = Clock::now() + patience;
  for (;;) {
    GRAVURE_CHECK(check());
    std::optional<BoardStatus> status = dead_ || delayed_ > 0 ? std::nullopt : news();
    GRAVURE_CHECK(check());
    delayed_ -= delayed_ > 0 ? 1 : 0;
    status = status ? out_of_turn(*status) : std::exchange(held_, std::nullopt);
    if (status || dead_ || board_->waits_for_host() || Clock::now() >= until) {
      return status;
    }
    std::this_thread::sleep_for(kLook);
  }
}

}  // namespace gravure::emulator
