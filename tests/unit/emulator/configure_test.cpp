#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "recorder.hpp"

namespace gravure::emulator {
namespace {

using test::expect_refused;
using test::small_setup;

void expect_refused_with(const std::function<void(DeviceSetup&)>& change, std::initializer_list<std::string> parts) {
  DeviceSetup setup = small_setup();
  change(setup);
  EmulatedDevice device;
  expect_refused(device.configure(setup), parts);
}

TEST(EmulatedDeviceConfigure, TakesTheExtremes) {
  const auto takes = [](const std::function<void(DeviceSetup&)>& change) {
    DeviceSetup setup = small_setup();
    change(setup);
    EmulatedDevice device;
    const auto result = device.configure(setup);
    EXPECT_TRUE(result) << result.error().message;
  };
  takes([](DeviceSetup&) {});
  takes([](DeviceSetup& s) { s.increment = 0; });
  takes([](DeviceSetup& s) { s.increment = (1U << 14U) - 1; });
  takes([](DeviceSetup& s) { s.increment = 1U << 14U, s.fraction_num = 0; });
  takes([](DeviceSetup& s) { s.counter_bits = 8, s.increment = 63; });
  takes([](DeviceSetup& s) { s.counter_bits = 64, s.fraction_den = 17'179'869'183, s.prescaler = 4'294'967'295; });
  takes([](DeviceSetup& s) { s.window_slots = 0; });
  takes([](DeviceSetup& s) { s.window_slots = s.slots_per_line; });
  takes([](DeviceSetup& s) {
    s.slots_per_line = s.ticks_per_slot = s.end_revolution = s.lines_per_revolution = 1, s.window_slots = 1;
  });
  takes([](DeviceSetup& s) { s.end_revolution = 4'294'967'296; });
  takes([](DeviceSetup& s) { s.slots_per_line = 16'777'215, s.window_slots = 262'144; });
  takes([](DeviceSetup& s) { s.ticks_per_slot = 65'535; });
  takes([](DeviceSetup& s) { s.clock_multiplier = 2, s.ticks_per_slot = 131'070; });
  takes([](DeviceSetup& s) { s.clock_multiplier = 16, s.ticks_per_slot = 1'048'560; });
  takes([](DeviceSetup& s) { s.first_revolution = 2, s.first_line = 3; });
}

TEST(EmulatedDeviceConfigure, RefusesCounterRegisters) {
  expect_refused_with([](DeviceSetup& s) { s.counter_bits = 7; }, {"counter_bits = 7", "8 to 64"});
  expect_refused_with([](DeviceSetup& s) { s.counter_bits = 65; }, {"counter_bits = 65", "8 to 64"});
  expect_refused_with([](DeviceSetup& s) { s.counter_bits = -1; }, {"counter_bits = -1", "8 to 64"});
  expect_refused_with([](DeviceSetup& s) { s.prescaler = 0; }, {"prescaler = 0", "1 to 4294967295"});
  expect_refused_with([](DeviceSetup& s) { s.fraction_den = 0; }, {"fraction_den = 0", "1 to 17179869183"});
  expect_refused_with([](DeviceSetup& s) { s.fraction_den = 17'179'869'184; }, {"fraction_den = 17179869184"});
  expect_refused_with([](DeviceSetup& s) { s.prescaler = 4'294'967'296; }, {"prescaler = 4294967296"});
  expect_refused_with([](DeviceSetup& s) { s.fraction_num = 7; }, {"fraction_num = 7", "0 to 6"});
  expect_refused_with([](DeviceSetup& s) { s.increment = 1U << 14U; }, {"increment = 16384", "0 to 16383"});
  expect_refused_with([](DeviceSetup& s) { s.increment = (1U << 14U) + 1, s.fraction_num = 0; },
                      {"increment = 16385", "0 to 16384"});
  expect_refused_with([](DeviceSetup& s) { s.increment = ~std::uint64_t{0}; }, {"increment = 18446744073709551615"});
}

TEST(EmulatedDeviceConfigure, RefusesLineRegisters) {
  expect_refused_with([](DeviceSetup& s) { s.ticks_per_slot = 0; }, {"seeds_per_slot = 0", "1 to 65535"});
  expect_refused_with([](DeviceSetup& s) { s.ticks_per_slot = -3; }, {"seeds_per_slot = -3"});
  expect_refused_with([](DeviceSetup& s) { s.clock_multiplier = 2, s.ticks_per_slot = 131'072; },
                      {"seeds_per_slot = 65536", "1 to 65535"});
  expect_refused_with([](DeviceSetup& s) { s.clock_multiplier = 2, s.ticks_per_slot = 5; },
                      {"ticks_per_slot = 5", "multiples of clock_multiplier = 2"});
  expect_refused_with([](DeviceSetup& s) { s.clock_multiplier = 0; }, {"clock_multiplier = 0", "1 to 16"});
  expect_refused_with([](DeviceSetup& s) { s.clock_multiplier = 17, s.ticks_per_slot = 17; },
                      {"clock_multiplier = 17", "1 to 16"});
  expect_refused_with([](DeviceSetup& s) { s.slots_per_line = 0; }, {"slots_per_line = 0", "1 to 16777215"});
  expect_refused_with([](DeviceSetup& s) { s.slots_per_line = 16'777'216; }, {"slots_per_line = 16777216"});
  expect_refused_with([](DeviceSetup& s) { s.slots_per_line = -1; }, {"slots_per_line = -1"});
  expect_refused_with([](DeviceSetup& s) { s.window_slots = 21; }, {"window_slots = 21", "0 to 20", "inside the line"});
  expect_refused_with([](DeviceSetup& s) { s.window_slots = -1; }, {"window_slots = -1", "0 to 262144"});
  expect_refused_with([](DeviceSetup& s) { s.slots_per_line = s.window_slots = 262'145; },
                      {"window_slots = 262145", "0 to 262144"});
}

TEST(EmulatedDeviceConfigure, RefusesJobRegisters) {
  expect_refused_with([](DeviceSetup& s) { s.lines_per_revolution = 0; }, {"lines_per_revolution = 0"});
  expect_refused_with([](DeviceSetup& s) { s.lines_per_revolution = -4; }, {"lines_per_revolution = -4"});
  expect_refused_with([](DeviceSetup& s) { s.end_revolution = 0; }, {"end_revolution = 0"});
  expect_refused_with([](DeviceSetup& s) { s.first_revolution = 3; }, {"first_revolution = 3", "0 to 2"});
  expect_refused_with([](DeviceSetup& s) { s.first_line = 4; }, {"first_line = 4", "0 to 3"});
  expect_refused_with([](DeviceSetup& s) { s.first_line = -1; }, {"first_line = -1", "0 to 3"});
  expect_refused_with([](DeviceSetup& s) { s.first_revolution = -1; }, {"first_revolution = -1", "0 to 2"});
  expect_refused_with([](DeviceSetup& s) { s.lines_per_revolution = 4'294'967'296; },
                      {"lines_per_revolution = 4294967296", "1 to 4294967295"});
  expect_refused_with([](DeviceSetup& s) { s.end_revolution = 4'294'967'297; }, {"end_revolution = 4294967297"});
  expect_refused_with([](DeviceSetup& s) { s.end_revolution = s.lines_per_revolution = 4'294'967'295; },
                      {"end_revolution = 4294967295", "9223372036854775807 ticks"});
}

TEST(EmulatedDeviceConfigure, SaysEveryViolationOnce) {
  expect_refused_with([](DeviceSetup& s) { s.prescaler = 0, s.ticks_per_slot = 0, s.end_revolution = 0; },
                      {"prescaler = 0", "seeds_per_slot = 0", "\nthe board refuses end_revolution = 0"});
}

TEST(EmulatedDeviceConfigure, LeavesTheMachineAsItWasWhenRefused) {
  EmulatedDevice device;
  ASSERT_TRUE(device.configure(small_setup()));
  ASSERT_TRUE(test::send(device, 0, 0));
  DeviceSetup bad = small_setup();
  bad.prescaler = 0;
  EXPECT_FALSE(device.configure(bad));
  EXPECT_TRUE(test::send(device, 0, 1));
}

TEST(EmulatedDeviceConfigure, IsLockedWhileAFaultStands) {
  EmulatedDevice device;
  ASSERT_TRUE(device.configure(small_setup()));
  EXPECT_FALSE(test::send(device, 0, 1));
  expect_refused(device.configure(small_setup()), {"sequence", "acknowledge"});
  device.acknowledge();
  EXPECT_TRUE(device.configure(small_setup()));
}

}  // namespace
}  // namespace gravure::emulator
