#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gravure/core/device_link.hpp"
#include "gravure/emulator/emulated_board.hpp"

namespace gravure::emulator {

/// The wire to an emulated board in this process. A host that waits for a status lets the board's time pass. Faults of
/// the link that BoardOptions::faults plan happen here, each at a byte of the stream counted from the link's begin.
class EmulatedLink final : public DeviceLink {
 public:
  explicit EmulatedLink(EmulatedBoard board) : EmulatedLink(std::make_shared<EmulatedBoard>(std::move(board))) {}
  /// A board that outlives the link. What it had to do for another host it does first; then it lacks that host.
  explicit EmulatedLink(std::shared_ptr<EmulatedBoard> board);
  /// The board of a name, "DIR[,key=value...]" (board_name.hpp). Errors of it and of EmulatedBoard::open().
  static Result<std::unique_ptr<EmulatedLink>> open(std::string_view name);

  const DeviceIdentity& identity() const noexcept override { return identity_; }
  Result<std::uint32_t> read_register(std::uint8_t address) override;
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override;
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override;
  Result<bool> drain(Milliseconds patience) override;
  Result<void> abandon() override;
  /// Once for each state the board is in; where its clock stands still, waiting brings nothing more.
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override;

  EmulatedBoard& board() noexcept { return *board_; }

 private:
  Result<void> check();
  Error fail(ErrorCode code, const std::string& what);
  Result<void> meet_fault();
  std::optional<BoardStatus> news();
  std::optional<BoardStatus> out_of_turn(BoardStatus status);

  std::shared_ptr<EmulatedBoard> board_;
  DeviceIdentity identity_;
  WireFaults planned_;
  Result<void> failed_;
  bool dead_ = false;  ///< takes nothing and says nothing, until the host notices
  std::int64_t sent_ = 0;
  std::optional<BoardStatus> given_;
  std::uint32_t sequence_ = 0;
  int delayed_ = 0;  ///< calls of next_status() that still get none
  bool reorder_ = false;
  std::optional<BoardStatus> held_;  ///< comes after the one that follows it
};

}  // namespace gravure::emulator
