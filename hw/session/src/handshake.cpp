#include "gravure/session/handshake.hpp"

#include <fmt/format.h>

#include <string>

#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/frame.hpp"

namespace gravure::session {
namespace {

constexpr std::size_t kMostDescriptors = 64;
/// Seed clocks between the last byte of a frame and the first slot that may use it.
constexpr std::int64_t kParseSlack = 64;

Result<std::int64_t> read_within(DeviceLink& link, const fpga::Register& source, const fpga::RegisterRange& range) {
  GRAVURE_TRY(const std::uint32_t value, link.read_register(source.address));
  if (value < range.low || value > range.high) {
    return Error{ErrorCode::device, fmt::format("register {} reads {}: allowed is {} to {}; the board or the cable is "
                                                "not sound",
                                                source.name, value, range.low, range.high)};
  }
  return static_cast<std::int64_t>(value);
}

}  // namespace

Result<BoardInfo> shake_hands(DeviceLink& link) {
  GRAVURE_TRY(const std::uint32_t magic, link.read_register(fpga::kMagicRegister.address));
  if (magic != fpga::kMagicRegister.reset) {
    return Error{ErrorCode::device, fmt::format("{}: register magic reads 0x{:08x}, ours have 0x{:08x}: this is no "
                                                "gravure board, or it has not loaded its logic; switch it off and on",
                                                link.identity().place, magic, fpga::kMagicRegister.reset)};
  }
  BoardInfo board;
  GRAVURE_TRY(board.map_version, link.read_register(fpga::kVersionRegister.address));
  if (board.map_version != fpga::kVersionRegister.reset) {
    return Error{ErrorCode::version_mismatch,
                 fmt::format("the board has version {} of the register map, this program knows version {}: update {}",
                             board.map_version, fpga::kVersionRegister.reset,
                             board.map_version < fpga::kVersionRegister.reset ? "the board's logic" : "gravure")};
  }
  GRAVURE_TRY(const std::int64_t counter_bits, read_within(link, fpga::kCounterBitsRegister, fpga::kCounterBitsRange));
  GRAVURE_TRY(const std::int64_t fifo_bits, read_within(link, fpga::kFifoBitsRegister, fpga::kFifoBitsRange));
  GRAVURE_TRY(board.clock_multiplier, read_within(link, fpga::kClockMultiplierRegister, fpga::kClockMultiplierRange));
  board.counter_bits = static_cast<int>(counter_bits);
  board.fifo_bits = static_cast<int>(fifo_bits);
  for (std::size_t word = 0; word < kMostDescriptors; ++word) {
    GRAVURE_TRY(const std::uint32_t descriptor,
                link.read_register(static_cast<std::uint8_t>(fpga::kDescriptorRegister.address + word)));
    if (descriptor == 0) {
      break;
    }
    board.descriptors.push_back(descriptor);
  }
  return board;
}

Result<void> check_board(const BoardInfo& board, const DeviceSetup& setup) {
  std::string text;
  const auto refuse = [&text](const std::string& what) { text += (text.empty() ? "" : "\n") + what; };
  if (setup.clock_multiplier != board.clock_multiplier) {
    refuse(
        fmt::format("the program is planned for clock_multiplier = {}, this board has {}: set fpga.clock_multiplier "
                    "= {} and compile again",
                    setup.clock_multiplier, board.clock_multiplier, board.clock_multiplier));
  }
  if (setup.counter_bits != board.counter_bits) {
    refuse(
        fmt::format("the program is planned for counter_bits = {}, this board has {}: set fpga.counter_bits = {} "
                    "and compile again",
                    setup.counter_bits, board.counter_bits, board.counter_bits));
  }
  const std::int64_t bytes = (setup.window_slots + 7) / 8;
  const std::int64_t fifo = std::int64_t{1} << static_cast<unsigned>(board.fifo_bits);
  if (2 * bytes > fifo) {
    refuse(
        fmt::format("lines of {} pixels: two of them, {} bytes, must fit into this board's line FIFO of {} bytes: "
                    "at most {} pixels; use bands or a board with a larger FIFO",
                    setup.window_slots, 2 * bytes, fifo, fifo / 2 * 8));
  }
  const std::int64_t line_seeds = setup.slots_per_line * (setup.ticks_per_slot / setup.clock_multiplier);
  const std::int64_t frame = bytes + static_cast<std::int64_t>(protocol::kFrameBytes) + kParseSlack;
  if (frame > line_seeds) {
    refuse(fmt::format("lines of {} seed clocks: a frame takes {}; lengthen the line by scanner.turn_slots", line_seeds,
                       frame));
  }
  return text.empty() ? Result<void>() : Error{ErrorCode::device, text};
}

}  // namespace gravure::session
