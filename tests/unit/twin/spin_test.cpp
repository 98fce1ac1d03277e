#include <algorithm>
#include <utility>

#include "gravure/core/spin_phase.hpp"
#include "gravure/pipeline/window_reader.hpp"
#include "twin_support.hpp"

/// Jobs whose axes are spun up from rest, on the emulated board.
namespace gravure::test {
namespace {

constexpr std::int64_t kLines = 13;

/// A tube that turns 2,000 times a second, so its limits are high.
void spun_job(SmallJob& small, bool fractional, const Rational& start_deg) {
  prepare(small, LinesAlong::rows, kLines, 45, 8);
  small.job.fpga.fractional = fractional;
  small.job.limits.seam_um = 100;
  small.job.rotary.limits = {Rational(100'000'000), Rational(10'000'000'000), Rational(1'000'000'000'000'000)};
  small.job.rotary.start_angle_deg = start_deg;
  compile_job(small, 8, LayerOrder::sequence);
}

/// Tells what verify() asks of a device what it should not.
class Lying final : public LineDevice {
 public:
  Lying(PinObserver& observer, std::uint64_t more) : device_(&observer), more_(more) {}
  Result<void> configure(const DeviceSetup& setup) override {
    DeviceSetup other = setup;
    if (more_ > 0) {
      other.spin_up.front().seeds += more_;  // the hand-over comes later
    }
    return device_.configure(other);
  }
  Result<void> send(const LineFrame& frame) override { return device_.send(frame); }
  DeviceStatus status() const override { return device_.status(); }

 private:
  emulator::EmulatedDevice device_;
  std::uint64_t more_;
};

Result<VerifyReport> verify_on(const SmallJob& small, std::uint64_t more) {
  return verify(
      [&]() -> Result<std::unique_ptr<LineSource>> {
        return std::unique_ptr<LineSource>(std::make_unique<MemorySource>(small.program));
      },
      [more](PinObserver& observer) { return std::make_unique<Lying>(observer, more); }, small.lines(), {});
}

TEST(SpinUp, LeavesEveryLineOfTheJobWhereItIsWithoutIt) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 40; ++trial) {
    SmallJob small;
    spun_job(small, dice.coin(), ratio(dice.between(-3600, 3600), 10));
    if (HasFatalFailure()) {
      return;
    }
    SmallJob plain;
    prepare(plain, LinesAlong::rows, kLines, 45, 8);
    plain.job = small.job;
    plain.job.rotary.limits = {};
    plain.job.rotary.start_angle_deg = 0;
    compile_job(plain, 8, LayerOrder::sequence);
    const Result<VerifyReport> spun = verify_on(small, 0);
    expect_sound(spun);
    const Result<VerifyReport> turning = verify_on(plain, 0);
    expect_sound(turning);
    EXPECT_NEAR(spun.value().axis_error_max_um, turning.value().axis_error_max_um, 1e-6);
    EXPECT_EQ(spun.value().seam_end_um, turning.value().seam_end_um);
    EXPECT_EQ(spun.value().ticks, turning.value().ticks);
  }
}

TEST(SpinUp, PutsOutExactlyWhatThePlanSaysBeforeLineZero) {
  SmallJob small;
  spun_job(small, false, 77);
  const Plan& plan = small.program.header.plan;
  ASSERT_TRUE(plan.spin);
  emulator::EmulatedDevice device;
  ASSERT_TRUE(device.configure(device_setup(plan, 0, 0)));
  const AxisState before = device.status().axis_spun_up;
  EXPECT_EQ(Integer(before.counts_low), plan.spin->up.counts);
  EXPECT_EQ(Integer(before.edges), spin_edges(plan.ab, plan.spin->up));
  EXPECT_EQ(device.status().axis.edges, 0) << "edges of the job count from tick 0";
}

TEST(SpinUp, OneSeedClockTooLongIsSeen) {
  SmallJob small;
  spun_job(small, true, 10);  // the prescaler is 1: a seed clock more is a step more
  const Result<VerifyReport> report = verify_on(small, 1);
  ASSERT_TRUE(report) << report.error().message;
  expect_violation(report.value(), "the axis stands wrong");
  expect_violation(report.value(), "the spin-up ends after ");
}

TEST(SpinUp, OneCountTooManyIsSeen) {
  SmallJob small;
  spun_job(small, true, 10);
  small.program.header.plan.spin->up.counts += 1;
  const Result<VerifyReport> report = verify_on(small, 0);
  ASSERT_TRUE(report) << report.error().message;
  expect_violation(report.value(), "the spin-up ends after ");
}

