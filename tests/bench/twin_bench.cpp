// What it costs to put pulses back onto the workpiece, one thread: against the least a simulation can do, to look at
// every pulse bit, in the same run; and bounds in closed form against the simulation of the same lines.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <ctime>
#include <vector>

#include "error_model.hpp"
#include "gravure/sync/make_plan.hpp"

namespace {

using namespace gravure;

constexpr std::int64_t kPixels = 3500;
constexpr std::int64_t kLines = 10'000;  // 3.5e7 pulses

/// The large roller: 27,489 lines of 5400 slots, 3500 of them marked.
Plan roller_plan() {
  Job job;
  job.laser = {.seed_hz = 82'000'000, .pulse_divider = 41, .max_pulse_on_demand_hz = 16'400'000};
  job.fpga = {.clock_multiplier = 2, .counter_bits = 32, .fractional = false, .max_prescaler = 4'294'967'295U};
  job.scanner.pixel_pitch_um = 8;
  job.scanner.slots_per_microvector = 20;
  job.scanner.turn_slots = 1900;
  job.rotary.diameter_mm = Rational(70);
  job.rotary.line_pitch_um = Rational(8);
  job.rotary.encoder_lines = 11'840;
  job.rotary.interpolation_bits = 13;
  job.rotary.max_ab_hz = 2'000'000;
  job.limits.seam_um = Rational(1, 2);
  return make_plan(job, kPixels, 100).value();
}

scan::LineTrajectory roller_trajectory(const Plan& plan) {
  kinematics::ScanHead head;
  head.field_mm = 40;
  head.resolution_bits = 20;
  const scan::LineTiming timing = scan::line_timing(plan);
  return scan::make_line_trajectory(timing,
                                    scan::cylinder_geometry(timing, scan::cylinder_lines(plan, 0), head).value(), {})
      .value();
}

TwinSettings terms(bool servo) {
  TwinSettings twin;
  twin.servo = {servo, 50, ratio(7, 10)};
  twin.run_out = {true, 10, 0};
  twin.thermal = {true, 5, 12};
  return twin;
}

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU time of a run of all lines, the least of three.
template <class Work>
double least_seconds(const Work& work) {
  double least = 1e9;
  for (int turn = 0; turn < 3; ++turn) {
    const double start = cpu_seconds();
    for (std::int64_t line = 0; line < kLines; ++line) {
      work(line);
    }
    least = std::min(least, cpu_seconds() - start);
  }
  return least;
}

}  // namespace

int main() {
  const Plan plan = roller_plan();
  const scan::LineTrajectory trajectory = roller_trajectory(plan);
  const std::vector<std::byte> fired((kPixels + 7) / 8, std::byte{0xFF});
  const auto look = [&fired](std::int64_t) {
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < kPixels; ++i) {
      count += (std::to_integer<unsigned>(fired[static_cast<std::size_t>(i / 8)]) >> (7U - (i & 7))) & 1U;
      benchmark::DoNotOptimize(count);
    }
  };
  const double looked = least_seconds(look);
  std::printf("%-36s %12s %14s %18s\n", "all terms", "pulses/s", "looks a pulse", "simulated / bound");
  for (const bool servo : {false, true}) {
    const ErrorModel model = ErrorModel::make(plan, &trajectory, terms(servo)).value();
    PulseSums sums;
    const double simulated = least_seconds([&](std::int64_t line) { model.simulate(0, line, fired, sums); });
    double most = 0;
    const double bounded = least_seconds([&](std::int64_t line) {
      most = std::max(most, model.line_bound(0, line).landing_um);
      benchmark::DoNotOptimize(most);
    });
    std::printf("%-36s %12.3g %14.3g %18.0f\n", servo ? "with a servo" : "ideal axis",
                static_cast<double>(kLines * kPixels) / simulated, simulated / looked, simulated / bounded);
  }
  return 0;
}
