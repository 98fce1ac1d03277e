#include <gtest/gtest.h>

#include <limits>

#include "recorder.hpp"

namespace gravure::emulator {
namespace {

using test::expect_refused;
using test::Frame;
using test::Recorder;
using test::send;
using test::small_setup;

class EmulatedDeviceSend : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(device_.configure(small_setup())); }
  void expect_latched(DeviceFault fault) {
    EXPECT_EQ(device_.status().fault, fault) << to_string(device_.status().fault);
    EXPECT_FALSE(device_.status().detail.empty());
    ASSERT_FALSE(recorder_.lines.empty());
    EXPECT_TRUE(recorder_.lines.back().dark());
  }
  Recorder recorder_;
  EmulatedDevice device_{&recorder_};
};

TEST_F(EmulatedDeviceSend, RunsAWholeJobBitByBit) {
  for (std::int64_t revolution = 0; revolution < 3; ++revolution) {
    for (std::int64_t line = 0; line < 4; ++line) {
      Frame frame(revolution, line);
      const auto result = device_.send(*frame);
      ASSERT_TRUE(result) << result.error().message;
      const Recorder::Line& seen = recorder_.lines.back();
      EXPECT_EQ(seen.ordinal, revolution * 4 + line);
      EXPECT_EQ(seen.start_tick, (revolution * 4 + line) * test::kLineTicks);
      EXPECT_EQ(seen.first_slot, 3 + line);
      EXPECT_EQ(seen.fired, frame.bits());
    }
  }
  EXPECT_EQ(recorder_.lines.size(), 12U);
  EXPECT_EQ(device_.status().lines_executed, 12);
  EXPECT_EQ(device_.status().tick, 12 * test::kLineTicks);
  EXPECT_EQ(device_.status().fault, DeviceFault::none);
}

TEST_F(EmulatedDeviceSend, RefusesAnyLineAfterTheLast) {
  for (std::int64_t ordinal = 0; ordinal < 12; ++ordinal) {
    ASSERT_TRUE(send(device_, ordinal / 4, ordinal % 4));
  }
  expect_refused(send(device_, 3, 0), {"sequence", "revolution 3, line 0", "is over"});
  EXPECT_EQ(device_.status().fault, DeviceFault::sequence);
  EXPECT_EQ(device_.status().tick, 12 * test::kLineTicks);
  EXPECT_EQ(recorder_.lines.size(), 12U);
}

TEST_F(EmulatedDeviceSend, RefusesEveryFlippedBitAndStaysDark) {
  for (unsigned bit = 0; bit < 13; ++bit) {
    EmulatedDevice device(&recorder_);
    ASSERT_TRUE(device.configure(small_setup()));
    Frame frame(0, 0);
    frame.bits()[bit / 8] ^= static_cast<std::byte>(0x80U >> (bit % 8));
    expect_refused(device.send(*frame), {"checksum", "revolution 0, line 0", "crc32c = 0x"});
    EXPECT_EQ(device.status().fault, DeviceFault::checksum);
    EXPECT_TRUE(recorder_.lines.back().dark());
    expect_refused(send(device, 0, 1), {"checksum", "stands", "revolution 0, line 1", "acknowledge"});
    EXPECT_TRUE(recorder_.lines.back().dark());
  }
}

TEST_F(EmulatedDeviceSend, RefusesALineOutOfSequenceAndStaysDark) {
  struct Case {
    const char* what;
    std::int64_t revolution, line;
  };
  for (const Case& wrong : {Case{"missing", 0, 2}, Case{"repeated", 0, 0}, Case{"other revolution", 1, 1},
                            Case{"negative", 0, -1}, Case{"past the revolution", 0, 5}}) {
    SCOPED_TRACE(wrong.what);
    EmulatedDevice device(&recorder_);
    ASSERT_TRUE(device.configure(small_setup()));
    ASSERT_TRUE(send(device, 0, 0));
    EXPECT_FALSE(recorder_.lines.back().dark());
    expect_refused(send(device, wrong.revolution, wrong.line),
                   {"sequence", "line " + std::to_string(wrong.line) + ":", "only revolution 0, line 1 may come next"});
    EXPECT_EQ(device.status().fault, DeviceFault::sequence);
    EXPECT_TRUE(recorder_.lines.back().dark());
    EXPECT_FALSE(send(device, 0, 2));
    EXPECT_TRUE(recorder_.lines.back().dark());
    EXPECT_EQ(device.status().lines_executed, 1);
  }
}

