#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

#include "gravure/core/job.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/sync/make_plan.hpp"

namespace gravure::sync_test {

/// GRAVURE_TEST_SEED, else 1: every random test starts from it and prints it when it fails.
inline std::uint32_t test_seed() {
  const char* text = std::getenv("GRAVURE_TEST_SEED");
  return text == nullptr ? 1U : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

inline std::string seed_note() {
  return "rerun with GRAVURE_TEST_SEED=" + std::to_string(test_seed());
}

/// Random integers that are the same on every machine.
class Random {
 public:
  Random() : engine_(test_seed()) {}
  /// least..most, both included.
  std::uint64_t between(std::uint64_t least, std::uint64_t most) {
    const std::uint64_t span = most - least;
    return span == std::numeric_limits<std::uint64_t>::max() ? engine_() : least + engine_() % (span + 1);
  }
  std::int64_t count(std::int64_t least, std::int64_t most) {
    return static_cast<std::int64_t>(between(static_cast<std::uint64_t>(least), static_cast<std::uint64_t>(most)));
  }
  bool chance(std::uint64_t one_in) { return engine_() % one_in == 0; }

 private:
  std::mt19937_64 engine_;
};

/// Setup 1 of [B]: the embossing roller. q, np and the encoder are not in the text; these give its 215 revolutions.
inline Job roller_job() {
  Job job;
  job.title = "roller";
  job.laser = {.seed_hz = 82'000'000, .pulse_divider = 41, .max_pulse_on_demand_hz = 16'400'000};
  job.fpga = {.clock_multiplier = 2, .counter_bits = 32, .fractional = false, .max_prescaler = 4'294'967'295U};
  job.scanner.pixel_pitch_um = 8;
  job.scanner.slots_per_microvector = 1;
  job.scanner.turn_slots = 409;
  job.rotary.diameter_mm = Rational(70);
  job.rotary.line_pitch_um = Rational(8);
  job.rotary.encoder_lines = 11'840;
  job.rotary.interpolation_bits = 13;
  job.rotary.max_ab_hz = 2'000'000;
  job.limits.seam_um = Rational(1, 2);
  return job;
}

/// Setup 2 of [B]: the stent-like tube, coarse enough for exact pairs to exist near it.
inline Job tube_job() {
  Job job = roller_job();
  job.title = "tube";
  job.laser.pulse_divider = 16;
  job.scanner.pixel_pitch_um = 6;
  job.scanner.turn_slots = 300;
  job.rotary.diameter_mm.reset();
  job.rotary.circumference_mm = Rational(5658, 1000);
  job.rotary.line_pitch_um = Rational(6);
  job.rotary.encoder_lines = 10'000;
  job.rotary.interpolation_bits = 0;
  job.limits.seam_um = 1;
  return job;
}

/// The plan, or a failure of the test with the error.
inline Plan planned(const Job& job, std::int64_t pixels_per_line, std::int64_t revolutions) {
  Result<Plan> plan = make_plan(job, pixels_per_line, revolutions);
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
  return plan ? plan.value() : Plan{};
}

}  // namespace gravure::sync_test
