#include "gravure/session/run.hpp"

#include <gtest/gtest.h>

#include "session_bench.hpp"

namespace gravure::session::test {
namespace {

using emulator::BoardOptions;
using emulator::EmulatedBoard;
using emulator::EmulatedLink;
using gravure::test::small_job;

TEST(Run, ExposesEveryPixelOnce) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 20; ++trial) {
    Folder folder;
    MemoryProgram program;
    Job job = small_job(dice.between(3, 40));
    job.scanner.bidirectional_offset_ticks = 2 * dice.between(-60, 60);
    random_program(program, job, dice.between(5, 60), dice.between(1, 4), dice);
    ASSERT_FALSE(testing::Test::HasFatalFailure());
    Exposure exposure(program);
    EmulatedLink link(EmulatedBoard({.observer = &exposure}));
    Notes notes;
    const Result<RunReport> report = run_once(program, link, folder / "j", {}, notes);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report.value().end, RunEnd::finished)
        << (report.value().error ? report.value().error->message : std::string());
    EXPECT_EQ(exposure.wrong(), 0);
    EXPECT_EQ(report.value().counts.executed, report.value().counts.total);
    EXPECT_EQ(link.board().status().state, BoardState::idle);
  }
}

TEST(Run, NamesLinesThatItSkipped) {
  Dice dice(11);
  Folder folder;
  MemoryProgram program;
  random_program(program, small_job(20), 33, 2, dice);
  BoardOptions options{.serial = "A", .faults = {{.kind = emulator::WireFaultKind::power, .line = 0, .slot = 0}}};
  {
    Result<EmulatedBoard> board = EmulatedBoard::open(folder / "board", options);
    ASSERT_TRUE(board) << board.error().message;
    EmulatedLink link(std::move(board).value());
    Notes notes;
    const Result<RunReport> report = run_once(program, link, folder / "j", {}, notes);
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_EQ(report.value().end, RunEnd::failed);
  }
  options.faults.clear();
  Result<EmulatedBoard> board = EmulatedBoard::open(folder / "board", options);
  ASSERT_TRUE(board) << board.error().message;
  EmulatedLink link(std::move(board).value());
  Notes notes;
  const Result<RunReport> report = run_once(program, link, folder / "j", {.resume = {.resume = true}}, notes);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().end, RunEnd::finished);
  EXPECT_EQ(count_lines(report.value().skipped), 40);
  EXPECT_EQ(report.value().counts.executed, 0);
  const Result<Journal> journal = Journal::open(folder / "j", identity_of(program));
  ASSERT_TRUE(journal);
  const Result<void> finished = check_options(journal.value(), {});
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().message.find("40 lines were skipped, not known to be fired"), std::string::npos)
      << finished.error().message;
}

}  // namespace
}  // namespace gravure::session::test