TEST_F(EmulatedDeviceSend, RefusesTooFewBytes) {
  Frame frame(0, 0);
  frame.bits().pop_back();
  expect_refused(device_.send(*frame.sign()), {"shape", "1 bytes", "must be 2", "window_slots = 13"});
  expect_latched(DeviceFault::shape);
}

TEST_F(EmulatedDeviceSend, RefusesTooManyBytes) {
  Frame frame(0, 0);
  frame.bits().push_back(std::byte{0});
  expect_refused(device_.send(*frame.sign()), {"shape", "3 bytes", "must be 2"});
  expect_latched(DeviceFault::shape);
}

TEST_F(EmulatedDeviceSend, RefusesBitsPastTheWindow) {
  Frame frame(0, 0);
  frame.bits()[1] |= std::byte{1};
  expect_refused(device_.send(*frame.sign()), {"shape", "3 low bits", "must be 0"});
  expect_latched(DeviceFault::shape);
}

TEST_F(EmulatedDeviceSend, RefusesAWindowThatLeavesTheLine) {
  for (const std::int64_t first_slot : {std::int64_t{-1}, std::int64_t{8}, std::numeric_limits<std::int64_t>::max()}) {
    EmulatedDevice device(&recorder_);
    ASSERT_TRUE(device.configure(small_setup()));
    Frame frame(0, 0);
    frame->first_slot = first_slot;
    expect_refused(device.send(*frame.sign()), {"shape", "first_slot = " + std::to_string(first_slot), "0 to 7"});
    EXPECT_TRUE(recorder_.lines.back().dark());
  }
  Frame frame(0, 0);
  frame->first_slot = 7;
  EXPECT_TRUE(device_.send(*frame.sign()));
}

TEST_F(EmulatedDeviceSend, ChecksSequenceThenShapeThenChecksum) {
  Frame frame(0, 1);
  frame.bits().push_back(std::byte{0});
  frame->bits = frame.bits();
  EXPECT_FALSE(device_.send(*frame));
  EXPECT_EQ(device_.status().fault, DeviceFault::sequence);
  device_.acknowledge();
  EXPECT_FALSE(device_.send(*frame));
  EXPECT_EQ(device_.status().fault, DeviceFault::shape);
}

TEST_F(EmulatedDeviceSend, KeepsTimeAndAxisRunningThroughAFault) {
  ASSERT_TRUE(send(device_, 0, 0));
  EXPECT_FALSE(send(device_, 0, 3));
  EXPECT_FALSE(send(device_, 0, 2));
  EXPECT_EQ(device_.status().tick, 3 * test::kLineTicks);
  EXPECT_EQ(device_.status().lines_executed, 1);
  device_.acknowledge();
  EXPECT_EQ(device_.status().fault, DeviceFault::none);
  ASSERT_TRUE(send(device_, 0, 3));
  EXPECT_FALSE(recorder_.lines.back().dark());
  EXPECT_EQ(recorder_.lines.back().start_tick, 3 * test::kLineTicks);
}

TEST_F(EmulatedDeviceSend, KeepsTheFirstFault) {
  EXPECT_FALSE(send(device_, 0, 3));
  device_.raise_fault(DeviceFault::interlock, "door open");
  EXPECT_EQ(device_.status().fault, DeviceFault::sequence);
}

TEST_F(EmulatedDeviceSend, StaysDarkAfterAnInterlockUntilAcknowledged) {
  device_.raise_fault(DeviceFault::interlock, "door open");
  expect_refused(send(device_, 0, 0), {"interlock", "door open", "passed dark"});
  expect_latched(DeviceFault::interlock);
  device_.acknowledge();
  EXPECT_TRUE(send(device_, 0, 1));
}

TEST_F(EmulatedDeviceSend, NeedsConfigureFirst) {
  EmulatedDevice device;
  expect_refused(send(device, 0, 0), {"not configured"});
}

TEST_F(EmulatedDeviceSend, RunsALineWithoutPixels) {
  DeviceSetup setup = small_setup();
  setup.window_slots = 0;
  EmulatedDevice device(&recorder_);
  ASSERT_TRUE(device.configure(setup));
  Frame frame(0, 0);
  frame.bits().clear();
  EXPECT_TRUE(device.send(*frame.sign()));
  EXPECT_TRUE(recorder_.lines.back().fired.empty());
}

}  // namespace
}  // namespace gravure::emulator
