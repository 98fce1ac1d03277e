#include "gravure/replay/replay_link.hpp"

#include <utility>

#include "gravure/core/crc32c.hpp"
#include "gravure/core/file_output.hpp"
#include "gravure/protocol/start_sequence.hpp"

namespace gravure::replay {
namespace {

bool is_keep_alive(const Exchange& one) {
  return one.request == Request::write && one.address == protocol::kKeepAlive.address &&
         one.value == protocol::kKeepAlive.value && !one.error;
}

}  // namespace

/// Statuses come when the board has something to say, whatever the host is at: what was recorded before the next
/// request is there by now.
void ReplayLink::pass_statuses() {
  for (; !at_end() && session_.exchanges[next_].request == Request::status && !session_.exchanges[next_].error;
       ++next_) {
    if (session_.exchanges[next_].status) {
      heard_ = session_.exchanges[next_].status;
    }
  }
}

Result<std::unique_ptr<ReplayLink>> ReplayLink::open(const std::string& path) {
  GRAVURE_TRY(const std::string text, read_file(path, kMostSessionBytes));
  GRAVURE_TRY(Session session, parse_session(text, path));
  return std::make_unique<ReplayLink>(std::move(session), path);
}

Result<const Exchange*> ReplayLink::answer(const Exchange& asked) {
  if (refused_) {
    return *refused_;
  }
  const std::string says = "the host says \"" + request_text(asked) + "\", ";
  pass_statuses();
  while (!at_end() && is_keep_alive(session_.exchanges[next_]) && !is_keep_alive(asked)) {
    ++next_;
    pass_statuses();
  }
  if (at_end()) {
    refused_ = Error{ErrorCode::device, name_ + ": " + says + "but the recorded session ends before"};
    return *refused_;
  }
  const Exchange& recorded = session_.exchanges[next_];
  if (request_text(recorded) != request_text(asked)) {
    refused_ = Error{ErrorCode::device, name_ + ", line " + std::to_string(recorded.line) + ": " + says +
                                            "but said \"" + request_text(recorded) + "\" when this was recorded"};
    return *refused_;
  }
  ++next_;
  if (recorded.error) {
    return *recorded.error;
  }
  return &recorded;
}

Result<std::uint32_t> ReplayLink::read_register(std::uint8_t address) {
  GRAVURE_TRY(const Exchange* recorded, answer({.request = Request::read, .address = address}));
  return recorded->value;
}

Result<void> ReplayLink::write_register(std::uint8_t address, std::uint32_t value) {
  const Exchange asked{.request = Request::write, .address = address, .value = value};
  if (is_keep_alive(asked) && !refused_ && (at_end() || !is_keep_alive(session_.exchanges[next_]))) {
    return {};
  }
  GRAVURE_CHECK(answer(asked));
  return {};
}

Result<std::size_t> ReplayLink::send(std::span<const std::byte> stream, Milliseconds /*patience*/) {
  GRAVURE_TRY(
      const Exchange* recorded,
      answer({.request = Request::send, .bytes = stream.size(), .checksum = ~crc32c_continue(kCrc32cStart, stream)}));
  return static_cast<std::size_t>(recorded->taken);
}

Result<bool> ReplayLink::drain(Milliseconds /*patience*/) {
  GRAVURE_TRY(const Exchange* recorded, answer({.request = Request::drain}));
  return recorded->drained;
}

Result<void> ReplayLink::abandon() {
  GRAVURE_CHECK(answer({.request = Request::abandon}));
  return {};
}

Result<std::optional<BoardStatus>> ReplayLink::next_status(Milliseconds /*patience*/) {
  if (refused_) {
    return *refused_;
  }
  if (heard_) {
    return std::exchange(heard_, std::nullopt);
  }
  if (at_end() || session_.exchanges[next_].request != Request::status) {
    return std::optional<BoardStatus>();
  }
  const Exchange& recorded = session_.exchanges[next_++];
  if (recorded.error) {
    return *recorded.error;
  }
  return recorded.status;
}

}  // namespace gravure::replay
