#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "fake_board.hpp"
#include "gravure/protocol/start_sequence.hpp"
#include "gravure/replay/recording_link.hpp"
#include "gravure/replay/replay_link.hpp"

namespace gravure::replay {
namespace {

using namespace std::chrono_literals;
using test::FakeBoard;

/// A board without a wire.
class DirectLink final : public DeviceLink {
 public:
  explicit DirectLink(FakeBoard& board) : board_(board) { identity_.serial = "direct"; }
  const DeviceIdentity& identity() const noexcept override { return identity_; }
  Result<std::uint32_t> read_register(std::uint8_t address) override { return board_.read_register(address); }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    return board_.write_register(address, value);
  }
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds) override { return board_.take(stream); }
  Result<bool> drain(Milliseconds) override { return true; }
  Result<void> abandon() override { return {}; }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override {
    return patience.count() == 0 ? std::optional<BoardStatus>() : std::optional(board_.status());
  }

 private:
  FakeBoard& board_;
  DeviceIdentity identity_;
};

class Replay : public testing::Test {
 protected:
  Replay() : folder_(std::filesystem::temp_directory_path() / ("gravure_replay_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "session.txt").string();
  }
  ~Replay() override { std::filesystem::remove_all(folder_); }

  /// What a host says, and what it hears, as text.
  static std::string talk(DeviceLink& link) {
    std::string heard;
    const auto hear = [&](const auto& result) { heard += result ? "ok " : result.error().message + " "; };
    const auto magic = link.read_register(0);
    hear(magic);
    heard += magic ? std::to_string(magic.value()) : "";
    hear(link.write_register(7, 70));
    hear(link.read_register(FakeBoard::kRefused));
    const std::vector<std::byte> stream(100, std::byte{3});
    heard += std::to_string(link.send(stream, 1ms).value()) + " ";
    heard += std::to_string(link.send(stream, 1ms).value()) + " ";
    hear(link.drain(1ms));
    hear(link.abandon());
    heard += link.next_status(0ms).value() ? "status " : "none ";
    heard += std::to_string(link.next_status(1ms).value()->level_bytes);
    return heard;
  }

  std::filesystem::path folder_;
  std::string path_;
};

TEST_F(Replay, AHostThatSaysTheSameHearsTheSame) {
  FakeBoard board(150);
  auto recording = RecordingLink::create(std::make_unique<DirectLink>(board), path_);
  ASSERT_TRUE(recording) << recording.error().message;
  const std::string heard = talk(*recording.value());
  ASSERT_TRUE(recording.value()->written());
  EXPECT_NE(heard.find("100 50 "), std::string::npos) << heard;
  const auto replay = ReplayLink::open(path_);  // while it is still open: every line is there
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_EQ(replay.value()->identity().serial, "direct");
  EXPECT_EQ(talk(*replay.value()), heard);
  EXPECT_TRUE(replay.value()->at_end());
  const auto more = replay.value()->read_register(0);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, ErrorCode::device);
  EXPECT_NE(more.error().message.find("\"read 0x00\", but the recorded session ends"), std::string::npos);
}

TEST_F(Replay, AHostThatSaysSomethingElseIsToldWhereAndHearsNothingMore) {
  const auto session = parse_session(head_text({}) + "read 0x01 -> 0x00000003\nwrite 0x02 = 0x00000005 -> done\n", "s");
  ASSERT_TRUE(session) << session.error().message;
  const std::vector<std::byte> stream(4);
  const std::vector<std::function<bool(DeviceLink&)>> others{
      [](DeviceLink& link) { return bool(link.write_register(2, 6)); },
      [](DeviceLink& link) { return bool(link.write_register(3, 5)); },
      [](DeviceLink& link) { return bool(link.read_register(2)); },
      [&](DeviceLink& link) { return bool(link.send(stream, 0ms)); },
      [](DeviceLink& link) { return bool(link.drain(0ms)); },
      [](DeviceLink& link) { return bool(link.abandon()); }};
  for (const auto& other : others) {
    ReplayLink link(session.value(), "s.txt");
    EXPECT_EQ(link.read_register(1).value(), 3U);
    EXPECT_FALSE(other(link));
    const auto late = link.write_register(2, 5);
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, ErrorCode::device);
    EXPECT_NE(late.error().message.find("s.txt, line 8: the host says "), std::string::npos) << late.error().message;
    EXPECT_NE(late.error().message.find("but said \"write 0x02 = 0x00000005\""), std::string::npos);
  }
}

