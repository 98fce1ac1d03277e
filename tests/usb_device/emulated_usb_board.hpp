#pragma once

#include <utility>

#include "gravure/emulator/emulated_board.hpp"
#include "usb_board.hpp"

namespace gravure::test {

/// The emulated board behind the endpoints of a USB device.
class EmulatedUsbBoard final : public UsbBoard {
 public:
  explicit EmulatedUsbBoard(emulator::EmulatedBoard board) : board_(std::move(board)) {}

  Result<std::uint32_t> read_register(std::uint8_t address) override { return board_.read_register(address); }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    board_.write_register(address, value);
    return {};
  }
  std::size_t take(std::span<const std::byte> stream) override { return board_.take(stream); }
  void pass_time() override { board_.pass_time(); }
  BoardStatus status() override { return board_.status(); }

  emulator::EmulatedBoard& board() noexcept { return board_; }

 private:
  emulator::EmulatedBoard board_;
};

}  // namespace gravure::test
