#pragma once

#include <memory>
#include <string>

#include "gravure/core/device_link.hpp"
#include "gravure/replay/session_text.hpp"

namespace gravure::replay {

/// Answers a host as a board once did. A host that says anything else gets a device error with the line of the file,
/// and nothing more from then on. How often a host asked for a status is its own affair: it gets those that had come by
/// then, none when it asks more often. Waits for nothing.
class ReplayLink final : public DeviceLink {
 public:
  ReplayLink(Session session, std::string name) : session_(std::move(session)), name_(std::move(name)) {}
  /// Errors as of read_file() and parse_session().
  static Result<std::unique_ptr<ReplayLink>> open(const std::string& path);

  const DeviceIdentity& identity() const noexcept override { return session_.identity; }
  Result<std::uint32_t> read_register(std::uint8_t address) override;
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override;
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override;
  Result<bool> drain(Milliseconds patience) override;
  Result<void> abandon() override;
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override;

  /// All of the session has been played.
  bool at_end() const noexcept { return next_ == session_.exchanges.size(); }

 private:
  /// The next exchange, where the request is the same; its error, where it has one.
  Result<const Exchange*> answer(const Exchange& asked);
  void pass_statuses();

  Session session_;
  std::string name_;
  std::size_t next_ = 0;
  std::optional<BoardStatus> heard_;  ///< the newest that came before what the host said last
  std::optional<Error> refused_;
};

}  // namespace gravure::replay
