#include "gravure/usb/boards.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "usb_fixture.hpp"

namespace gravure::usb {
namespace {

using Boards = UsbTest;

/// As another user, where this one may do everything.
class Unprivileged {
 public:
  Unprivileged() : was_(geteuid()) {
    constexpr uid_t kNobody = 65534;
    changed_ = was_ == 0 && seteuid(kNobody) == 0;
  }
  ~Unprivileged() {
    if (changed_ && seteuid(was_) != 0) {
      std::abort();
    }
  }
  Unprivileged(const Unprivileged&) = delete;
  Unprivileged& operator=(const Unprivileged&) = delete;

 private:
  uid_t was_;
  bool changed_ = false;
};

TEST_F(Boards, AnEmptyBusHasNone) {
  const auto boards = list_boards();
  ASSERT_TRUE(boards) << boards.error().message;
  EXPECT_TRUE(boards.value().empty());
}

TEST_F(Boards, EachIsListedWithItsState) {
  FakeBoard& idle = boards_.emplace_back();
  FakeBoard& other = boards_.emplace_back();
  FakeBoard& stopped = boards_.emplace_back();
  stopped.say([](BoardStatus& status) {
    status.state = BoardState::stopped;
    status.fault = DeviceFault::underrun;
  });
  bus_->plug(idle, {.serial = "I"});
  bus_->plug(other, {.vendor_id = 0x1234});
  bus_->plug(stopped, {.serial = "S", .product = "second"});
  const auto boards = list_boards();
  ASSERT_TRUE(boards) << boards.error().message;
  ASSERT_EQ(boards.value().size(), 2U);
  const BoardReport& first = boards.value()[0];
  EXPECT_EQ(first.identity.serial, "I");
  EXPECT_EQ(first.identity.place, "bus 1, device 1");
  EXPECT_EQ(first.identity.protocol_version, protocol::kProtocolVersion);
  EXPECT_EQ(first.register_map, fpga::kVersionRegister.reset);
  EXPECT_EQ(first.problem, "");
  ASSERT_TRUE(first.status);
  EXPECT_EQ(first.status->state, BoardState::idle);
  const BoardReport& second = boards.value()[1];
  EXPECT_EQ(second.identity.product, "second");
  ASSERT_TRUE(second.status);
  EXPECT_EQ(second.status->fault, DeviceFault::underrun);
}

TEST_F(Boards, OneThatIsUsedStillSaysItsState) {
  FakeBoard& board = boards_.emplace_back();
  bus_->plug(board, {.serial = "U"});
  const auto link = open();
  ASSERT_TRUE(link);
  board.say([](BoardStatus& status) { status.state = BoardState::running; });
  const auto boards = list_boards();
  ASSERT_TRUE(boards && boards.value().size() == 1);
  const BoardReport& report = boards.value()[0];
  EXPECT_EQ(report.identity.serial, "U");
  EXPECT_TRUE(has(report.problem, "another program uses the board")) << report.problem;
  ASSERT_TRUE(report.status);
  EXPECT_EQ(report.status->state, BoardState::running);
  ASSERT_EQ(link->send(random_bytes(100), kLong).value(), 100U);  // undisturbed
  EXPECT_TRUE(link->drain(kLong).value());
}

TEST_F(Boards, OtherVersionsAreNamedBesideOurs) {
  FakeBoard& protocol = boards_.emplace_back();
  FakeBoard& registers = boards_.emplace_back();
  FakeBoard& stranger = boards_.emplace_back();
  protocol.say([](BoardStatus& status) { status.protocol_version = 2; });
  registers.set(fpga::kVersionRegister.address, 1);
  stranger.set(fpga::kMagicRegister.address, 5);
  bus_->plug(protocol);
  bus_->plug(registers);
  bus_->plug(stranger);
  const auto boards = list_boards();
  ASSERT_TRUE(boards && boards.value().size() == 3);
  EXPECT_TRUE(has(boards.value()[0].problem, "version 2 of the protocol, this program version 1"));
  EXPECT_TRUE(has(boards.value()[1].problem, "version 1 of the register map, this program version " +
                                                 std::to_string(fpga::kVersionRegister.reset)));
  EXPECT_TRUE(has(boards.value()[2].problem, "none of our boards"));
}

TEST_F(Boards, OneThatMayNotBeOpenedNamesTheRuleToInstall) {
  FakeBoard& board = boards_.emplace_back();
  const auto& device = bus_->plug(board);
  std::filesystem::permissions(bus_->root(), std::filesystem::perms::all);
  // The library below asks its own way before it looks at the node.
  std::filesystem::permissions(bus_->root() + "/ioctl/dev/bus/usb/001/001", std::filesystem::perms::all);
  ASSERT_EQ(chmod(device.node_path().c_str(), 0), 0);
  const Unprivileged user;
  if (geteuid() == 0) {
    GTEST_SKIP() << "this user may open everything and cannot become another one";
  }
  const auto boards = list_boards();
  ASSERT_TRUE(boards && boards.value().size() == 1);
  EXPECT_TRUE(has(boards.value()[0].problem, "permission denied")) << boards.value()[0].problem;
  EXPECT_TRUE(has(boards.value()[0].problem, "70-gravure.rules"));
  EXPECT_FALSE(boards.value()[0].status);
  const auto link = open_usb_link({});
  ASSERT_FALSE(link);
  EXPECT_TRUE(has(link.error().message, "70-gravure.rules")) << link.error().message;
}

TEST_F(Boards, WaitsUntilTheRightOneArrives) {
  FakeBoard& board = boards_.emplace_back();
  FakeBoard& other = boards_.emplace_back();
  EXPECT_FALSE(wait_for_board("", 0ms).value());
  bus_->plug(other, {.serial = "other"});
  EXPECT_TRUE(wait_for_board("", kLong).value());  // is there already
  EXPECT_FALSE(wait_for_board("late", 150ms).value());
  std::thread later([&] {
    std::this_thread::sleep_for(150ms);
    bus_->plug(board, {.serial = "late"});
  });
  EXPECT_TRUE(wait_for_board("late", kLong).value());
  later.join();
  EXPECT_TRUE(open({.serial = "late"}));
}

TEST_F(Boards, WaitingStopsOnRequest) {
  const auto waited = wait_for_board("", kLong, [] { return true; });
  ASSERT_FALSE(waited);
  EXPECT_EQ(waited.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace gravure::usb
