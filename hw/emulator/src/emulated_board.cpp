#include "gravure/emulator/emulated_board.hpp"

#include <utility>

#include "board_machine.hpp"

namespace gravure::emulator {

EmulatedBoard::EmulatedBoard(BoardOptions options) : machine_(std::make_unique<Machine>(std::move(options))) {}
EmulatedBoard::EmulatedBoard(EmulatedBoard&& other) noexcept = default;
EmulatedBoard& EmulatedBoard::operator=(EmulatedBoard&& other) noexcept = default;
EmulatedBoard::~EmulatedBoard() = default;

std::uint32_t EmulatedBoard::read_register(std::uint8_t address) {
  return machine_->read_register(address);
}

void EmulatedBoard::write_register(std::uint8_t address, std::uint32_t value) {
  machine_->write_register(address, value);
}

std::size_t EmulatedBoard::take(std::span<const std::byte> stream) {
  return machine_->take(stream);
}

void EmulatedBoard::pass_time() {
  machine_->pass_time();
}

void EmulatedBoard::open_interlock() {
  machine_->open_interlock();
}

void EmulatedBoard::power_cycle() {
  BoardOptions options = machine_->options();
  ++options.power_up;
  machine_ = std::make_unique<Machine>(std::move(options));
}

BoardStatus EmulatedBoard::status() const {
  return machine_->status();
}

const BoardOptions& EmulatedBoard::options() const noexcept {
  return machine_->options();
}

}  // namespace gravure::emulator
