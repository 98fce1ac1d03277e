#include "gravure/protocol/status_message.hpp"

#include <gtest/gtest.h>

#include "dice.hpp"
#include "gravure/core/crc32c.hpp"
#include "worked_bytes.hpp"

namespace gravure::protocol {
namespace {

using test::Dice;

BoardStatus worked_status() {
  BoardStatus status;
  status.protocol_version = 1;
  status.state = BoardState::stopped;
  status.fault = DeviceFault::interlock;
  status.faults = 0x20;
  status.gate_dark = true;
  status.partial_line = true;
  status.sequence = 7;
  status.power_up = 5;
  status.tick = 660'864'000;
  status.revolution = 1;
  status.line = 64;
  status.taken_lines = 4002;
  status.executed_lines = 4000;
  status.closed_slot = 1234;
  status.level_bytes = 2048;
  status.capacity_bytes = 1U << 20U;
  return status;
}

/// With a checksum that fits again.
std::vector<std::byte> sealed(std::vector<std::byte> message) {
  const std::uint32_t crc = ~crc32c_continue(kCrc32cStart, std::span(message).first(kStatusBytes - 4));
  for (unsigned i = 0; i < 4; ++i) {
    message[kStatusBytes - 4 + i] = static_cast<std::byte>(crc >> (8 * i));
  }
  return message;
}

std::vector<std::byte> bytes_of(const BoardStatus& status) {
  const auto message = encode_status(status);
  return {message.begin(), message.end()};
}

TEST(StatusMessage, WritesTheWorkedBytesOfTheDocumentation) {
  EXPECT_EQ(bytes_of(worked_status()), worked_bytes("status"));
}

TEST(StatusMessage, ReadsWhatItWrote) {
  Dice dice;
  SCOPED_TRACE(Dice::note());
  for (int trial = 0; trial < 300; ++trial) {
    BoardStatus status = worked_status();
    const auto word = [&] { return trial == 0 ? 0xFFFFFFFFU : static_cast<std::uint32_t>(dice.word()); };
    status.state = static_cast<BoardState>(dice.between(0, 3));
    status.fault = static_cast<DeviceFault>(dice.between(0, 6));
    status.faults = static_cast<std::uint8_t>(word());
    status.gate_dark = dice.coin();
    status.partial_line = dice.coin();
    status.power_up = trial == 0 ? ~std::uint64_t{0} : dice.word();
    status.tick = trial == 0 ? ~std::uint64_t{0} : dice.word();
    for (std::uint32_t* field :
         {&status.sequence, &status.revolution, &status.line, &status.taken_lines, &status.executed_lines,
          &status.closed_slot, &status.level_bytes, &status.capacity_bytes}) {
      *field = word();
    }
    const auto again = decode_status(encode_status(status));
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again.value().power_up, status.power_up);
    EXPECT_EQ(again.value().tick, status.tick);
    EXPECT_EQ(again.value().gate_dark, status.gate_dark);
    EXPECT_EQ(again.value().partial_line, status.partial_line);
    EXPECT_EQ(bytes_of(again.value()), bytes_of(status));  // the other fields, by the bytes they make
  }
}

TEST(StatusMessage, AnotherVersionIsNamedBesideOurs) {
  for (const std::uint16_t version : {std::uint16_t{0}, std::uint16_t{2}, std::uint16_t{0xFFFF}}) {
    BoardStatus status = worked_status();
    status.protocol_version = version;
    auto message = bytes_of(status);
    message[20] ^= std::byte{1};  // whatever else that version has changed
    const auto read = decode_status(message);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::version_mismatch);
    EXPECT_NE(read.error().message.find("speaks version " + std::to_string(version) + " "), std::string::npos);
    EXPECT_NE(read.error().message.find("this program version 1:"), std::string::npos);
  }
}

TEST(StatusMessage, EveryFlippedBitIsSeen) {
  const std::vector<std::byte> right = bytes_of(worked_status());
  for (std::size_t bit = 0; bit < 8 * right.size(); ++bit) {
    std::vector<std::byte> wrong = right;
    wrong[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_FALSE(decode_status(wrong)) << "bit " << bit;
  }
}

TEST(StatusMessage, RefusesAnotherLengthAndNumbersThatAreNotKnown) {
  std::vector<std::byte> message = bytes_of(worked_status());
  message.resize(kStatusBytes + 1);
  for (const std::size_t length : {std::size_t{0}, kStatusBytes - 1, kStatusBytes + 1}) {
    const auto read = decode_status(std::span(message).first(length));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::device);
    EXPECT_NE(read.error().message.find(std::to_string(length) + " bytes, must be 64"), std::string::npos);
  }
  message.resize(kStatusBytes);
  const std::size_t state_at = 6;
  const std::size_t fault_at = 7;
  for (const auto& [place, value] : {std::pair(state_at, 4), std::pair(fault_at, 7)}) {
    std::vector<std::byte> wrong = message;
    wrong[place] = static_cast<std::byte>(value);
    const auto read = decode_status(sealed(wrong));
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("not known"), std::string::npos);
  }
}

}  // namespace
}  // namespace gravure::protocol
