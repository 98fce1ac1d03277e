#include "gravure/motion/identify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "gravure/motion/plan_profile.hpp"
#include "indexing_models.hpp"
#include "motion_test_support.hpp"

namespace gravure::motion {
namespace {

/// What a sensor on the carried part would record, with noise of `noise` mm/s^2.
IdentifyRequest recorded(const std::vector<Mode>& modes, const std::vector<InputJump>& input, RecordingOf of,
                         double from_s, double until_s, double period_s, double noise, test::Random& random) {
  IdentifyRequest request;
  request.of = of;
  request.start_s = from_s;
  for (int k = 0; k * period_s <= until_s; ++k) {
    request.recording.time_s.push_back(k * period_s);
    request.recording.acceleration_mm_s2.push_back(carried_at(modes, input, k * period_s).acceleration_mm_s2 +
                                                   noise * random.gaussian());
  }
  return request;
}

void expect_modes(const Identification& found, const std::vector<Mode>& truth, double sigmas) {
  ASSERT_EQ(found.modes.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const IdentifiedMode& mode = found.modes[i];
    EXPECT_NEAR(mode.mode.f_hz, truth[i].f_hz, sigmas * mode.f_sd_hz + 1e-6);
    EXPECT_NEAR(mode.mode.zeta, truth[i].zeta, sigmas * mode.zeta_sd + 1e-7);
    EXPECT_NEAR(mode.mode.participation, truth[i].participation, sigmas * mode.participation_sd + 1e-5);
    EXPECT_LT(mode.f_sd_hz, 0.02 * mode.mode.f_hz);
  }
}

TEST(Identify, FindsBothModesOfARunDownAndTheirSharesFromTheKnownMove) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  const Profile profile = plan_profile(test::indexing(500, 30000, 30000, 22)).value();
  const auto input = input_of(profile);
  for (const double noise : {0.0, 20.0, 200.0}) {
    auto request = recorded(test::fit_b(), input, RecordingOf::run_down, 0.0625, 0.5, 250e-6, noise, random);
    request.input = input;
    const auto found = identify(request);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_TRUE(found.value().participation_is_absolute);
    expect_modes(found.value(), test::fit_b(), 4.5);
    EXPECT_NEAR(found.value().noise_sd_mm_s2, noise, 0.1 * noise + 1e-3);
  }
}

TEST(Identify, FindsBothModesOfAStepResponse) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 1);
  const std::vector<InputJump> step{{0, 5000, 0}, {10, -5000, 0}};
  const auto found = identify(recorded(test::fit_b(), step, RecordingOf::step, 0, 0.6, 500e-6, 25, random));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found.value().offset_mm_s2, 5000, 10);
  expect_modes(found.value(), test::fit_b(), 4.5);
}

TEST(Identify, SeparatesTwoCloseModesInNoise) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 2);
  const std::vector<Mode> modes{{40, 0.01, 0.6}, {42, 0.012, 0.4}};
  const std::vector<InputJump> step{{0, 1000, 0}, {10, -1000, 0}};
  const auto found = identify(recorded(modes, step, RecordingOf::step, 0, 1.5, 1e-3, 20, random));
  ASSERT_TRUE(found) << found.error().message;
  expect_modes(found.value(), modes, 4.5);
}

TEST(Identify, StatesUncertaintiesThatCoverTheTruth) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 3);
  const std::vector<Mode> modes{{55, 0.03, 1}};
  const std::vector<InputJump> step{{0, 1000, 0}, {10, -1000, 0}};
  int within_one = 0;
  int within_two = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const auto found = identify(recorded(modes, step, RecordingOf::step, 0, 0.5, 1e-3, 50, random));
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_EQ(found.value().modes.size(), 1U);
    const double off = std::abs(found.value().modes[0].mode.f_hz - 55) / found.value().modes[0].f_sd_hz;
    within_one += off < 1 ? 1 : 0;
    within_two += off < 2 ? 1 : 0;
  }
  EXPECT_NEAR(within_one, 68, 18);
  EXPECT_GE(within_two, 86);
}

TEST(Identify, GivesSharesOfTheAmplitudeWhenNoInputIsKnown) {
  test::Random random(7);
  const auto input = input_of(plan_profile(test::indexing(500, 30000, 30000, 0)).value());
  const auto found = identify(recorded(test::fit_b(), input, RecordingOf::run_down, 0.057, 0.5, 250e-6, 20, random));
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_FALSE(found.value().participation_is_absolute);
  EXPECT_NEAR(found.value().modes[0].mode.participation + found.value().modes[1].mode.participation, 1, 1e-12);
}

