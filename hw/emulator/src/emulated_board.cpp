#include "gravure/emulator/emulated_board.hpp"

#include <utility>

#include "board_front.hpp"

namespace gravure::emulator {

EmulatedBoard::EmulatedBoard(BoardOptions options)
    : front_(std::make_unique<Front>(Front::filled_in(std::move(options), ""))) {}
EmulatedBoard::EmulatedBoard(std::unique_ptr<Front> front) : front_(std::move(front)) {}
EmulatedBoard::EmulatedBoard(EmulatedBoard&& other) noexcept = default;
EmulatedBoard& EmulatedBoard::operator=(EmulatedBoard&& other) noexcept = default;
EmulatedBoard::~EmulatedBoard() = default;

Result<EmulatedBoard> EmulatedBoard::open(const std::string& folder, BoardOptions options) {
  GRAVURE_TRY(std::unique_ptr<Front> front, Front::open(folder, std::move(options)));
  return EmulatedBoard(std::move(front));
}

std::uint32_t EmulatedBoard::read_register(std::uint8_t address) {
  return front_->read_register(address);
}

void EmulatedBoard::write_register(std::uint8_t address, std::uint32_t value) {
  front_->write_register(address, value);
}

std::size_t EmulatedBoard::take(std::span<const std::byte> stream) {
  return front_->take(stream);
}

void EmulatedBoard::pass_time() {
  front_->pass_time();
}

void EmulatedBoard::open_interlock() {
  front_->happens(BoardEvent::interlock);
}

void EmulatedBoard::power_cycle() {
  front_->power_cycle();
}

void EmulatedBoard::lose_host() {
  front_->happens(BoardEvent::gone);
}

BoardStatus EmulatedBoard::status() const {
  return front_->status();
}

const BoardOptions& EmulatedBoard::options() const noexcept {
  return front_->options();
}

const std::string& EmulatedBoard::folder() const noexcept {
  return front_->folder();
}

const Result<void>& EmulatedBoard::health() const noexcept {
  return front_->health();
}

}  // namespace gravure::emulator
