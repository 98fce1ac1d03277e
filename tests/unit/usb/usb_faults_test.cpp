#include "usb_fixture.hpp"

namespace gravure::usb {
namespace {

using Kind = UsbFault::Kind;
using protocol::kStatusEndpoint;
using protocol::kStreamEndpoint;

/// Streams into a device whose wire breaks, to the error that the link ends with.
class UsbFaults : public UsbTest {
 protected:
  void SetUp() override {
    UsbTest::SetUp();
    device_ = &bus_->plug(board_, {.serial = "F"});
    link_ = open({.transfers = 4, .transfer_bytes = 512});
    ASSERT_TRUE(link_);
  }

  /// Sends `size` bytes as far as it goes, and waits for them.
  Result<void> stream(std::size_t size) {
    const auto bytes = random_bytes(size);
    GRAVURE_TRY(const std::size_t sent, link_->send(bytes, kLong));
    EXPECT_EQ(sent, size);
    GRAVURE_TRY(const bool drained, link_->drain(kLong));
    EXPECT_TRUE(drained);
    return {};
  }

  void expect_failure(ErrorCode code, const std::string& cause) {
    const Result<void> failed = stream(4096);
    const Error error = failed ? error_of(*link_) : failed.error();
    EXPECT_EQ(error.code, code) << error.message;
    EXPECT_TRUE(has(error.message, cause)) << error.message;
    EXPECT_EQ(device_->pending_faults(), 0U);
    EXPECT_FALSE(link_->send(random_bytes(1), 0ms));  // it goes on failing
    EXPECT_FALSE(link_->drain(0ms));
    EXPECT_FALSE(link_->abandon());
    EXPECT_FALSE(link_->read_register(0));
    const bool there = cause.find("unplugged") == std::string::npos;
    EXPECT_EQ(static_cast<bool>(link_->write_register(1, 1)), there) << "the word that closes the gate";
  }

  /// The same board works again.
  void expect_recovery() {
    link_.reset();
    link_ = open({.transfers = 4, .transfer_bytes = 512});
    ASSERT_TRUE(link_);
    const std::size_t before = board_.taken().size();
    EXPECT_TRUE(stream(5000));
    EXPECT_EQ(board_.taken().size(), before + 5000);
    EXPECT_TRUE(link_->next_status(kLong).value());
  }

