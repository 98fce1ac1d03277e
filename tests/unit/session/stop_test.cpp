#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "gravure/fpga/register_map.hpp"
#include "gravure/protocol/start_sequence.hpp"
#include "session_bench.hpp"

namespace gravure::session::test {
namespace {

using emulator::EmulatedBoard;
using emulator::EmulatedLink;
using gravure::test::small_job;

/// Keeps what was written since the start, and tells each command.
class Watcher final : public DeviceLink {
 public:
  explicit Watcher(EmulatedBoard board) : link_(std::move(board)) {}
  const DeviceIdentity& identity() const noexcept override { return link_.identity(); }
  Result<std::uint32_t> read_register(std::uint8_t address) override { return link_.read_register(address); }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    const bool command = address == fpga::kCommandRegister.address;
    if (command && on_command) {
      on_command(value);
    }
    if (address == fpga::kControlRegister.address && (value & protocol::kControlRun) != 0) {
      started = true;
    }
    appended += command && (value & protocol::kCommandAppend0) != 0 && started ? 1 : 0;
    return link_.write_register(address, value);
  }
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override {
    return link_.send(stream, patience);
  }
  Result<bool> drain(Milliseconds patience) override { return link_.drain(patience); }
  Result<void> abandon() override { return link_.abandon(); }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override { return link_.next_status(patience); }

  std::function<void(std::uint32_t)> on_command;
  bool started = false;
  int appended = 0;  ///< segments, since the start

 private:
  EmulatedLink link_;
};

/// A job whose axis spins up and down.
void spun_program(MemoryProgram& program, Dice& dice, std::int64_t revolutions = 3) {
  Job job = small_job(40);
  job.rotary.limits = {1'000'000, 20'000'000, 4'000'000'000};
  random_program(program, job, 33, revolutions, dice);
  ASSERT_TRUE(program.header.plan.spin);
}

TEST(Stop, WritesWhatWasFiredBeforeTheAxesComeToRest) {
  Dice dice(5);
  Folder folder;
  MemoryProgram program;
  spun_program(program, dice, 2'000);  // that its end is far away
  ASSERT_FALSE(testing::Test::HasFatalFailure());
  Watcher link(EmulatedBoard({.capacity_bytes = 500}));
  CancelToken cancel;
  Notes notes;
  notes.on_counts_ = [&](const RunCounts& counts) {
    if (counts.executed >= 20) {
      cancel.cancel();
    }
  };
  int copies = 0;
  link.on_command = [&](std::uint32_t value) {
    if (link.started && (value & protocol::kCommandStopSchedules) != 0) {  // as if it were killed here
      std::filesystem::copy_file(folder / "j", folder / "k");
      std::filesystem::copy_file(folder / "j-wal", folder / "k-wal");
      ++copies;
    }
  };
  const Result<RunReport> report = run_once(program, link, folder / "j", {}, notes, cancel);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report.value().end, RunEnd::stopped);
  ASSERT_EQ(copies, 1);
  EXPECT_GT(link.appended, 0);
  const Result<Journal> killed = Journal::open(folder / "k", identity_of(program));
  ASSERT_TRUE(killed) << killed.error().message;
  EXPECT_EQ(killed.value().last()->state, AttemptState::ended);
  EXPECT_EQ(killed.value().last()->executed, report.value().executed);
}

TEST(Stop, LeavesAnAxisAloneThatNeverMoved) {
  Dice dice(6);
  Folder folder;
  MemoryProgram program;
  spun_program(program, dice);
  ASSERT_FALSE(testing::Test::HasFatalFailure());
  Watcher link(EmulatedBoard({.capacity_bytes = 500}));
  int stops = 0;
  bool filling = false;
  link.on_command = [&](std::uint32_t value) {
    filling = filling || (value & protocol::kCommandPosition) != 0;
    stops += filling && (value & (protocol::kCommandStopSchedules | protocol::kCommandGo)) != 0 ? 1 : 0;
  };
  CancelToken cancel;
  Notes notes;
  notes.on_counts_ = [&](const RunCounts& /*counts*/) { cancel.cancel(); };
  const Result<RunReport> report = run_once(program, link, folder / "j", {}, notes, cancel);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().end, RunEnd::stopped);
  EXPECT_TRUE(filling);
  EXPECT_FALSE(link.started);
  EXPECT_EQ(stops, 0);
  EXPECT_EQ(link.read_register(fpga::kControlRegister.address).value(), 0U);
}

TEST(Stop, LetsTheScheduleOfTheStartEndByItself) {
  Dice dice(7);
  Folder folder;
  MemoryProgram program;
  spun_program(program, dice);
  ASSERT_FALSE(testing::Test::HasFatalFailure());
  Watcher link(EmulatedBoard({.capacity_bytes = 500}));
  Notes notes;
  const Result<RunReport> report = run_once(program, link, folder / "j", {}, notes);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().end, RunEnd::finished);
  EXPECT_EQ(link.appended, 0) << "nothing is added to the ramp that runs already";
  EXPECT_EQ(link.read_register(fpga::kControlRegister.address).value(), 0U);
}

