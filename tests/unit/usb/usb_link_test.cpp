#include "gravure/usb/usb_link.hpp"

#include "usb_fixture.hpp"

namespace gravure::usb {
namespace {

using UsbLink = UsbTest;

TEST_F(UsbLink, OpensTheOnlyBoardAndSaysWhichItIs) {
  FakeBoard& board = boards_.emplace_back();
  bus_->plug(board, {.serial = "A-17", .product = "engraver"});
  const auto link = open();
  ASSERT_TRUE(link);
  EXPECT_EQ(link->identity().serial, "A-17");
  EXPECT_EQ(link->identity().product, "engraver");
  EXPECT_EQ(link->identity().place, "bus 1, device 1");
  EXPECT_EQ(link->identity().protocol_version, protocol::kProtocolVersion);
  EXPECT_EQ(link->identity().link_bits_per_s, 13 * 512 * 8000 * std::int64_t{8});
}

TEST_F(UsbLink, AFullSpeedBusCarriesLess) {
  FakeBoard& board = boards_.emplace_back();
  bus_->plug(board, {.megabits_per_s = 12});
  const auto link = open();
  ASSERT_TRUE(link);
  EXPECT_EQ(link->identity().link_bits_per_s, 19 * 64 * 1000 * 8);
}

TEST_F(UsbLink, PicksTheBoardWithTheSerialNumber) {
  FakeBoard& first = boards_.emplace_back();
  FakeBoard& second = boards_.emplace_back();
  bus_->plug(first, {.serial = "one"});
  bus_->plug(second, {.serial = "two"});
  const auto link = open({.serial = "two"});
  ASSERT_TRUE(link);
  ASSERT_TRUE(link->write_register(7, 77));
  EXPECT_EQ(second.read_register(7).value(), 77U);
  EXPECT_EQ(first.read_register(7).value(), 0U);
  const auto none = open_usb_link({.serial = "three"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::device);
  EXPECT_TRUE(has(none.error().message, "\"three\"; on the bus: one, two"));
  const auto any = open_usb_link({});
  ASSERT_FALSE(any);
  EXPECT_TRUE(has(any.error().message, "2 boards on the bus; say which"));
}

TEST_F(UsbLink, SaysThatThereIsNoBoard) {
  FakeBoard& other = boards_.emplace_back();
  bus_->plug(other, {.vendor_id = 0x04A9});
  const auto link = open_usb_link({});
  ASSERT_FALSE(link);
  EXPECT_EQ(link.error().code, ErrorCode::device);
  EXPECT_TRUE(has(link.error().message, "no board (1209:0001) on the bus"));
}

TEST_F(UsbLink, RefusesOptionsOutOfRange) {
  for (const UsbOptions& options :
       {UsbOptions{.transfers = 0}, UsbOptions{.transfers = 65}, UsbOptions{.transfer_bytes = 0},
        UsbOptions{.transfer_bytes = (1U << 20U) + 1}, UsbOptions{.control_timeout = 0ms}}) {
    const auto link = open_usb_link(options);
    ASSERT_FALSE(link);
    EXPECT_EQ(link.error().code, ErrorCode::bad_argument);
  }
}

TEST_F(UsbLink, RefusesAnotherVersionOfTheProtocolAndNamesBoth) {
  FakeBoard& board = boards_.emplace_back();
  board.say([](BoardStatus& status) { status.protocol_version = 9; });
  bus_->plug(board);
  const auto link = open_usb_link({});
  ASSERT_FALSE(link);
  EXPECT_EQ(link.error().code, ErrorCode::version_mismatch);
  EXPECT_TRUE(has(link.error().message, "version 9") && has(link.error().message, "version 1")) << link.error().message;
}

TEST_F(UsbLink, OnlyOneHostHasTheBoard) {
  FakeBoard& board = boards_.emplace_back();
  bus_->plug(board);
  auto first = open();
  const auto second = open_usb_link({});
  ASSERT_FALSE(second);
  EXPECT_TRUE(has(second.error().message, "another program uses the board")) << second.error().message;
  first.reset();
  EXPECT_TRUE(open());
}

TEST_F(UsbLink, ReadsAndWritesRegisters) {
  FakeBoard& board = boards_.emplace_back();
  bus_->plug(board);
  const auto link = open();
  ASSERT_TRUE(link);
  EXPECT_EQ(link->read_register(0).value(), fpga::kMagicRegister.reset);
  ASSERT_TRUE(link->write_register(0x31, 0xFEDCBA98U));
  EXPECT_EQ(board.read_register(0x31).value(), 0xFEDCBA98U);
  EXPECT_EQ(link->read_register(0x31).value(), 0xFEDCBA98U);
  const auto refused = link->read_register(FakeBoard::kRefused);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::device);
  EXPECT_TRUE(has(refused.error().message, "reading register 0xff: the board refused")) << refused.error().message;
  EXPECT_TRUE(link->read_register(0));  // endpoint 0 goes on
}

TEST_F(UsbLink, TheStreamArrivesInOrderWhateverTheCut) {
  SCOPED_TRACE(test::Dice::note());
  FakeBoard& board = boards_.emplace_back();
  bus_->plug(board);
  const auto link = open({.transfers = 3, .transfer_bytes = 1000});
  ASSERT_TRUE(link);
  const auto stream = random_bytes(50'000);
  test::Dice dice(1);
  for (std::size_t at = 0; at < stream.size();) {
    const auto size = std::min<std::size_t>(stream.size() - at, static_cast<std::size_t>(dice.between(1, 5000)));
    const auto sent = link->send(std::span(stream).subspan(at, size), kLong);
    ASSERT_TRUE(sent) << sent.error().message;
    ASSERT_EQ(sent.value(), size);
    at += size;
  }
  EXPECT_TRUE(link->drain(kLong).value());
  EXPECT_EQ(board.taken(), stream);
}

TEST_F(UsbLink, AFullBoardTakesNoMoreAndGoesOnLater) {
  FakeBoard& board = boards_.emplace_back(10'000);
  bus_->plug(board);
  const auto link = open({.transfers = 2, .transfer_bytes = 4096});
  ASSERT_TRUE(link);
  const auto stream = random_bytes(40'000);
  // What the board has room for, and what the two buffers hold.
  const auto first = link->send(stream, 500ms);
  ASSERT_TRUE(first);
  EXPECT_GE(first.value(), 8192U);
  EXPECT_LE(first.value(), 10'000U + 2 * 4096U);
  EXPECT_FALSE(link->drain(50ms).value());
  EXPECT_EQ(link->send(std::span(stream).subspan(first.value()), 50ms).value(), 0U);
  EXPECT_EQ(board.taken().size(), 10'000U);
  board.free(40'000);
  for (std::size_t at = first.value(); at < stream.size();) {
    const auto sent = link->send(std::span(stream).subspan(at), 100ms);
    ASSERT_TRUE(sent);
    at += sent.value();
    board.free(40'000);
  }
  while (!link->drain(100ms).value()) {
    board.free(40'000);
  }
  EXPECT_EQ(board.taken(), stream);
}

TEST_F(UsbLink, WhatIsAbandonedDoesNotArrive) {
  FakeBoard& board = boards_.emplace_back(1000);
  bus_->plug(board);
  const auto link = open({.transfers = 4, .transfer_bytes = 600});
  ASSERT_TRUE(link);
  const auto stream = random_bytes(2400);
  ASSERT_EQ(link->send(stream, kLong).value(), stream.size());
  ASSERT_TRUE(link->abandon());
  EXPECT_TRUE(link->drain(0ms).value());
  board.free(5000);
  const auto after = random_bytes(10);
  ASSERT_EQ(link->send(after, kLong).value(), after.size());
  ASSERT_TRUE(link->drain(kLong).value());
  auto arrived = board.taken();
  ASSERT_EQ(arrived.size(), 1010U);
  EXPECT_TRUE(std::equal(after.begin(), after.end(), arrived.end() - 10));
}

TEST_F(UsbLink, GivesTheNewestStatusOnce) {
  FakeBoard& board = boards_.emplace_back();
  bus_->plug(board);
  const auto link = open();
  ASSERT_TRUE(link);
  for (std::uint32_t line = 1; line < 20; ++line) {
    board.say([&](BoardStatus& status) {
      status.state = BoardState::running;
      status.executed_lines = line;
    });
    const auto status = status_with(*link, [&](const BoardStatus& one) { return one.executed_lines == line; });
    ASSERT_TRUE(status);
    EXPECT_EQ(status->state, BoardState::running);
  }
}

TEST_F(UsbLink, EndsWithTransfersOnTheirWay) {
  for (int trial = 0; trial < 5; ++trial) {
    FakeBoard& board = boards_.emplace_back(100);
    auto& device = bus_->plug(board, {.serial = std::to_string(trial)});
    const auto link = open({.serial = std::to_string(trial), .transfers = 8, .transfer_bytes = 50});
    ASSERT_TRUE(link);
    EXPECT_GE(link->send(random_bytes(1000), 20ms).value(), 400U);
    device.unplug();
    EXPECT_TRUE(has(error_of(*link).message, "unplugged"));
  }
}

}  // namespace
}  // namespace gravure::usb
