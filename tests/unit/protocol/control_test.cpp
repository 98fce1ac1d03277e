#include "gravure/protocol/control.hpp"

#include <gtest/gtest.h>

#include "dice.hpp"
#include "gravure/protocol/status_message.hpp"
#include "worked_bytes.hpp"

namespace gravure::protocol {
namespace {

using test::Dice;

/// Setup stage and data as the page writes them; those that the board sends are given.
std::vector<std::byte> on_the_wire(const ControlPacket& packet, std::span<const std::byte> answer = {}) {
  const auto setup = encode_setup(packet.setup);
  std::vector<std::byte> bytes(setup.begin(), setup.end());
  bytes.insert(bytes.end(), packet.data.begin(), packet.data.end());
  bytes.insert(bytes.end(), answer.begin(), answer.end());
  return bytes;
}

TEST(Control, WritesTheWorkedBytesOfTheDocumentation) {
  EXPECT_EQ(on_the_wire(encode_control(ReadRegister{0x31}), encode_word(4321)), worked_bytes("read register 0x31"));
  EXPECT_EQ(on_the_wire(encode_control(WriteRegister{0x31, 4321})), worked_bytes("write register 0x31, 4321"));
  EXPECT_EQ(on_the_wire(encode_control(AskStatus{kProtocolVersion})), worked_bytes("ask status, version 1"));
}

TEST(Control, ReadsWhatItWrote) {
  Dice dice;
  SCOPED_TRACE(Dice::note());
  for (int trial = 0; trial < 300; ++trial) {
    const auto address = static_cast<std::uint8_t>(dice.word());
    const auto value = trial == 0 ? 0xFFFFFFFFU : static_cast<std::uint32_t>(dice.word());
    for (const ControlRequest& request :
         {ControlRequest(ReadRegister{address}), ControlRequest(WriteRegister{address, value}),
          ControlRequest(AskStatus{static_cast<std::uint16_t>(value)})}) {
      const ControlPacket packet = encode_control(request);
      EXPECT_EQ(decode_setup(encode_setup(packet.setup)), packet.setup);
      const auto again = decode_control(packet.setup, packet.data);
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_EQ(again.value(), request);
    }
    EXPECT_EQ(decode_word(encode_word(value)).value(), value);
  }
}

TEST(Control, RefusesARequestThatDiffersInOneField) {
  for (const ControlRequest& request :
       {ControlRequest(ReadRegister{1}), ControlRequest(WriteRegister{1, 2}), ControlRequest(AskStatus{1})}) {
    const ControlPacket right = encode_control(request);
    const auto refused = [&](auto change) {
      ControlPacket wrong = right;
      change(wrong);
      const auto read = decode_control(wrong.setup, wrong.data);
      EXPECT_FALSE(read && read.value() == request);
      return !read && read.error().code == ErrorCode::device;
    };
    EXPECT_TRUE(refused([](ControlPacket& packet) { packet.setup.request_type ^= 0x80U; }));  // the other direction
    EXPECT_TRUE(refused([](ControlPacket& packet) { packet.setup.request_type |= 1U; }));     // to the interface
    EXPECT_TRUE(refused([](ControlPacket& packet) { packet.setup.request += 100; }));
    EXPECT_TRUE(refused([](ControlPacket& packet) { packet.setup.index = 1; }));
    EXPECT_TRUE(refused([](ControlPacket& packet) { ++packet.setup.length; }));
  }
  EXPECT_FALSE(decode_control({0xC0, 1, 256, 0, 4}, {}));  // no such address
}

TEST(Control, RefusesAWordOfAnotherLength) {
  const std::vector<std::byte> data(5);
  for (const std::size_t length : {0U, 3U, 5U}) {
    EXPECT_FALSE(decode_word(std::span(data).first(length)));
    EXPECT_FALSE(decode_control(encode_control(WriteRegister{1, 2}).setup, std::span(data).first(length)));
  }
}

}  // namespace
}  // namespace gravure::protocol
