#include "gravure/emulator/faults.hpp"

#include <gtest/gtest.h>

#include "recorder.hpp"

namespace gravure::emulator {
namespace {

using test::Frame;
using test::Recorder;
using test::small_setup;

struct Outcome {
  std::vector<DarkLines> dark;
  std::vector<Recorder::Line> lines;
  DeviceStatus status;
};

Outcome run_job(std::vector<PlannedFault> faults, std::vector<std::int64_t> acknowledgements = {}) {
  Recorder recorder;
  EmulatedDevice device(&recorder);
  auto host = FaultyHost::make(device, std::move(faults), std::move(acknowledgements));
  EXPECT_TRUE(host);
  EXPECT_TRUE(host.value().configure(small_setup()));
  for (std::int64_t line = 0; line < 12; ++line) {
    Frame frame(line / 4, line % 4);
    const Result<void> sent = host.value().send(*frame);
    EXPECT_TRUE(sent) << sent.error().message;
  }
  return {host.value().dark(), recorder.lines, device.status()};
}

struct Expectation {
  FaultKind kind;
  DeviceFault fault;
};

class InjectedFault : public testing::TestWithParam<Expectation> {};

TEST_P(InjectedFault, KeepsTheGateDarkToTheEnd) {
  for (const std::int64_t at : {0, 1, 5, 11}) {
    const Outcome seen = run_job({{GetParam().kind, at}});
    const bool last_lost = GetParam().kind == FaultKind::lost && at == 11;  // nothing comes in its place
    const DeviceFault fault = last_lost ? DeviceFault::underrun : GetParam().fault;
    ASSERT_EQ(seen.dark.size(), 1U);
    EXPECT_EQ(seen.dark[0].fault, fault);
    EXPECT_EQ(seen.dark[0].tick, at * test::kLineTicks);
    EXPECT_EQ(seen.dark[0].first, at);
    EXPECT_EQ(seen.dark[0].last, 11);
    EXPECT_FALSE(seen.dark[0].detail.empty());
    EXPECT_EQ(seen.status.fault, fault);
    EXPECT_EQ(seen.status.lines_executed, at);
    EXPECT_EQ(seen.status.tick, 12 * test::kLineTicks) << "the machine never waits";
    ASSERT_EQ(seen.lines.size(), 12U);
    for (std::int64_t line = 0; line < 12; ++line) {
      EXPECT_EQ(seen.lines[static_cast<std::size_t>(line)].dark(), line >= at) << "line " << line;
    }
  }
}

TEST_P(InjectedFault, LetsTheGateOpenOnlyAfterTheAcknowledgement) {
  const Outcome seen = run_job({{GetParam().kind, 2}, {GetParam().kind, 9}}, {6});
  ASSERT_EQ(seen.dark.size(), 2U);
  EXPECT_EQ(seen.dark[0].first, 2);
  EXPECT_EQ(seen.dark[0].last, 5);
  EXPECT_EQ(seen.dark[1].first, 9);
  EXPECT_EQ(seen.dark[1].last, 11);
  for (std::int64_t line = 0; line < 12; ++line) {
    const bool dark = (line >= 2 && line < 6) || line >= 9;
    EXPECT_EQ(seen.lines[static_cast<std::size_t>(line)].dark(), dark) << "line " << line;
  }
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, InjectedFault,
                         testing::Values(Expectation{FaultKind::underrun, DeviceFault::underrun},
                                         Expectation{FaultKind::checksum, DeviceFault::checksum},
                                         Expectation{FaultKind::lost, DeviceFault::sequence},
                                         Expectation{FaultKind::shape, DeviceFault::shape},
                                         Expectation{FaultKind::silence, DeviceFault::host_silence},
                                         Expectation{FaultKind::interlock, DeviceFault::interlock}),
                         [](const auto& test) { return to_string(test.param.kind); });

TEST(FaultyHost, KeepsTheFirstOfTwoFaults) {
  const Outcome seen = run_job({{FaultKind::interlock, 8}, {FaultKind::underrun, 3}});
  ASSERT_EQ(seen.dark.size(), 1U);
  EXPECT_EQ(seen.dark[0].fault, DeviceFault::underrun);
  EXPECT_EQ(seen.status.fault, DeviceFault::underrun);
}

TEST(FaultyHost, LeavesAGoodJobAlone) {
  const Outcome seen = run_job({}, {});
  EXPECT_TRUE(seen.dark.empty());
  EXPECT_EQ(seen.status.lines_executed, 12);
}

TEST(FaultyHost, PassesOnARefusalThatWasNotPlanned) {
  EmulatedDevice device;
  auto host = FaultyHost::make(device, {{FaultKind::underrun, 9}}, {});
  ASSERT_TRUE(host.value().configure(small_setup()));
  Frame frame(0, 2);
  test::expect_refused(host.value().send(*frame), {"sequence"});
}

TEST(FaultyHost, RefusesTwoFaultsAtOneLine) {
  EmulatedDevice device;
  const auto host = FaultyHost::make(device, {{FaultKind::underrun, 9}, {FaultKind::lost, 9}}, {});
  ASSERT_FALSE(host);
  EXPECT_NE(host.error().message.find("line 9"), std::string::npos);
}

TEST(FaultyHost, RefusesAnAcknowledgementOfNothing) {
  EmulatedDevice device;
  const std::vector<PlannedFault> faults = {{FaultKind::underrun, 4}, {FaultKind::lost, 8}};
  EXPECT_TRUE(FaultyHost::make(device, faults, {9, 5}));
  EXPECT_TRUE(FaultyHost::make(device, faults, {10}));
  for (const std::vector<std::int64_t>& useless : std::vector<std::vector<std::int64_t>>{{4}, {5, 5}, {5, 8}, {2, 9}}) {
    const auto host = FaultyHost::make(device, faults, useless);
    ASSERT_FALSE(host);
    EXPECT_EQ(host.error().code, ErrorCode::bad_argument);
    EXPECT_NE(host.error().message.find("acknowledges nothing"), std::string::npos);
  }
}

TEST(FaultyHost, HitsTheLinesOfAJobThatStartsLater) {
  EmulatedDevice device;
  auto host = FaultyHost::make(device, {{FaultKind::underrun, 2}, {FaultKind::checksum, 6}}, {});
  DeviceSetup setup = small_setup();
  setup.first_revolution = 1;
  ASSERT_TRUE(host.value().configure(setup));
  for (std::int64_t line = 4; line < 12; ++line) {
    Frame frame(line / 4, line % 4);
    ASSERT_TRUE(host.value().send(*frame));
  }
  ASSERT_EQ(host.value().dark().size(), 1U);
  EXPECT_EQ(host.value().dark()[0].first, 6);
  EXPECT_EQ(host.value().dark()[0].fault, DeviceFault::checksum);
}

TEST(ParseFault, ReadsEveryKindAtEitherPlace) {
  for (const char* kind : {"underrun", "checksum", "lost", "shape", "silence", "interlock"}) {
    const auto over_job = parse_fault(std::string(kind) + "@line=11", small_setup());
    ASSERT_TRUE(over_job);
    EXPECT_EQ(over_job.value().ordinal, 11);
    EXPECT_EQ(to_string(over_job.value().kind), kind);
    const auto in_revolution = parse_fault(std::string(kind) + "@revolution=2,line=1", small_setup());
    ASSERT_TRUE(in_revolution);
    EXPECT_EQ(in_revolution.value().ordinal, 9);
  }
}

TEST(ParseFault, RefusesWhatItDoesNotKnowAndNamesWhatItDoes) {
  for (const char* text : {"", "fire@line=1", "underrun", "@line=1", "underrun@", "underrun@1", "underrun@line=",
                           "underrun@line=1x", "underrun@line=1,revolution=1", "underrun@revolution=1",
                           "underrun@revolution=1line=2", "underrun@line= 1", "underrun@line=99999999999999999999"}) {
    const auto fault = parse_fault(text, small_setup());
    ASSERT_FALSE(fault) << text;
    EXPECT_EQ(fault.error().code, ErrorCode::bad_argument) << text;
    EXPECT_NE(fault.error().message.find("revolution=R,line=L"), std::string::npos) << fault.error().message;
  }
}

TEST(ParseFault, RefusesPlacesBeyondTheJob) {
  for (const char* text : {"lost@line=12", "lost@line=-1", "lost@revolution=3,line=0", "lost@revolution=0,line=4",
                           "lost@revolution=-1,line=0"}) {
    const auto fault = parse_fault(text, small_setup());
    ASSERT_FALSE(fault) << text;
    EXPECT_EQ(fault.error().code, ErrorCode::out_of_range) << text;
    EXPECT_NE(fault.error().message.find("allowed is 0 to "), std::string::npos) << fault.error().message;
  }
}

}  // namespace
}  // namespace gravure::emulator