TEST(Identify, RefusesDataThatCannotTell) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 4);
  const std::vector<InputJump> step{{0, 1000, 0}, {10, -1000, 0}};
  const std::vector<Mode> one{{40, 0.01, 1}};
  const auto refused = [](const IdentifyRequest& request, std::string_view because) {
    const auto found = identify(request);
    ASSERT_FALSE(found) << because;
    EXPECT_EQ(found.error().code, ErrorCode::bad_file);
    EXPECT_NE(found.error().message.find(because), std::string::npos) << found.error().message;
  };
  refused(recorded(one, {}, RecordingOf::run_down, 0, 1, 1e-3, 20, random), "noise");  // nothing moves
  refused(recorded(one, step, RecordingOf::step, 0, 0.02, 1e-3, 0, random), "samples");
  refused(recorded(one, step, RecordingOf::step, 0, 0.04, 0.5e-3, 1, random), "cannot tell");  // 1.6 periods
  // Two modes a twentieth of a hertz apart over half a second.
  auto close = recorded({{40, 0.01, 0.5}, {40.05, 0.01, 0.5}}, step, RecordingOf::step, 0, 0.5, 1e-3, 20, random);
  close.modes = 2;
  refused(close, "cannot tell");
  auto uneven = recorded(one, step, RecordingOf::step, 0, 1, 1e-3, 1, random);
  uneven.recording.time_s[100] += 0.5e-3;
  refused(uneven, "even period");
  auto broken = recorded(one, step, RecordingOf::step, 0, 1, 1e-3, 1, random);
  broken.recording.acceleration_mm_s2[50] = std::numeric_limits<double>::quiet_NaN();
  refused(broken, "finite");
  auto growing = recorded(one, step, RecordingOf::step, 0, 1, 1e-3, 1, random);
  for (std::size_t k = 0; k < growing.recording.time_s.size(); ++k) {
    growing.recording.acceleration_mm_s2[k] =
        std::exp(2 * growing.recording.time_s[k]) * std::sin(250 * growing.recording.time_s[k]);
  }
  refused(growing, "grows");
  auto late = recorded(one, step, RecordingOf::step, 0, 1, 1e-3, 1, random);
  late.start_s = 0.006;  // a quarter period after the step it claims to see
  refused(late, "phase");
}

bool warns_of(const Identification& found, std::string_view text) {
  return std::any_of(found.warnings.begin(), found.warnings.end(),
                     [text](const std::string& w) { return w.find(text) != std::string::npos; });
}

/// Sums of decaying oscillations of any phase, in noise.
struct Ringing {
  double f_hz;
  double zeta;
  double amplitude;
  double phase_rad;
};

IdentifyRequest rung(const std::vector<Ringing>& modes, double length_s, double sample_hz, double noise,
                     test::Random& random) {
  IdentifyRequest request;
  for (int k = 0; k < length_s * sample_hz; ++k) {
    const double t = k / sample_hz;
    double value = noise * random.gaussian();
    for (const Ringing& m : modes) {
      const double w = 2 * std::numbers::pi * m.f_hz;
      value += m.amplitude * std::exp(-m.zeta * w * t) * std::cos(w * std::sqrt(1 - m.zeta * m.zeta) * t + m.phase_rad);
    }
    request.recording.time_s.push_back(t);
    request.recording.acceleration_mm_s2.push_back(value);
  }
  return request;
}

TEST(Identify, SaysHowCloseTwoModesMayBeAndNeverMergesAWiderPairInSilence) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 5);
  int told = 0;
  int merged = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double zeta = random.between(0.002, 0.02);
    const double gap_hz = 0.1 * std::exp(random.between(0, 4));
    const double phase = random.between(0, 2 * std::numbers::pi);
    const auto found = identify(rung({{60 - gap_hz / 2, zeta, 500, phase}, {60 + gap_hz / 2, zeta, 500, phase}}, 1,
                                     1000, std::exp(random.between(-1, 4)), random));
    if (!found) {
      EXPECT_NE(found.error().message.find("cannot tell"), std::string::npos) << found.error().message;
      continue;
    }
    const auto& modes = found.value().modes;
    ASSERT_LE(modes.size(), 2U) << "trial " << trial;
    if (modes.size() == 2) {
      ++told;
      EXPECT_NEAR(modes[0].mode.f_hz, 60 - gap_hz / 2, 5 * modes[0].f_sd_hz + 1e-6) << "trial " << trial;
      EXPECT_NEAR(modes[1].mode.f_hz, 60 + gap_hz / 2, 5 * modes[1].f_sd_hz + 1e-6) << "trial " << trial;
    } else {
      ++merged;
      EXPECT_LT(gap_hz, 1.3 * modes[0].resolution_hz) << "trial " << trial << ", zeta " << zeta;
      // A pair that would beat within its own decay does not pass without a word.
      EXPECT_TRUE(gap_hz < 2 * zeta * 60 / 2 || warns_of(found.value(), "record longer")) << "trial " << trial;
    }
  }
  EXPECT_GT(told, 8);
  EXPECT_GT(merged, 8);
}

TEST(Identify, TellsAPairApartThatIsWiderThanTheResolutionOfTheRecord) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 6);
  int told = 0;
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double zeta = random.between(0.002, 0.01);
    const double noise = std::exp(random.between(0, 3));
    const double phase = random.between(0, 2 * std::numbers::pi);
    const auto one = identify(rung({{60, zeta, 1000, phase}}, 1, 1000, noise, random));
    ASSERT_TRUE(one) << one.error().message;
    ASSERT_EQ(one.value().modes.size(), 1U);
    const double gap_hz = 1.6 * one.value().modes[0].resolution_hz;
    ASSERT_GT(gap_hz, 0);
    ASSERT_LT(gap_hz, 30) << "zeta " << zeta << ", noise " << noise;
    const auto two = identify(
        rung({{60 - gap_hz / 2, zeta, 500, phase}, {60 + gap_hz / 2, zeta, 500, phase}}, 1, 1000, noise, random));
    told += two && two.value().modes.size() == 2 ? 1 : 0;
  }
  EXPECT_GE(told, kTrials * 8 / 10);
}

