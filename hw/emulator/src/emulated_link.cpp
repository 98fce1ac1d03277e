#include "gravure/emulator/emulated_link.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include "gravure/protocol/status_message.hpp"

namespace gravure::emulator {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kLook = std::chrono::milliseconds(1);  ///< how often to look at a board whose clock runs

bool says_the_same(BoardStatus one, const BoardStatus& other) {
  one.sequence = other.sequence;
  one.tick = other.tick;  // alone it is no news
  return protocol::encode_status(one) == protocol::encode_status(other);
}

}  // namespace

EmulatedLink::EmulatedLink(EmulatedBoard board)
    : board_(std::move(board)),
      identity_{.serial = board_.options().serial,
                .product = "emulated board",
                .place = "this process",
                .protocol_version = protocol::kProtocolVersion} {}

Result<std::uint32_t> EmulatedLink::read_register(std::uint8_t address) {
  return board_.read_register(address);
}

Result<void> EmulatedLink::write_register(std::uint8_t address, std::uint32_t value) {
  board_.write_register(address, value);
  return {};
}

Result<std::size_t> EmulatedLink::send(std::span<const std::byte> stream, Milliseconds patience) {
  const auto until = Clock::now() + patience;
  std::size_t taken = board_.take(stream);
  while (taken == 0 && !stream.empty() && Clock::now() < until) {
    board_.pass_time();
    taken = board_.take(stream);
    if (taken == 0 && board_.waits_for_host()) {
      break;
    }
    if (taken == 0) {
      std::this_thread::sleep_for(kLook);
    }
  }
  return taken;
}

Result<bool> EmulatedLink::drain(Milliseconds /*patience*/) {
  return true;  // what was taken is in the board
}

Result<void> EmulatedLink::abandon() {
  return {};
}

Result<std::optional<BoardStatus>> EmulatedLink::next_status(Milliseconds patience) {
  const auto until = Clock::now() + patience;
  for (;;) {
    board_.pass_time();
    BoardStatus now = board_.status();
    if (!given_ || !says_the_same(now, *given_)) {
      now.sequence = given_ ? given_->sequence + 1 : 0;
      given_ = now;
      return given_;
    }
    if (board_.waits_for_host() || Clock::now() >= until) {
      return std::optional<BoardStatus>();
    }
    std::this_thread::sleep_for(kLook);
  }
}

}  // namespace gravure::emulator
