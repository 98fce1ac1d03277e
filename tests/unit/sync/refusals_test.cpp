#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>

#include "gravure/sync/make_plan.hpp"
#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::roller_job;

/// One value of a sound job changed, and what the refusal must say.
struct Refusal {
  std::string name;
  std::function<void(Job&)> change;
  ErrorCode code;
  std::string part;
  std::int64_t pixels = 3500;
  std::int64_t revolutions = 10;
};

void PrintTo(const Refusal& refusal, std::ostream* out) {
  *out << refusal.name;
}

constexpr ErrorCode kRange = ErrorCode::out_of_range;
constexpr ErrorCode kArgument = ErrorCode::bad_argument;

const Refusal kRefusals[] = {
    {"SeedOfZero", [](Job& j) { j.laser.seed_hz = 0; }, kRange, "laser.seed_hz = 0: must be 1 to"},
    {"DividerOfZero", [](Job& j) { j.laser.pulse_divider = 0; }, kRange, "laser.pulse_divider = 0: must be 1 to"},
    {"DividerBeyondTheRegister", [](Job& j) { j.laser.pulse_divider = 65'536; }, kRange,
     "laser.pulse_divider = 65536: must be 1 to 65535"},
    {"GateOfZero", [](Job& j) { j.laser.max_pulse_on_demand_hz = 0; }, kRange, "laser.max_pulse_on_demand_hz = 0"},
    {"MultiplierOfZero", [](Job& j) { j.fpga.clock_multiplier = 0; }, kRange, "fpga.clock_multiplier = 0"},
    {"MultiplierOfNoBoard", [](Job& j) { j.fpga.clock_multiplier = 17; }, kRange,
     "fpga.clock_multiplier = 17: must be 1 to 16"},
    {"SevenCounterBits", [](Job& j) { j.fpga.counter_bits = 7; }, kRange, "fpga.counter_bits = 7: must be 8 to 64"},
    {"SixtyFiveCounterBits", [](Job& j) { j.fpga.counter_bits = 65; }, kRange, "fpga.counter_bits = 65"},
    {"PrescalerOfZero", [](Job& j) { j.fpga.max_prescaler = 0; }, kRange, "fpga.max_prescaler = 0: must be 1 to"},
    {"PixelPitchOfZero", [](Job& j) { j.scanner.pixel_pitch_um = 0; }, kRange,
     "scanner.pixel_pitch_um = 0: must be greater than 0"},
    {"MicrovectorOfZero", [](Job& j) { j.scanner.slots_per_microvector = 0; }, kRange,
     "scanner.slots_per_microvector = 0"},
    {"NegativeTurn", [](Job& j) { j.scanner.turn_slots = -1; }, kRange, "scanner.turn_slots = -1: must be 0 to"},
    {"NegativeExtra", [](Job& j) { j.scanner.max_extra_slots = -1; }, kRange, "scanner.max_extra_slots = -1"},
    {"DiameterAndCircumference", [](Job& j) { j.rotary.circumference_mm = Rational(219); }, kArgument,
     "rotary.diameter_mm and rotary.circumference_mm are both given"},
    {"NeitherDiameterNorCircumference", [](Job& j) { j.rotary.diameter_mm.reset(); }, kArgument,
     "rotary.diameter_mm and rotary.circumference_mm are both missing"},
    {"PitchAndLines", [](Job& j) { j.rotary.lines_per_revolution = 27'489; }, kArgument,
     "rotary.line_pitch_um and rotary.lines_per_revolution are both given"},
    {"NeitherPitchNorLines", [](Job& j) { j.rotary.line_pitch_um.reset(); }, kArgument,
     "rotary.line_pitch_um and rotary.lines_per_revolution are both missing"},
    {"NegativeDiameter", [](Job& j) { j.rotary.diameter_mm = Rational(-70); }, kRange, "rotary.diameter_mm = -70"},
    {"CircumferenceOfZero",
     [](Job& j) {
       j.rotary.diameter_mm.reset();
       j.rotary.circumference_mm = Rational(0);
     },
     kRange, "rotary.circumference_mm = 0"},
    {"LinePitchOfZero", [](Job& j) { j.rotary.line_pitch_um = Rational(0); }, kRange, "rotary.line_pitch_um = 0"},
    {"NoLines",
     [](Job& j) {
       j.rotary.line_pitch_um.reset();
       j.rotary.lines_per_revolution = 0;
     },
     kRange, "rotary.lines_per_revolution = 0: must be 1 to"},
    {"PitchBeyondTheWorkpiece", [](Job& j) { j.rotary.line_pitch_um = Rational(500'000); }, kRange,
     "rotary.line_pitch_um = 500000: gives 0 lines on a circumference of 219911.486 um"},
    {"PitchOfTooManyLines", [](Job& j) { j.rotary.line_pitch_um = ratio(1, 10'000); }, kRange,
     "1 to 1000000000 lines fit, a pitch of 0.000219911486 to 219911.486 um"},
    {"NoEncoder", [](Job& j) { j.rotary.encoder_lines = 0; }, kRange, "rotary.encoder_lines = 0"},
    {"NegativeInterpolation", [](Job& j) { j.rotary.interpolation_bits = -1; }, kRange,
     "rotary.interpolation_bits = -1: must be 0 to 32"},
    {"GearOfZero", [](Job& j) { j.rotary.gear_workpiece_turns = 0; }, kRange,
     "rotary.gear = [1, 0]: both must be 1 to"},
    {"NoAbFrequency", [](Job& j) { j.rotary.max_ab_hz = 0; }, kRange, "rotary.max_ab_hz = 0"},
    {"NoSeamLimit", [](Job& j) { j.limits.seam_um = 0; }, kRange, "limits.seam_um = 0: must be greater than 0"},
    {"NoPixels", [](Job&) {}, kRange, "image.pixels_per_line = 0", 0},
    {"NoRevolutions", [](Job&) {}, kRange, "image.revolutions = 0", 3500, 0},
    {"PulsesFasterThanTheGate",
     [](Job& j) {
       j.laser.pulse_divider = 4;
       j.rotary.interpolation_bits = 9;
     },
     kRange,
     "laser.pulse_divider = 4: pulses at 20500000 Hz, faster than laser.max_pulse_on_demand_hz = 16400000; the "
     "smallest "
     "divider that fits is 5"},
    {"OffsetTooLate", [](Job& j) { j.scanner.bidirectional_offset_ticks = 205 * 82; }, kRange,
     "scanner.bidirectional_offset_ticks = 16810: moves the marking window of right-to-left lines out of the line; "
     "-16891 to 16809 ticks fit"},
    {"OffsetTooEarly", [](Job& j) { j.scanner.bidirectional_offset_ticks = -206 * 82; }, kRange,
     "-16891 to 16809 ticks fit a line of 3909 slots"},
    {"AxisOutsideTheWorkpiece",
     [](Job& j) {
       j.twin.run_out.enabled = true;
       j.twin.run_out.eccentricity_um = 35'000;
     },
     kRange, "twin.run_out.eccentricity_um = 35000: must be less than the radius of the workpiece, 35000 um"},
    {"OffsetOfTheSmallestInteger",
     [](Job& j) { j.scanner.bidirectional_offset_ticks = std::numeric_limits<std::int64_t>::min(); }, kRange,
     "scanner.bidirectional_offset_ticks = -9223372036854775808"},
    {"FrequencyAboveTheMotionControl", [](Job& j) { j.rotary.interpolation_bits = 14; }, kRange,
     "rotary.interpolation_bits = 14: needs an A-B signal of 3610580.44 Hz, above rotary.max_ab_hz = 2000000; "
     "rotary.interpolation_bits <= 13, a rotary.gear ratio of at most 0.553927556, lines of at least 7057 slots "
     "(scanner.turn_slots >= 3557) or laser.pulse_divider >= 75 would fit"},
    {"FrequencyAboveTheCounter",
     [](Job& j) {
       j.rotary.interpolation_bits = 18;
       j.rotary.max_ab_hz = 1'000'000'000;
     },
     kRange,
     "above what the counter can emit, a quarter of the FPGA clock = 41000000 Hz (increment <= 2^(n-2)); "
     "rotary.interpolation_bits <= 17"},
    {"FrequencyThatNoKeyAloneBringsDown",
     [](Job& j) {
       j.laser.pulse_divider = 65'535;
       j.rotary.interpolation_bits = 18;
       j.rotary.encoder_lines = 1'000'000'000;
       j.rotary.max_ab_hz = 1;
     },
     kRange, "above rotary.max_ab_hz = 1; no single key within its range would fit"},
    {"PrescalerTooSmallForTheCap",
     [](Job& j) {
       j.fpga.counter_bits = 8;
       j.fpga.max_prescaler = 2;
       j.rotary.interpolation_bits = 0;
       j.rotary.max_ab_hz = 300;
     },
     kRange, "even 1 count every that many clocks is above"},
    {"FractionBeyond64Bits",
     [](Job& j) {
       j.fpga.fractional = true;
       j.fpga.counter_bits = 8;
       j.rotary.interpolation_bits = 0;
       j.rotary.encoder_lines = 1;
       j.rotary.gear_workpiece_turns = 999'983;
       j.laser.pulse_divider = 65'521;
     },
     kRange, "at most 2^64 - 1 fits the second accumulator", 30'000},
    {"SlotsOfALine", [](Job&) {}, kRange,
     "image.pixels_per_line = 20000000: a line takes 20000409 slots with turn_slots and max_extra_slots; the board "
     "counts "
     "16777215 at most: cut the picture into bands",
     20'000'000},
    {"TicksOfARevolution",
     [](Job& j) {
       j.laser.pulse_divider = 65'535;
       j.fpga.clock_multiplier = 16;
       j.rotary.line_pitch_um = ratio(1, 1000);
     },
     kRange,
     "rotary.line_pitch_um = 0.001: a revolution takes 230684699228753905440 FPGA ticks, beyond 64-bit integers; at "
     "most 8792631 lines per revolution fit",
     1'000'000},
    {"TicksOfTheJob", [](Job&) {}, kRange,
     "image.revolutions = 10000000000: the job takes 88112690820000000000 FPGA ticks, beyond 64-bit integers; at most "
     "1046769",
     3500, 10'000'000'000},
};

class MakePlanRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(MakePlanRefusal, SaysOnceWhatIsWrong) {
  Job job = roller_job();
  GetParam().change(job);
  const Result<Plan> plan = make_plan(job, GetParam().pixels, GetParam().revolutions);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, GetParam().code);
  EXPECT_NE(plan.error().message.find(GetParam().part), std::string::npos) << plan.error().message;
  EXPECT_EQ(std::count(plan.error().message.begin(), plan.error().message.end(), '\n'), 0) << plan.error().message;
}

INSTANTIATE_TEST_SUITE_P(EachValue, MakePlanRefusal, testing::ValuesIn(kRefusals),
                         [](const auto& refusal) { return refusal.param.name; });

TEST(MakePlan, SaysAllThatIsWrongEachOnALine) {
  Job job = roller_job();
  job.laser.pulse_divider = 4;
  job.fpga.counter_bits = 70;
  job.scanner.bidirectional_offset_ticks = 1'000'000;
  job.rotary.interpolation_bits = 20;
  job.limits.seam_um = 0;
  const Result<Plan> plan = make_plan(job, 3500, 10);
  ASSERT_FALSE(plan);
  const std::string& message = plan.error().message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 4) << message;
  for (const char* key : {"fpga.counter_bits = 70", "limits.seam_um = 0", "laser.pulse_divider = 4",
                          "scanner.bidirectional_offset_ticks = 1000000", "rotary.interpolation_bits = 20"}) {
    EXPECT_NE(message.find(key), std::string::npos) << message;
  }
}

TEST(MakePlan, SaysWhereInTheFileEachWrongKeyStands) {
  Job job = roller_job();
  job.path = "roller/job.toml";
  job.places = {{"laser", {4, 1}}, {"laser.pulse_divider", {6, 1}}, {"limits", {40, 1}}};
  job.laser.pulse_divider = 4;
  job.limits.seam_um = 0;
  const Result<Plan> plan = make_plan(job, 3500, 10);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("roller/job.toml:40:1: limits.seam_um = 0: "), std::string::npos);
  EXPECT_NE(plan.error().message.find("\nroller/job.toml:6:1: laser.pulse_divider = 4: "), std::string::npos)
      << plan.error().message;
}

/// What a refusal says would fit does fit, and one step less does not.
TEST(MakePlan, NamesWhatWouldFit) {
  Job job = roller_job();
  job.rotary.interpolation_bits = 14;
  for (const int bits : {13, 14}) {
    job.rotary.interpolation_bits = bits;
    EXPECT_EQ(static_cast<bool>(make_plan(job, 3500, 1)), bits == 13);
  }
  for (const std::int64_t turn : {3556, 3557}) {
    job.scanner.turn_slots = turn;
    EXPECT_EQ(static_cast<bool>(make_plan(job, 3500, 1)), turn == 3557);
  }
  job.scanner.turn_slots = 409;
  for (const std::int64_t divider : {74, 75}) {
    job.laser.pulse_divider = divider;
    EXPECT_EQ(static_cast<bool>(make_plan(job, 3500, 1)), divider == 75);
  }
}

}  // namespace
}  // namespace gravure
