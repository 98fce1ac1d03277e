#include "gravure/session/resume.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <thread>

#include "gravure/fpga/ab_edges.hpp"
#include "gravure/fpga/register_map.hpp"
#include "session_bench.hpp"

namespace gravure::session::test {
namespace {

using emulator::BoardOptions;
using emulator::EmulatedBoard;
using emulator::EmulatedLink;
using gravure::test::small_job;

const JobIdentity kLongJob{"job.grv", "0123", 1'000, 100};
const BoardMemory kBoard{.serial = "A", .power_up = 7, .mark = 99, .executed_lines = 40, .closed_slot = 5};

Attempt attempt() {
  Attempt attempt;
  attempt.serial = "A";
  attempt.power_up = 7;
  attempt.mark = 99;
  attempt.first = {100, 3};
  attempt.end_line = 1'000;
  return attempt;
}

class Resume : public testing::Test {
 protected:
  void SetUp() override {
    Result<Journal> opened = Journal::open(folder_ / "j", kLongJob);
    ASSERT_TRUE(opened);
    journal_.emplace(std::move(opened).value());
    ASSERT_TRUE(journal_->begin(attempt()));
  }
  void start(const Acknowledged& acknowledged) {
    ASSERT_TRUE(journal_->started(300));
    ASSERT_TRUE(journal_->acknowledged(acknowledged));
  }
  Folder folder_;
  std::optional<Journal> journal_;
  ResumeOptions options_{.resume = true};
};

TEST_F(Resume, BeginsAgainWhereNothingWasBegun) {
  const Result<Beginning> where = where_to_begin(*journal_, kBoard, options_);
  ASSERT_TRUE(where);
  EXPECT_EQ(where.value().place, (Place{100, 3}));
  EXPECT_FALSE(where.value().uncertain);
}

TEST_F(Resume, TakesTheCountOfTheBoardToTheSlot) {
  start({120, 150, 200, 400});
  const Result<Beginning> where = where_to_begin(*journal_, kBoard, options_);
  ASSERT_TRUE(where) << where.error().message;
  EXPECT_EQ(where.value().place, (Place{140, 5}));
  EXPECT_FALSE(where.value().uncertain);
}

TEST_F(Resume, KeepsTheSlotsThatWereDoneBefore) {
  start({100, 150, 200, 400});
  BoardMemory board = kBoard;
  board.executed_lines = 0;
  for (const std::uint32_t slot : {2U, 9U}) {
    board.closed_slot = slot;
    const Result<Beginning> where = where_to_begin(*journal_, board, options_);
    ASSERT_TRUE(where);
    EXPECT_EQ(where.value().place, (Place{100, std::max<std::int64_t>(3, slot)}));
  }
}

TEST_F(Resume, StatesWhatNobodyKnows) {
  start({120, 150, 200, 400});
  for (const auto& change :
       {+[](BoardMemory& board) { board.power_up = 8; }, +[](BoardMemory& board) { board.mark = 1; },
        +[](BoardMemory& board) { board.serial = "B"; }}) {
    BoardMemory board = kBoard;
    change(board);
    options_.other_device = board.serial != "A";
    for (const UncertainPolicy policy : {UncertainPolicy::skip, UncertainPolicy::repeat}) {
      options_.uncertain = policy;
      const Result<Beginning> where = where_to_begin(*journal_, board, options_);
      ASSERT_TRUE(where) << where.error().message;
      ASSERT_TRUE(where.value().uncertain);
      EXPECT_EQ(where.value().uncertain->from, (Place{120, 0}));
      EXPECT_EQ(where.value().uncertain->end_line, 400);
      EXPECT_EQ(where.value().place, policy == UncertainPolicy::skip ? (Place{400, 0}) : (Place{120, 0}));
    }
  }
}

TEST_F(Resume, RefusesAnotherDeviceUnlessTold) {
  start({120, 150, 200, 400});
  BoardMemory board = kBoard;
  board.serial = "B";
  const Result<Beginning> where = where_to_begin(*journal_, board, options_);
  ASSERT_FALSE(where);
  EXPECT_EQ(where.error().code, ErrorCode::bad_argument);
  EXPECT_NE(where.error().message.find("board A, this is B"), std::string::npos) << where.error().message;
}

TEST_F(Resume, DecidesAnewWhereWhatWasDecidedDidNotStart) {
  start({120, 150, 200, 400});
  BoardMemory board = kBoard;
  board.power_up = 8;
  for (const UncertainPolicy policy : {UncertainPolicy::skip, UncertainPolicy::repeat, UncertainPolicy::skip}) {
    options_.uncertain = policy;
    const Result<Beginning> where = where_to_begin(*journal_, board, options_);
    ASSERT_TRUE(where) << where.error().message;
    ASSERT_TRUE(where.value().uncertain);
    EXPECT_EQ(where.value().place, policy == UncertainPolicy::skip ? (Place{400, 0}) : (Place{120, 0}));
    Attempt next = attempt();
    next.power_up = 8;
    next.mark = board.mark = 100;
    next.first = where.value().place;
    ASSERT_TRUE(journal_->begin(next));
    ASSERT_TRUE(journal_->uncertain(*where.value().uncertain, policy == UncertainPolicy::skip, false));
    EXPECT_TRUE(journal_->skipped().empty()) << "nothing is decided before lines are started";
  }
  ASSERT_TRUE(journal_->started(500));
  ASSERT_EQ(journal_->skipped().size(), 1U);
  EXPECT_EQ(journal_->skipped()[0].from.line, 120);
  EXPECT_EQ(count_lines(journal_->skipped()), 280);
}

TEST_F(Resume, KeepsWhatTheBoardSaidBeforeItForgetsIt) {
  start({120, 150, 200, 400});
  const Result<Beginning> where = where_to_begin(*journal_, kBoard, options_);
  ASSERT_TRUE(where);
  ASSERT_TRUE(journal_->found(where.value().place));
  Attempt next = attempt();
  next.mark = 100;
  next.first = where.value().place;
  ASSERT_TRUE(journal_->begin(next));  // and is not started
  BoardMemory board = kBoard;
  board.mark = 100;
  board.executed_lines = 0;
  const Result<Beginning> again = where_to_begin(*journal_, board, options_);
  ASSERT_TRUE(again);
  EXPECT_EQ(again.value().place, (Place{140, 5}));
  EXPECT_FALSE(again.value().uncertain);
}

TEST_F(Resume, SaysThatNoLineIsKnownToBeDone) {
  ASSERT_TRUE(journal_->begin_exposure());
  Attempt first = attempt();
  first.first = {};
  ASSERT_TRUE(journal_->begin(first));
  EXPECT_TRUE(check_options(*journal_, {})) << "nothing of it can have fired";
  ASSERT_TRUE(journal_->started(300));
  const Result<void> refused = check_options(*journal_, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("no line of it is known to be done"), std::string::npos)
      << refused.error().message;
}

TEST_F(Resume, RefusesABoardThatContradictsTheJournal) {
  start({120, 150, 200, 400});
  for (const std::uint32_t executed : {19U, 301U}) {
    BoardMemory board = kBoard;
    board.executed_lines = executed;
    const Result<Beginning> where = where_to_begin(*journal_, board, options_);
    ASSERT_FALSE(where) << executed;
    EXPECT_EQ(where.error().code, ErrorCode::device);
  }
}

TEST_F(Resume, SaysExactlyWhatTheDriftWouldHaveAdded) {
  Job job = small_job(100);
  job.fpga.fractional = false;
  const Result<Plan> made = make_plan(job, 40, 50);
  ASSERT_TRUE(made) << made.error().message;
  const Plan& plan = made.value();
  ASSERT_FALSE(plan.ab.exact);
  const ResumeOffset offset = resume_offset(plan, run_with(plan, 0), 4'017);
  EXPECT_EQ(offset.lines_before, 17);
  const fpga::AbRegisters registers{plan.ab.counter_bits, plan.ab.prescaler, plan.ab.increment, 0, 1};
  const auto counts = [&](std::int64_t line) {
    return Rational(static_cast<std::int64_t>(
        fpga::position_after(registers, static_cast<std::uint64_t>(line * plan.line.ticks)).counts));
  };
  const Rational per_revolution = plan.rotary.edges_per_revolution * Rational(Integer(1) << 30U);
  const Rational lost = counts(4'017) - counts(17) - 40 * per_revolution;
  EXPECT_EQ(offset.axis_um, lost / per_revolution * plan.rotary.circumference_um);
  EXPECT_EQ(resume_offset(plan, run_with(plan, 0), 17).axis_um, 0);
}

// Whole runs

TEST(Stop, ClosesTheGateAndGoesOnAtThatSlot) {
  SCOPED_TRACE(Dice::note());
  Dice dice(3);
  for (int trial = 0; trial < 10; ++trial) {
    Folder folder;
    MemoryProgram program;
    random_program(program, small_job(dice.between(20, 60)), 33, 3, dice);
    Exposure exposure(program);
    auto board = std::make_shared<EmulatedBoard>(EmulatedBoard({.capacity_bytes = 500, .observer = &exposure}));
    RunOptions options;
    {
      EmulatedLink link(board);
      Notes notes;
      CancelToken cancel;
      const std::int64_t at = dice.between(0, 50);
      notes.on_counts_ = [&](const RunCounts& counts) {
        if (counts.executed >= at) {
          cancel.cancel();
        }
      };
      const Result<RunReport> report = run_once(program, link, folder / "j", options, notes, cancel);
      ASSERT_TRUE(report) << report.error().message;
      ASSERT_EQ(report.value().end, RunEnd::stopped);
      EXPECT_EQ(exit_status(report.value().error->code), 4);
      EXPECT_TRUE(report.value().exact);
      EXPECT_NE(link.board().status().state, BoardState::running);
    }
    EmulatedLink link(board);
    Notes notes;
    options.resume.resume = true;
    const Result<RunReport> report = run_once(program, link, folder / "j", options, notes);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report.value().end, RunEnd::finished)
        << (report.value().error ? report.value().error->message : "") << notes.notes << exposure.lines();
    EXPECT_EQ(exposure.wrong(), 0);
  }
}

/// A program from a disk that takes its time.
class SlowSource final : public LineSource {
 public:
  explicit SlowSource(const MemoryProgram& program) : source_(program) {}
  const ProgramHeader& header() const noexcept override { return source_.header(); }
  std::int64_t lines_per_chunk() const noexcept override { return source_.lines_per_chunk(); }
  Result<StoredChunk> fetch(ChunkAddress address) override {
    if (++fetched_ == 4) {
      std::this_thread::sleep_for(std::chrono::milliseconds(600));
    }
    return source_.fetch(address);
  }
  Result<void> decode(const StoredChunk& chunk, std::span<std::byte> out) const override {
    return source_.decode(chunk, out);
  }

 private:
  MemorySource source_;
  int fetched_ = 0;
};

/// Counts what the host says while it has nothing to send.
class Listener final : public DeviceLink {
 public:
  explicit Listener(DeviceLink& link) : link_(link) {}
  const DeviceIdentity& identity() const noexcept override { return link_.identity(); }
  Result<std::uint32_t> read_register(std::uint8_t address) override { return link_.read_register(address); }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    kept_alive += address == fpga::kLowLevelRegister.address ? 1 : 0;
    return link_.write_register(address, value);
  }
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override {
    return link_.send(stream, patience);
  }
  Result<bool> drain(Milliseconds patience) override { return link_.drain(patience); }
  Result<void> abandon() override { return link_.abandon(); }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override { return link_.next_status(patience); }
  int kept_alive = 0;

 private:
  DeviceLink& link_;
};

TEST(Stream, KeepsTheBoardAliveWhileTheDiskIsSlow) {
  Dice dice;
  Folder folder;
  MemoryProgram program;
  random_program(program, small_job(40), 33, 2, dice);
  Exposure exposure(program);
  EmulatedLink board(EmulatedBoard({.capacity_bytes = 300, .observer = &exposure}));
  Listener link(board);
  SlowSource source(program);
  Result<Journal> journal = Journal::open(folder / "j", identity_of(program));
  ASSERT_TRUE(journal);
  Notes notes;
  RunOptions options;
  options.reserve_bytes = 100;
  const Result<RunReport> report = run_program(source, link, journal.value(), options, notes, {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().end, RunEnd::finished);
  EXPECT_EQ(exposure.wrong(), 0);
  EXPECT_GE(link.kept_alive, 6) << "at least every tenth of a second, and once before";
}

TEST(Preflight, RefusesALinkThatIsTooSlowNamingBothRates) {
  Dice dice;
  MemoryProgram program;
  random_program(program, small_job(40), 33, 1, dice);
  const LinkDemand demand = link_demand(program.header);
  EXPECT_EQ(demand.frame_bytes, 34);
  DeviceIdentity device;
  device.place = "bus 1";
  device.link_bits_per_s = 1'000'000;
  const Result<void> slow = check_link_rate(demand, device);
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.error().code, ErrorCode::bad_argument);
  EXPECT_NE(slow.error().message.find("the link carries 1.000 Mbit/s"), std::string::npos) << slow.error().message;
  EXPECT_NE(slow.error().message.find("pulse_divider"), std::string::npos);
  device.link_bits_per_s = 480'000'000;
  EXPECT_TRUE(check_link_rate(demand, device));
}

/// A board that lies in one register.
class Liar final : public DeviceLink {
 public:
  Liar(DeviceLink& link, std::uint8_t address, std::uint32_t value) : link_(link), address_(address), value_(value) {}
  const DeviceIdentity& identity() const noexcept override { return link_.identity(); }
  Result<std::uint32_t> read_register(std::uint8_t address) override {
    return address == address_ ? value_ : link_.read_register(address);
  }
  Result<void> write_register(std::uint8_t address, std::uint32_t value) override {
    return link_.write_register(address, value);
  }
  Result<std::size_t> send(std::span<const std::byte> stream, Milliseconds patience) override {
    return link_.send(stream, patience);
  }
  Result<bool> drain(Milliseconds patience) override { return link_.drain(patience); }
  Result<void> abandon() override { return link_.abandon(); }
  Result<std::optional<BoardStatus>> next_status(Milliseconds patience) override { return link_.next_status(patience); }

 private:
  DeviceLink& link_;
  std::uint8_t address_;
  std::uint32_t value_;
};

TEST(Handshake, NamesWhatDoesNotFit) {
  EmulatedLink board(EmulatedBoard(BoardOptions{}));
  const auto refused = [&board](const fpga::Register& one, std::uint32_t value, ErrorCode code, const char* part) {
    Liar link(board, one.address, value);
    const Result<BoardInfo> info = shake_hands(link);
    ASSERT_FALSE(info);
    EXPECT_EQ(info.error().code, code);
    EXPECT_NE(info.error().message.find(part), std::string::npos) << info.error().message;
  };
  refused(fpga::kMagicRegister, 0xFFFF'FFFF, ErrorCode::device, "0xffffffff");
  refused(fpga::kVersionRegister, 3, ErrorCode::version_mismatch, "version 3 of the register map, this program knows");
  refused(fpga::kCounterBitsRegister, 0, ErrorCode::device, "counter_bits reads 0");
  const Result<BoardInfo> info = shake_hands(board);
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info.value().descriptors.size(), fpga::kDescriptors.size());
  DeviceSetup setup;
  setup.clock_multiplier = 4;
  setup.counter_bits = 40;
  setup.window_slots = 1'000'000;
  setup.ticks_per_slot = 4;
  const Result<void> fits = check_board(info.value(), setup);
  ASSERT_FALSE(fits);
  for (const char* part :
       {"clock_multiplier = 4, this board has 2", "counter_bits = 40, this board has 32", "line FIFO of 65536 bytes"}) {
    EXPECT_NE(fits.error().message.find(part), std::string::npos) << fits.error().message;
  }
}

TEST(Disk, ThatIsFullStopsTheRunAndLosesNothing) {
  Dice dice;
  Folder folder;
  MemoryProgram program;
  random_program(program, small_job(60), 33, 400, dice);
  Exposure exposure(program);
  auto board = std::make_shared<EmulatedBoard>(EmulatedBoard({.capacity_bytes = 500, .observer = &exposure}));
  RunOptions options;
  Result<RunReport> full = Error{ErrorCode::io, "not run"};
  {
    ::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    EmulatedLink link(board);
    Notes notes;
    bool limited = false;
    notes.on_counts_ = [&](const RunCounts& counts) {
      if (!limited && counts.executed > 1'000) {
        limited = true;
        rlimit small = before;
        small.rlim_cur = 4'096;
        ::setrlimit(RLIMIT_FSIZE, &small);
      }
    };
    full = run_once(program, link, folder / "j", options, notes);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  }
  ASSERT_TRUE(full) << full.error().message;
  ASSERT_EQ(full.value().end, RunEnd::failed);
  EXPECT_EQ(full.value().error->code, ErrorCode::io);
  EXPECT_NE(full.value().error->message.find("journal"), std::string::npos) << full.value().error->message;
  EXPECT_LT(exposure.lines(), 24'000);
  EmulatedLink link(board);
  Notes notes;
  options.resume.resume = true;
  const Result<RunReport> report = run_once(program, link, folder / "j", options, notes);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().end, RunEnd::finished);
  EXPECT_FALSE(report.value().begun.uncertain);
  EXPECT_EQ(exposure.wrong(), 0);
}

}  // namespace
}  // namespace gravure::session::test