/// A stage that goes to and fro, from rest to rest each time.
void panel_job(SmallJob& small, bool fractional) {
  prepare(small, LinesAlong::rows, kLines, 45, 4);
  small.job.mode = Mode::flat;
  small.job.fpga.fractional = fractional;
  small.job.limits.seam_um = 100;
  small.job.stage = {kLines, 8, 20, 4, 2'000'000, {1000, 100'000, 20'000'000}};
  compile_job(small, 4, LayerOrder::sequence);
}

/// What a board could get wrong of the runs of a panel.
struct Wrong {
  bool always_forward = false;
  bool short_spin_down = false;
  bool no_spin_up_of_pass_2 = false;
  bool no_spin_down = false;
};

class WrongBoard final : public LineDevice {
 public:
  WrongBoard(PinObserver& observer, const Wrong& wrong) : device_(&observer), wrong_(wrong) {}
  Result<void> configure(const DeviceSetup& setup) override {
    DeviceSetup other = setup;
    other.backward = setup.backward && !wrong_.always_forward;
    if (wrong_.short_spin_down) {
      const auto shortest = std::min_element(
          other.spin_down.begin(), other.spin_down.end(), [](const ScheduleSegment& a, const ScheduleSegment& b) {
            return std::pair(a.increment == 0, a.seeds) < std::pair(b.increment == 0, b.seeds);
          });
      --shortest->increment;
    }
    if (wrong_.no_spin_up_of_pass_2 && setup.begin_revolution == 1) {
      other.spin_up.clear();
    }
    if (wrong_.no_spin_down) {
      other.spin_down.clear();
    }
    return device_.configure(other);
  }
  Result<void> send(const LineFrame& frame) override { return device_.send(frame); }
  DeviceStatus status() const override { return device_.status(); }

 private:
  emulator::EmulatedDevice device_;
  Wrong wrong_;
};

void expect_seen(const SmallJob& small, const Wrong& wrong, const std::string& part) {
  const Result<VerifyReport> report = verify(
      [&]() -> Result<std::unique_ptr<LineSource>> {
        return std::unique_ptr<LineSource>(std::make_unique<MemorySource>(small.program));
      },
      [&](PinObserver& observer) { return std::make_unique<WrongBoard>(observer, wrong); },
      [&]() { return make_layer_lines(small.program.header, small.stack, small.images, 1 << 20); }, {});
  ASSERT_TRUE(report) << report.error().message;
  if (part.empty()) {
    EXPECT_TRUE(report.value().violations.empty()) << all(report.value().violations);
  } else {
    expect_violation(report.value(), part);
  }
}

TEST(Panel, BoardsThatRunItsPassesWrongAreSeen) {
  for (const bool fractional : {false, true}) {
    SmallJob small;
    panel_job(small, fractional);
    if (HasFatalFailure()) {
      return;
    }
    expect_seen(small, {}, "");
    expect_seen(small, {.always_forward = true}, "the axis stands wrong at ");
    expect_seen(small, {.always_forward = true}, "the first at revolution 1, line ");
    expect_seen(small, {.short_spin_down = true}, "after it the device is at rest ");
    expect_seen(small, {.no_spin_up_of_pass_2 = true},
                "the first at revolution 1, line 0: the spin-up ends after 0 counts");
    expect_seen(small, {.no_spin_down = true}, "does not come to rest");
  }
}

TEST(Panel, ComesBackToItsFirstPlaceAfterEveryOtherPassToTheCount) {
  for (const bool fractional : {false, true}) {
    SmallJob small;
    panel_job(small, fractional);
    const Plan& plan = small.program.header.plan;
    ASSERT_TRUE(plan.spin);
    Integer place = 0;
    std::int64_t edges = 0;
    for (const BoardRun& run : runs_of(plan)) {
      emulator::EmulatedDevice device;
      ASSERT_TRUE(device.configure(device_setup(plan, run.first_revolution, 0)));
      EXPECT_FALSE(device.status().axis_at_rest) << "it has not run yet";
      MemorySource program(small.program);
      ProgramChunk chunk;
      for (std::int64_t k = 0; k * small.program.lines_per_chunk < kLines; ++k) {
        ASSERT_TRUE(chunk.load(
            program, {small.program.header.layer_of_revolution[static_cast<std::size_t>(run.first_revolution)], k}));
        ASSERT_TRUE(chunk.send(small.program.header, run.first_revolution, device));
      }
      const std::optional<AxisState> rest = device.status().axis_at_rest;
      ASSERT_TRUE(rest);
      EXPECT_EQ(rest->edges % 4, 0) << "A and B are low: loading the counter for the next pass makes no edge";
      EXPECT_EQ(rest->edges < 0, run.backward);
      place += counts_of(*rest);
      edges += rest->edges;
      if (run.backward) {
        EXPECT_EQ(place, 0);
        EXPECT_EQ(edges, 0);
      }
    }
  }
}

}  // namespace
}  // namespace gravure::test
