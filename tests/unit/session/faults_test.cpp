#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <map>

#include "session_bench.hpp"

namespace gravure::session::test {
namespace {

using emulator::BoardOptions;
using emulator::EmulatedBoard;
using emulator::EmulatedLink;
using emulator::WireFault;
using emulator::WireFaultKind;
using gravure::test::small_job;

/// A kind of fault, and what the message of the run that it stops names; nothing: no run is stopped.
struct Kind {
  WireFaultKind kind;
  bool at_byte;
  bool at_slot;
  std::vector<const char*> names;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {WireFaultKind::underrun, false, true, {"underrun"}},
      {WireFaultKind::silence, false, true, {"host silence"}},
      {WireFaultKind::interlock, false, true, {"interlock"}},
      {WireFaultKind::power, false, true, {"lost its power"}},
      {WireFaultKind::checksum, false, false, {"checksum"}},
      {WireFaultKind::lost, false, false, {"sequence", "underrun"}},
      {WireFaultKind::duplicate, false, false, {"sequence"}},
      {WireFaultKind::shape, false, false, {"shape"}},
      {WireFaultKind::corrupt, true, false, {"sequence", "checksum", "shape", "neither"}},
      {WireFaultKind::full, true, false, {"neither takes nor executes"}},
      {WireFaultKind::stall, true, false, {"stalled at byte"}},
      {WireFaultKind::timeout, true, false, {"no answer", "neither takes nor executes"}},
      {WireFaultKind::disconnect, true, false, {"unplugged at byte"}},
      {WireFaultKind::short_take, true, false, {}},
      {WireFaultKind::delay, true, false, {}},
      {WireFaultKind::reorder, true, false, {}}};
  return all;
}

bool names_it(const Kind& kind, const std::string& message) {
  return std::any_of(kind.names.begin(), kind.names.end(),
                     [&](const char* name) { return message.find(name) != std::string::npos; });
}

/// Lines of which nobody knows whether they fired, as a run said.
struct Unknown {
  std::vector<Uncertain> stretches;
  bool holds(std::int64_t line) const {
    return std::any_of(stretches.begin(), stretches.end(),
                       [line](const Uncertain& one) { return line >= one.from.line && line < one.end_line; });
  }
};

class Faults : public testing::Test {
 protected:
  /// One run with a fault planned, then as many as it takes to the end.
  void expose_through(const Kind& kind, Dice& dice) {
    Folder folder;
    MemoryProgram program;
    Job job = small_job(dice.between(20, 60));
    job.scanner.bidirectional_offset_ticks = 2 * dice.between(-60, 60);
    random_program(program, job, dice.between(5, 40), dice.between(1, 3), dice);
    const Plan& plan = program.header.plan;
    const std::int64_t lines = plan.job.revolutions * plan.rotary.lines_per_revolution;
    const std::int64_t frame = program.header.line_bytes() + 29;
    Exposure exposure(program);
    RunOptions options;
    options.stall = std::chrono::milliseconds(250);
    BoardOptions board{.serial = "FAULTY",
                       .capacity_bytes = static_cast<std::size_t>(frame * dice.between(3, 30)),
                       .seed = dice.word(),
                       .observer = &exposure};
    WireFault fault{.kind = kind.kind};
    if (kind.at_byte) {
      fault.byte = dice.between(0, lines * frame - 1);
    } else {
      fault.line = dice.between(0, lines - 1);
      const std::int64_t slot = dice.between(0, plan.line.slots - 1);
      fault.slot = kind.at_slot ? slot : 0;
    }
    board.faults = {fault};
    SCOPED_TRACE("fault " + emulator::to_string(fault) + " of " + std::to_string(lines) + " lines");
    Unknown unknown;
    int runs = 0;
    for (bool finished = false; !finished; ++runs) {
      ASSERT_LT(runs, 8) << "it does not come to its end";
      Result<EmulatedBoard> opened = EmulatedBoard::open(folder / "board", board);
      ASSERT_TRUE(opened) << opened.error().message;
      EmulatedLink link(std::move(opened).value());
      Notes notes;
      const Result<RunReport> report = run_once(program, link, folder / "journal", options, notes);
      ASSERT_TRUE(report) << report.error().message;
      const RunReport& run = report.value();
      if (run.begun.uncertain) {
        unknown.stretches.push_back(*run.begun.uncertain);
      }
      finished = run.end == RunEnd::finished;
      if (!finished) {
        ASSERT_TRUE(run.error);
        EXPECT_TRUE(names_it(kind, run.error->message)) << run.error->message;
        EXPECT_EQ(exit_status(run.error->code), 3);
        if (run.exact) {
          EXPECT_EQ(exposure.wrong(0, run.executed.line), 0) << "known to be fired";
        }
      }
      options.resume.resume = true;
      board.faults.clear();
    }
    EXPECT_EQ(runs, kind.names.empty() ? 1 : 2);
    EXPECT_EQ(exposure.too_often(), 0) << "no slot twice, none that the program does not fire";
    for (std::int64_t line = 0; line < lines; ++line) {
      if (!unknown.holds(line)) {
        EXPECT_EQ(exposure.wrong(line, line + 1), 0) << "line " << line;
      }
    }
    EXPECT_EQ(unknown.stretches.empty(), kind.kind != WireFaultKind::power);
    ++count_[kind.kind];
  }
  void TearDown() override {
    for (const auto& [kind, count] : count_) {
      std::printf("%4d faults of kind %s\n", count, emulator::to_string(kind).c_str());
    }
  }
  std::map<WireFaultKind, int> count_;
};

/// GRAVURE_SESSION_FAULTS: how many; else as many as fit a quick run.
int faults_wanted() {
  const char* const text = std::getenv("GRAVURE_SESSION_FAULTS");
  return text != nullptr ? std::atoi(text) : 160;
}

TEST_F(Faults, LoseNoSlotAndFireNoneTwice) {
  SCOPED_TRACE(Dice::note());
  Dice dice(7);
  const int wanted = faults_wanted();
  for (int number = 0; number < wanted; ++number) {
    const Kind& kind = kinds()[static_cast<std::size_t>(number) % kinds().size()];
    expose_through(kind, dice);
    if (testing::Test::HasFailure()) {
      FAIL() << "fault " << number;
    }
  }
}

}  // namespace
}  // namespace gravure::session::test