TEST(Identify, WarnsOfTheRecordTooShortForAPairUntilItIsLonger) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 7);
  const std::vector<Ringing> pair{{60.0, 0.003, 500, 0.3}, {60.2, 0.003, 500, 0.3}};
  const auto merged = identify(rung(pair, 1, 1000, 10, random));
  ASSERT_TRUE(merged) << merged.error().message;
  ASSERT_EQ(merged.value().modes.size(), 1U);
  EXPECT_TRUE(warns_of(merged.value(), "60.1 Hz may be two"));
  EXPECT_GT(merged.value().modes[0].resolution_hz, 0.2);
  EXPECT_NEAR(merged.value().record_s, 1, 1e-9);
  EXPECT_NEAR(merged.value().sample_hz, 1000, 1e-6);
  auto two = rung(pair, 1, 1000, 10, random);
  two.modes = 2;
  const auto refused = identify(two);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("record longer"), std::string::npos) << refused.error().message;
  const auto longer = identify(rung(pair, 6, 1000, 1, random));
  ASSERT_TRUE(longer) << longer.error().message;
  ASSERT_EQ(longer.value().modes.size(), 2U);
  EXPECT_NEAR(longer.value().modes[0].mode.f_hz, 60.0, 5 * longer.value().modes[0].f_sd_hz);
  const auto one = identify(rung({{60, 0.003, 1000, 0.3}}, 6, 1000, 1, random));
  ASSERT_TRUE(one) << one.error().message;
  ASSERT_EQ(one.value().modes.size(), 1U);
  EXPECT_LT(one.value().modes[0].resolution_hz, 0.09);
  EXPECT_TRUE(one.value().warnings.empty()) << one.value().warnings[0];
}

TEST(Identify, WarnsOfModesThatMayBeFolded) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 8);
  for (int trial = 0; trial < 5; ++trial) {
    const double phase = random.between(0, 2 * std::numbers::pi);
    const double f_hz = random.between(560, 790);
    const auto folded = identify(rung({{f_hz, 0.005, 1000, phase}}, 1, 1000, 10, random));
    ASSERT_TRUE(folded) << folded.error().message;
    EXPECT_NEAR(folded.value().modes[0].mode.f_hz, 1000 - f_hz, 1);  // the data cannot tell
    EXPECT_TRUE(warns_of(folded.value(), "sample faster"));
    const auto faster = identify(rung({{f_hz, 0.005, 1000, phase}}, 1, 5000, 10, random));
    ASSERT_TRUE(faster) << faster.error().message;
    EXPECT_NEAR(faster.value().modes[0].mode.f_hz, f_hz, 5 * faster.value().modes[0].f_sd_hz);
    EXPECT_FALSE(warns_of(faster.value(), "sample faster"));
  }
}

TEST(Identify, WarnsOfAVibrationAtHalfTheSampleRateBesideTheMode) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 9);
  for (int trial = 0; trial < 20; ++trial) {
    const double phase = random.between(0, 2 * std::numbers::pi);
    const double f_hz = random.between(496, 504);
    const auto found = identify(rung({{60, 0.01, 1000, phase}, {f_hz, 0.001, 200, 0.5}}, 1, 1000, 5, random));
    EXPECT_TRUE(found ? warns_of(found.value(), "sample faster")
                      : found.error().message.find("sample faster") != std::string::npos)
        << "trial " << trial << ", " << f_hz << " Hz";
  }
  const auto alone = identify(rung({{60, 0.01, 1000, 1}}, 1, 1000, 5, random));
  ASSERT_TRUE(alone) << alone.error().message;
  EXPECT_FALSE(warns_of(alone.value(), "sample faster"));
}

TEST(RecordingCsv, ReadsHeadingsCommentsAndSeparators) {
  const Recording recording =
      parse_recording_csv("time_s,acceleration_mm_s2\n# taken by hand\n0,1.5\r\n0.001; -2e3\n\n0.002\t+7").value();
  ASSERT_EQ(recording.time_s.size(), 3U);
  EXPECT_EQ(recording.acceleration_mm_s2[1], -2000);
  EXPECT_EQ(recording.acceleration_mm_s2[2], 7);
}

TEST(RecordingCsv, NamesTheLineItCannotRead) {
  const auto refused = parse_recording_csv("t,a\n0,1\n0.1,x\n");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("line 3"), std::string::npos);
  EXPECT_FALSE(parse_recording_csv("0,1\n1,nan\n"));
  EXPECT_FALSE(parse_recording_csv("0,1\n1\n"));
  EXPECT_TRUE(parse_recording_csv("").value().time_s.empty());
}

}  // namespace
}  // namespace gravure::motion
