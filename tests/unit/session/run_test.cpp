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

}  // namespace
}  // namespace gravure::session::test
