#include "gravure/core/spin_phase.hpp"
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

}  // namespace
}  // namespace gravure::test