/// A board whose stream breaks, and whose registers answer then or do not.
class Stuck final : public DeviceLink {
 public:
  Stuck(EmulatedBoard board, bool answers) : link_(std::move(board)), answers_(answers) {}
  const DeviceIdentity& identity() const noexcept override { return link_.identity(); }
  Result<std::uint32_t> read_register(std::uint8_t address) override { return link_.read_register(address); }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    if (failed_ && !answers_) {
      return Error{ErrorCode::device, "gone"};
    }
    closed = closed || (failed_ && address == fpga::kControlRegister.address && (value & protocol::kControlRun) == 0);
    return link_.write_register(address, value);
  }
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override {
    if (sent_ > 2'000) {
      failed_ = true;
      return Error{ErrorCode::device, "the stream broke"};
    }
    GRAVURE_TRY(const std::size_t taken, link_.send(stream, patience));
    sent_ += taken;
    return taken;
  }
  Result<bool> drain(Milliseconds patience) override { return link_.drain(patience); }
  Result<void> abandon() override { return link_.abandon(); }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override { return link_.next_status(patience); }
  bool closed = false;

 private:
  EmulatedLink link_;
  bool answers_;
  bool failed_ = false;
  std::size_t sent_ = 0;
};

TEST(Stop, SaysThatTheGateIsClosedOnlyWhereItIs) {
  for (const bool answers : {true, false}) {
    Dice dice(8);
    Folder folder;
    MemoryProgram program;
    random_program(program, small_job(40), 33, 5, dice);
    Stuck link(EmulatedBoard({.capacity_bytes = 500}), answers);
    Notes notes;
    const Result<RunReport> report = run_once(program, link, folder / "j", {}, notes);
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_EQ(report.value().end, RunEnd::failed);
    EXPECT_EQ(link.closed, answers);
    EXPECT_EQ(report.value().exact, answers);
    const std::string& message = report.value().error->message;
    EXPECT_NE(message.find(answers ? "the stream broke: the gate is closed"
                                   : "the board cannot be told to close its gate, it does so by itself within 0.100 s"),
              std::string::npos)
        << message;
  }
}

/// Never more bytes on their way to the board, or in it, than it has room for.
class Scales final : public DeviceLink {
 public:
  Scales(EmulatedBoard board, std::int64_t frame) : link_(std::move(board)), frame_(frame) {}
  const DeviceIdentity& identity() const noexcept override { return link_.identity(); }
  Result<std::uint32_t> read_register(std::uint8_t address) override { return link_.read_register(address); }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    return link_.write_register(address, value);
  }
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override {
    EXPECT_LE(sent_ - executed_ * frame_ + static_cast<std::int64_t>(stream.size()), 500);
    GRAVURE_TRY(const std::size_t taken, link_.send(stream, patience));
    sent_ += static_cast<std::int64_t>(taken);
    return taken;
  }
  Result<bool> drain(Milliseconds patience) override { return link_.drain(patience); }
  Result<void> abandon() override { return link_.abandon(); }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override {
    GRAVURE_TRY(const std::optional<BoardStatus> status, link_.next_status(patience));
    executed_ = status ? std::int64_t{status->executed_lines} : executed_;
    return status;
  }

 private:
  EmulatedLink link_;
  std::int64_t frame_;
  std::int64_t executed_ = 0;
  std::int64_t sent_ = 0;
};

TEST(Stream, NeverHoldsMoreThanTheBoardHasRoomFor) {
  Dice dice(9);
  Folder folder;
  MemoryProgram program;
  random_program(program, small_job(40), 33, 5, dice);
  Scales link(EmulatedBoard({.capacity_bytes = 500}), program.header.line_bytes() + 29);
  Notes notes;
  const Result<RunReport> report = run_once(program, link, folder / "j", {}, notes);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().end, RunEnd::finished);
}

/// A board that does nothing more after a while, but for its clock.
class Ticking final : public DeviceLink {
 public:
  explicit Ticking(EmulatedBoard board) : link_(std::move(board)) {}
  const DeviceIdentity& identity() const noexcept override { return link_.identity(); }
  Result<std::uint32_t> read_register(std::uint8_t address) override { return link_.read_register(address); }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    return link_.write_register(address, value);
  }
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override {
    return last_ ? Result<std::size_t>(std::size_t{0}) : link_.send(stream, patience);
  }
  Result<bool> drain(Milliseconds patience) override { return link_.drain(patience); }
  Result<void> abandon() override { return link_.abandon(); }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override {
    if (last_) {
      ++last_->sequence;
      last_->tick += 1'000;
      return last_;
    }
    GRAVURE_TRY(const std::optional<BoardStatus> status, link_.next_status(patience));
    if (status && status->state == BoardState::running && status->executed_lines > 20) {
      last_ = status;
    }
    return status;
  }

 private:
  EmulatedLink link_;
  std::optional<BoardStatus> last_;
};

TEST(Stream, FindsABoardStalledThoughItsClockGoesOn) {
  Dice dice(10);
  Folder folder;
  MemoryProgram program;
  random_program(program, small_job(40), 33, 5, dice);
  Ticking link(EmulatedBoard({.capacity_bytes = 500}));
  Notes notes;
  RunOptions options;
  options.stall = std::chrono::milliseconds(250);
  const Result<RunReport> report = run_once(program, link, folder / "j", options, notes);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report.value().end, RunEnd::failed);
  const std::string& message = report.value().error->message;
  EXPECT_NE(message.find("neither takes nor executes"), std::string::npos) << message;
}

}  // namespace
}  // namespace gravure::session::test
