#include "twin_support.hpp"

/// Devices that do not do what they say.
namespace gravure::test {
namespace {

/// The emulated board behind a screen that changes what its pins show.
class LyingDevice final : public LineDevice, private PinObserver {
 public:
  struct Lie {
    std::int64_t ordinal = 0;  ///< of the line that is lied about
    bool drop = false;
    std::int64_t slots = 0;  ///< the window comes later
    std::int64_t ticks = 0;  ///< so does the line
    bool shift_bits = false;
    std::int64_t edges = 0;         ///< more at the start of the line
    std::int64_t edges_at_end = 0;  ///< more in status(), once this line has run
  };
  LyingDevice(PinObserver& pins, const Lie& lie) : pins_(pins), lie_(lie), device_(this) {}

  Result<void> configure(const DeviceSetup& setup) override { return device_.configure(setup); }
  Result<void> send(const LineFrame& frame) override { return device_.send(frame); }
  DeviceStatus status() const override {
    DeviceStatus status = device_.status();
    if (last_ordinal_ == lie_.ordinal) {
      status.axis.edges += lie_.edges_at_end;
    }
    return status;
  }

 private:
  void on_line(const ExecutedLine& line) override {
    last_ordinal_ = line.ordinal;
    if (line.ordinal != lie_.ordinal) {
      return pins_.on_line(line);
    }
    if (lie_.drop) {
      return;
    }
    ExecutedLine told = line;
    told.first_slot += lie_.slots;
    told.start_tick += lie_.ticks;
    told.axis_at_start.edges += lie_.edges;
    std::vector<std::byte> fired(line.fired.begin(), line.fired.end());
    if (lie_.shift_bits) {
      for (std::size_t i = 0; i < fired.size(); ++i) {
        const auto next = i + 1 < fired.size() ? std::to_integer<unsigned>(fired[i + 1]) : 0U;
        fired[i] = static_cast<std::byte>(std::to_integer<unsigned>(fired[i]) << 1U | next >> 7U);
      }
    }
    told.fired = fired;
    pins_.on_line(told);
  }

  PinObserver& pins_;
  const Lie lie_;
  emulator::EmulatedDevice device_;
  std::int64_t last_ordinal_ = -1;
};

VerifyReport report_with(const LyingDevice::Lie& lie, bool fractional = true) {
  SmallJob small;
  prepare(small, LinesAlong::rows, 13, 45, 4);
  small.job.fpga.fractional = fractional;
  small.job.limits.seam_um = 100;
  compile_job(small, 8, LayerOrder::cycle);
  const Result<VerifyReport> report = verify_job(
      small, small.lines(), {.threads = 2},
      [&](PinObserver& pins) -> std::unique_ptr<LineDevice> { return std::make_unique<LyingDevice>(pins, lie); });
  EXPECT_TRUE(report) << report.error().message;
  return report ? report.value() : VerifyReport{};
}

TEST(LyingDevice, IsBelievedWhenItDoesNotLie) {
  EXPECT_TRUE(report_with({.ordinal = -5}).violations.empty()) << all(report_with({.ordinal = -5}).violations);
  EXPECT_TRUE(report_with({.ordinal = -5}, false).violations.empty());
}

TEST(LyingDevice, IsCaughtWhenItDropsALine) {
  for (const std::int64_t ordinal : {0, 47, 8 * 13 - 1}) {  // the first, one amidst a chunk, the last
    const VerifyReport report = report_with({.ordinal = ordinal, .drop = true});
    expect_violation(report, "1 of 104 lines were never executed");
    EXPECT_GT(report.wrong_pixels, 0);
  }
}

TEST(LyingDevice, IsCaughtWhenItMovesTheWindow) {
  for (const std::int64_t slots : {-1, 1}) {
    expect_violation(report_with({.ordinal = 50, .slots = slots}),
                     "the first at revolution 3, line 11: the line came at another time or in another window");
  }
}

TEST(LyingDevice, IsCaughtWhenALineComesLate) {
  const VerifyReport report = report_with({.ordinal = 50, .ticks = 1});
  expect_violation(report, "the first at revolution 3, line 11: the line came at another time");
}

TEST(LyingDevice, IsCaughtWhenItShiftsTheBits) {
  expect_violation(report_with({.ordinal = 50, .shift_bits = true}), "the first at revolution 3, line 11, column");
}

TEST(LyingDevice, IsCaughtWhenTheAxisIsOneEdgeOff) {
  for (const bool fractional : {true, false}) {
    for (const std::int64_t edges : {-1, 1}) {
      for (const std::int64_t ordinal : {1, 50, 103}) {
        expect_violation(report_with({.ordinal = ordinal, .edges = edges}, fractional),
                         "the axis stands wrong at 1 line start(s) or ends, the first at revolution " +
                             std::to_string(ordinal / 13) + ", line " + std::to_string(ordinal % 13));
      }
    }
  }
}

TEST(LyingDevice, IsCaughtWhenTheAxisEndsOneEdgeOff) {
  for (const std::int64_t edges : {-1, 1}) {
    expect_violation(report_with({.ordinal = 103, .edges_at_end = edges}), "at its end ");
  }
  const VerifyReport report = report_with({.ordinal = 103, .edges_at_end = 2});
  expect_violation(report, "at the end of the last line the device's axis is");
}

/// A board that refuses everything from some line on.
class TiredDevice final : public LineDevice {
 public:
  explicit TiredDevice(PinObserver& pins) : device_(&pins) {}
  Result<void> configure(const DeviceSetup& setup) override { return device_.configure(setup); }
  Result<void> send(const LineFrame& frame) override {
    if (frame.revolution == 6 && frame.line >= 5) {
      device_.raise_fault(DeviceFault::interlock, "the door is open");
    }
    return device_.send(frame);
  }
  DeviceStatus status() const override { return device_.status(); }

 private:
  emulator::EmulatedDevice device_;
};

TEST(TiredDevice, IsReportedWithWhatItSaid) {
  SmallJob small;
  sound_job(small);
  const Result<VerifyReport> report =
      verify_job(small, small.lines(), {},
                 [](PinObserver& pins) -> std::unique_ptr<LineDevice> { return std::make_unique<TiredDevice>(pins); });
  ASSERT_TRUE(report);
  expect_violation(report.value(), "the device refused revolution 6, line 5");
  expect_violation(report.value(), "interlock");
  EXPECT_GT(report.value().wrong_pixels, 0);
}

}  // namespace
}  // namespace gravure::test