  FakeBoard& board_ = boards_.emplace_back();
  MockBus::Device* device_ = nullptr;
  std::unique_ptr<DeviceLink> link_;
};

TEST_F(UsbFaults, AStallOfTheStreamIsNamedWithWhatArrived) {
  device_->inject(kStreamEndpoint, {.kind = Kind::stall, .skip = 2, .bytes = 100});
  expect_failure(ErrorCode::device,
                 "sending the stream (endpoint 1, the board took 100 of 512 bytes): the board refused");
  EXPECT_EQ(board_.taken().size(), 2 * 512U + 100U);
  expect_recovery();
}

TEST_F(UsbFaults, AStallOfTheStatusIsNamed) {
  device_->inject(kStatusEndpoint, {.kind = Kind::stall});
  board_.say([](BoardStatus& status) { ++status.line; });
  expect_failure(ErrorCode::device,
                 "waiting for a status message (endpoint 129, the board sent 0 of 64 bytes): the board refused");
  expect_recovery();
}

TEST_F(UsbFaults, AShortTransferOfTheStreamIsNamed) {
  device_->inject(kStreamEndpoint, {.kind = Kind::cut_short, .skip = 1, .bytes = 511});
  expect_failure(ErrorCode::device, "took 511 of 512 bytes): short transfer");
  expect_recovery();
}

TEST_F(UsbFaults, AShortStatusIsNamed) {
  device_->inject(kStatusEndpoint, {.kind = Kind::cut_short, .bytes = 63});
  expect_failure(ErrorCode::device, "status message: 63 bytes, must be 64");
  expect_recovery();
}

TEST_F(UsbFaults, ACorruptStatusIsNamed) {
  device_->inject(kStatusEndpoint, {.kind = Kind::corrupt, .bytes = 20});
  expect_failure(ErrorCode::device, "status message: its checksum is wrong");
  expect_recovery();
}

TEST_F(UsbFaults, BabbleIsNamed) {
  device_->inject(kStatusEndpoint, {.kind = Kind::babble});
  expect_failure(ErrorCode::device, "sent more than it was asked for (babble)");
  expect_recovery();
}

TEST_F(UsbFaults, ABusErrorIsNamed) {
  device_->inject(kStreamEndpoint, {.kind = Kind::bus_error, .skip = 3, .bytes = 64});
  expect_failure(ErrorCode::device, "took 64 of 512 bytes): bus error");
  expect_recovery();
}

TEST_F(UsbFaults, ATransferTheSystemRefusesIsNamed) {
  device_->inject(kStreamEndpoint, {.kind = Kind::refuse, .skip = 3});
  expect_failure(ErrorCode::io, "no memory for USB transfers");
  expect_recovery();
}

TEST_F(UsbFaults, ABoardThatTakesNothingMoreIsSeenByPatience) {
  device_->inject(kStreamEndpoint, {.kind = Kind::never, .skip = 1});
  const auto bytes = random_bytes(10'000);
  const auto sent = link_->send(bytes, 200ms);
  ASSERT_TRUE(sent);
  EXPECT_EQ(sent.value(), 5 * 512U);  // one that arrived, four that wait
  EXPECT_FALSE(link_->drain(50ms).value());
  EXPECT_EQ(link_->send(bytes, 50ms).value(), 0U);
  EXPECT_TRUE(link_->abandon());
  expect_recovery();
}

TEST_F(UsbFaults, ARegisterThatIsNotAnsweredTimesOut) {
  link_.reset();
  link_ = open({.control_timeout = 300ms});
  ASSERT_TRUE(link_);
  device_->inject(0, {.kind = Kind::never});
  const auto read = link_->read_register(3);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::timeout);
  EXPECT_TRUE(has(read.error().message, "reading register 0x03: no answer in time")) << read.error().message;
  device_->inject(0, {.kind = Kind::cut_short, .bytes = 3});
  const auto cut = link_->read_register(3);
  ASSERT_FALSE(cut);
  EXPECT_TRUE(has(cut.error().message, "a word of 3 bytes")) << cut.error().message;
  EXPECT_TRUE(link_->read_register(3));
}

TEST_F(UsbFaults, DelayedAndReorderedCompletionsChangeNothing) {
  for (std::size_t skip = 0; skip < 12; skip += 3) {
    device_->inject(kStreamEndpoint, {.kind = Kind::delay, .skip = 2, .delay = 20ms});
    device_->inject(kStreamEndpoint, {.kind = Kind::hold, .skip = 1, .transfers = 2});
    device_->inject(kStatusEndpoint, {.kind = Kind::delay, .delay = 20ms});
    device_->inject(kStatusEndpoint, {.kind = Kind::hold, .transfers = 1});
  }
  const auto bytes = random_bytes(40'000);
  for (std::size_t at = 0; at < bytes.size();) {
    const auto sent = link_->send(std::span(bytes).subspan(at, 4000), kLong);
    ASSERT_TRUE(sent) << sent.error().message;
    at += sent.value();
  }
  ASSERT_TRUE(link_->drain(kLong).value());
  EXPECT_EQ(board_.taken(), bytes);
}

TEST_F(UsbFaults, AnOlderStatusThatComesLateIsDropped) {
  device_->inject(kStatusEndpoint, {.kind = Kind::hold, .transfers = 1});
  std::uint32_t last = 0;
  for (std::uint32_t line = 1; line <= 10; ++line) {
    board_.say([&](BoardStatus& status) { status.executed_lines = line; });
    const auto status = link_->next_status(kLong);
    ASSERT_TRUE(status && status.value());
    EXPECT_GE(status.value()->executed_lines, last);
    last = status.value()->executed_lines;
  }
}

TEST_F(UsbFaults, AStatusThatIsLostShowsInTheSequence) {
  ASSERT_TRUE(link_->next_status(kLong).value());
  device_->inject(kStatusEndpoint, {.kind = Kind::lose});
  std::optional<std::uint32_t> before;
  bool gap = false;
  for (std::uint32_t line = 1; line <= 6; ++line) {
    board_.say([&](BoardStatus& status) { status.line = line; });
    const auto status = link_->next_status(kLong);
    ASSERT_TRUE(status && status.value());
    gap = gap || (before && status.value()->sequence > *before + 1);
    before = status.value()->sequence;
  }
  EXPECT_TRUE(gap);
}

TEST_F(UsbFaults, UnpluggedAtAnyPointIsNamedAndTheBoardHasAPrefix) {
  link_.reset();
  const std::size_t length = 4096;
  for (std::size_t point = 0; point < 20; ++point) {
    FakeBoard& board = boards_.emplace_back();
    const std::string serial = "U" + std::to_string(point);
    auto& device = bus_->plug(board, {.serial = serial});
    auto link = open({.serial = serial, .transfers = 4, .transfer_bytes = 512});
    ASSERT_TRUE(link);
    device.inject(kStreamEndpoint, {.kind = Kind::unplug, .skip = point * 8 / 20, .bytes = point * 397 % 513});
    const auto bytes = random_bytes(length);
    static_cast<void>(link->send(bytes, kLong));
    const Error error = error_of(*link);
    EXPECT_EQ(error.code, ErrorCode::device);
    EXPECT_TRUE(has(error.message, "unplugged")) << error.message;
    const auto taken = board.taken();
    EXPECT_EQ(taken.size(), point * 8 / 20 * 512 + point * 397 % 513);
    EXPECT_TRUE(std::equal(taken.begin(), taken.end(), bytes.begin()));
  }
}

TEST_F(UsbFaults, UnpluggedBetweenRequestsIsNamed) {
  device_->inject(0, {.kind = Kind::unplug});
  const auto read = link_->read_register(0);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::device);
  EXPECT_TRUE(has(read.error().message, "unplugged")) << read.error().message;
}

TEST_F(UsbFaults, PluggedInAgainItWorks) {
  device_->unplug();
  EXPECT_TRUE(has(error_of(*link_).message, "unplugged"));
  link_.reset();
  device_ = &bus_->plug(board_, {.serial = "F"});
  expect_recovery();
}

}  // namespace
}  // namespace gravure::usb