TEST_F(Replay, AHostThatAsksForStatusesMoreOrLessOftenHearsTheNewest) {
  auto parsed = parse_session(head_text({}) + "read 0x01 -> 0x00000003\nwrite 0x02 = 0x00000005 -> done\n", "s");
  ASSERT_TRUE(parsed) << parsed.error().message;
  Session& session = parsed.value();
  const std::vector<Exchange> others = session.exchanges;
  BoardStatus old;
  BoardStatus fresh;
  fresh.level_bytes = 77;
  session.exchanges = {others.at(0),
                       {.request = Request::status, .status = old},
                       {.request = Request::status, .status = fresh},
                       {.request = Request::status},
                       others.at(1)};
  const auto say = [&](ReplayLink& link, const Exchange& one) {
    return one.request == Request::read ? bool(link.read_register(one.address))
                                        : bool(link.write_register(one.address, one.value));
  };
  ReplayLink eager(session, "s.txt");
  EXPECT_FALSE(eager.next_status(0ms).value()) << "nothing had come yet";
  EXPECT_TRUE(say(eager, others[0]));
  EXPECT_EQ(eager.next_status(0ms).value()->level_bytes, 0U);
  EXPECT_TRUE(say(eager, others[1])) << "with a status not asked for";
  EXPECT_EQ(eager.next_status(0ms).value()->level_bytes, 77U);
  EXPECT_FALSE(eager.next_status(0ms).value());
}

TEST_F(Replay, TheWriteThatKeepsABoardAwakeMayComeAtAnyTime) {
  const std::string alive = "write 0x3b = 0x00000000 -> done\n";
  auto session =
      parse_session(head_text({}) + "read 0x01 -> 0x00000003\n" + alive + alive + "read 0x02 -> 0x00000004\n", "s");
  ASSERT_TRUE(session) << session.error().message;
  const auto keep_alive = [](DeviceLink& link) {
    return bool(link.write_register(protocol::kKeepAlive.address, protocol::kKeepAlive.value));
  };
  ReplayLink slow(session.value(), "s.txt");
  EXPECT_TRUE(keep_alive(slow));
  EXPECT_TRUE(slow.read_register(1));
  EXPECT_TRUE(keep_alive(slow));
  EXPECT_TRUE(slow.read_register(2)) << "one of two was said";
  EXPECT_TRUE(keep_alive(slow));
  ReplayLink fast(session.value(), "s.txt");
  EXPECT_TRUE(fast.read_register(1));
  EXPECT_TRUE(fast.read_register(2)) << "none was said";
  ReplayLink wrong(session.value(), "s.txt");
  EXPECT_FALSE(wrong.write_register(protocol::kKeepAlive.address, 1));
}

TEST_F(Replay, AnotherStreamOfTheSameLengthIsSeen) {
  FakeBoard board;
  auto recording = RecordingLink::create(std::make_unique<DirectLink>(board), path_);
  ASSERT_TRUE(recording);
  std::vector<std::byte> stream(1000);
  ASSERT_TRUE(recording.value()->send(stream, 0ms));
  const auto replay = ReplayLink::open(path_);
  ASSERT_TRUE(replay);
  stream[999] = std::byte{1};
  EXPECT_FALSE(replay.value()->send(stream, 0ms));
}

TEST_F(Replay, NoFileIsOverwritten) {
  std::ofstream(path_) << "mine";
  FakeBoard board;
  const auto recording = RecordingLink::create(std::make_unique<DirectLink>(board), path_);
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, ErrorCode::bad_argument);
  EXPECT_NE(recording.error().message.find(path_), std::string::npos);
}

TEST_F(Replay, AFullDiskIsToldAndDisturbsNothing) {
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  rlimit was{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &was), 0);
  const rlimit small{120, was.rlim_max};  // room for the head
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  FakeBoard board(150);
  FakeBoard same(150);
  DirectLink plain(same);
  {
    auto recording = RecordingLink::create(std::make_unique<DirectLink>(board), path_);
    ASSERT_TRUE(recording) << recording.error().message;
    EXPECT_EQ(talk(*recording.value()), talk(plain));
    const auto written = recording.value()->written();
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::io);
    EXPECT_NE(written.error().message.find("cannot record the session: "), std::string::npos);
  }
  setrlimit(RLIMIT_FSIZE, &was);
  static_cast<void>(std::signal(SIGXFSZ, ignored));
}

}  // namespace
}  // namespace gravure::replay
