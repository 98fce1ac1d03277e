#pragma once

#include "gravure/core/device_link.hpp"
#include "gravure/emulator/emulated_board.hpp"

namespace gravure::emulator {

/// The wire to an emulated board in this process. A host that waits for a status lets the board's time pass.
class EmulatedLink final : public DeviceLink {
 public:
  explicit EmulatedLink(EmulatedBoard board);

  const DeviceIdentity& identity() const noexcept override { return identity_; }
  Result<std::uint32_t> read_register(std::uint8_t address) override;
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override;
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override;
  Result<bool> drain(Milliseconds patience) override;
  Result<void> abandon() override;
  /// At once, and once in each state the board is in: where its clock stands still, waiting brings nothing more.
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override;

  EmulatedBoard& board() noexcept { return board_; }

 private:
  EmulatedBoard board_;
  DeviceIdentity identity_;
  std::optional<BoardStatus> given_;
};

}  // namespace gravure::emulator
