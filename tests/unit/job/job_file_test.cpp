#include "gravure/formats/job_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "sample_job.hpp"

namespace gravure {
namespace {

/// A folder of its own that goes with the test.
class JobFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("gravure_job_" + std::to_string(getpid()) + "_" +
                                                        testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) const {
    const std::string path = (folder_ / "job.toml").string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  std::filesystem::path folder_;
};

TEST(Job, HoldsEveryValueOfTheSample) {
  const Result<Job> result = parse_job(sample_job(), "roller/job.toml");
  ASSERT_TRUE(result) << result.error().message;
  const Job& job = result.value();
  EXPECT_EQ(job.title, "honeycomb embossing roller");
  EXPECT_EQ(job.mode, Mode::rotary);
  EXPECT_EQ(job.laser.seed_hz, 82'000'000);
  EXPECT_EQ(job.laser.pulse_divider, 41);
  EXPECT_EQ(job.laser.max_pulse_on_demand_hz, 16'400'000);
  EXPECT_FALSE(job.laser.spot_um || job.laser.fluence_j_cm2 || job.laser.threshold_j_cm2 || job.laser.penetration_nm);
  EXPECT_EQ(job.fpga.clock_multiplier, 2);
  EXPECT_EQ(job.fpga.counter_bits, 32);
  EXPECT_FALSE(job.fpga.fractional);
  EXPECT_EQ(job.fpga.max_prescaler, 4'294'967'295U);
  EXPECT_EQ(job.scanner.pixel_pitch_um, Rational(8));
  EXPECT_EQ(job.scanner.slots_per_microvector, 20);
  EXPECT_EQ(job.scanner.turn_slots, 1800);
  EXPECT_EQ(job.scanner.max_extra_slots, 0);
  EXPECT_TRUE(job.scanner.bidirectional);
  EXPECT_EQ(job.scanner.bidirectional_offset_ticks, 0);
  EXPECT_EQ(job.rotary.diameter_mm, Rational(70));
  EXPECT_FALSE(job.rotary.circumference_mm);
  EXPECT_EQ(job.rotary.line_pitch_um, Rational(8));
  EXPECT_FALSE(job.rotary.lines_per_revolution);
  EXPECT_EQ(job.rotary.encoder_lines, 11840);
  EXPECT_EQ(job.rotary.interpolation_bits, 13);
  EXPECT_EQ(job.rotary.gear_encoder_turns, 1);
  EXPECT_EQ(job.rotary.gear_workpiece_turns, 1);
  EXPECT_EQ(job.rotary.max_ab_hz, 2'000'000);
  EXPECT_EQ(job.image.files, std::vector<std::string>{"layers/*.tif"});
  EXPECT_FALSE(job.image.depth_map || job.image.levels || job.image.depth_min || job.image.depth_max);
  EXPECT_FALSE(job.image.threshold || job.image.pixels_per_line);
  EXPECT_EQ(job.image.fires, Fires::white);
  EXPECT_EQ(job.image.lines_along, LinesAlong::rows);
  EXPECT_EQ(job.image.revolutions, 100);
  EXPECT_EQ(job.image.order, LayerOrder::sequence);
  EXPECT_EQ(job.limits.seam_um, Rational(1, 2));
  EXPECT_EQ(job.path, "roller/job.toml");
  EXPECT_EQ(job.text, sample_job());
}

TEST(Job, HoldsEveryValueThatTheSampleLeavesAtItsDefault) {
  const Result<Job> result = parse_job(R"(
[job]
mode = "rotary"
[laser]
seed_hz = 5_125_000
pulse_divider = 3
max_pulse_on_demand_hz = 7
spot_um = 12.5
fluence_j_cm2 = 2.25
threshold_j_cm2 = 0.5
penetration_nm = 30
[fpga]
clock_multiplier = 4
counter_bits = 64
fractional = true
max_prescaler = 9
[scanner]
pixel_pitch_um = 6
turn_slots = 11
slots_per_microvector = 12
max_extra_slots = 13
bidirectional = false
bidirectional_offset_ticks = -14
[rotary]
circumference_mm = 5.65
lines_per_revolution = 942
encoder_lines = 15
interpolation_bits = 0
gear = [16, 17]
max_ab_hz = 80_000
[image]
depth_map = "relief.exr"
levels = 18
depth_min = -0.5
depth_max = 0.25
fires = "black"
lines_along = "columns"
revolutions = 19
order = "hold"
pixels_per_line = 20
[limits]
seam_um = 1
)",
                                       "job.toml");
  ASSERT_TRUE(result) << result.error().message;
  const Job& job = result.value();
  EXPECT_EQ(job.title, "");
  EXPECT_EQ(job.laser.spot_um, Rational(25, 2));
  EXPECT_EQ(job.laser.fluence_j_cm2, Rational(9, 4));
  EXPECT_EQ(job.laser.threshold_j_cm2, Rational(1, 2));
  EXPECT_EQ(job.laser.penetration_nm, 30);
  EXPECT_TRUE(job.fpga.fractional);
  EXPECT_EQ(job.fpga.max_prescaler, 9U);
  EXPECT_EQ(job.scanner.max_extra_slots, 13);
  EXPECT_FALSE(job.scanner.bidirectional);
  EXPECT_EQ(job.scanner.bidirectional_offset_ticks, -14);
  EXPECT_FALSE(job.rotary.diameter_mm);
  EXPECT_EQ(job.rotary.circumference_mm, Rational(565, 100));
  EXPECT_FALSE(job.rotary.line_pitch_um);
  EXPECT_EQ(job.rotary.lines_per_revolution, 942);
  EXPECT_EQ(job.rotary.gear_encoder_turns, 16);
  EXPECT_EQ(job.rotary.gear_workpiece_turns, 17);
  EXPECT_TRUE(job.image.files.empty());
  EXPECT_EQ(job.image.depth_map, "relief.exr");
  EXPECT_EQ(job.image.levels, 18);
  EXPECT_EQ(job.image.depth_min, Rational(-1, 2));
  EXPECT_EQ(job.image.depth_max, Rational(1, 4));
  EXPECT_EQ(job.image.fires, Fires::black);
  EXPECT_EQ(job.image.lines_along, LinesAlong::columns);
  EXPECT_EQ(job.image.revolutions, 19);
  EXPECT_EQ(job.image.order, LayerOrder::hold);
  EXPECT_EQ(job.image.pixels_per_line, 20);
}

TEST(Job, TakesDocumentedDefaultsForWhatIsNotThere) {
  std::string text = sample_job();
  for (const char* key :
       {"title", "fractional", "max_prescaler", "slots_per_microvector", "max_extra_slots", "bidirectional  ",
        "bidirectional_offset_ticks", "gear", "lines_along", "revolutions", "order"}) {
    text = without_line(text, key);
  }
  const Result<Job> result = parse_job(text, "job.toml");
  ASSERT_TRUE(result) << result.error().message;
  const Job& job = result.value();
  EXPECT_EQ(job.title, "");
  EXPECT_FALSE(job.fpga.fractional);
  EXPECT_EQ(job.fpga.max_prescaler, 4'294'967'295U);
  EXPECT_EQ(job.scanner.slots_per_microvector, 1);
  EXPECT_EQ(job.scanner.max_extra_slots, 0);
  EXPECT_TRUE(job.scanner.bidirectional);
  EXPECT_EQ(job.scanner.bidirectional_offset_ticks, 0);
  EXPECT_EQ(job.rotary.gear_encoder_turns, 1);
  EXPECT_EQ(job.rotary.gear_workpiece_turns, 1);
  EXPECT_EQ(job.image.lines_along, LinesAlong::rows);
  EXPECT_FALSE(job.image.revolutions);
  EXPECT_EQ(job.image.order, LayerOrder::sequence);
}

TEST(Job, KnowsWhereEachKeyStands) {
  const std::string text = sample_job();
  const Result<Job> result = parse_job(text, "roller/job.toml");
  ASSERT_TRUE(result) << result.error().message;
  const Job& job = result.value();
  const auto place_of = [&](const std::string& what) {
    const auto at = static_cast<std::ptrdiff_t>(text.find(what));
    const auto line = std::count(text.begin(), text.begin() + at, '\n') + 1;
    const auto column = at - static_cast<std::ptrdiff_t>(text.rfind('\n', static_cast<std::size_t>(at)));
    return "roller/job.toml:" + std::to_string(line) + ":" + std::to_string(column) + ": ";
  };
  EXPECT_EQ(job.place_of("laser.seed_hz"), place_of("82_000_000"));
  EXPECT_EQ(job.place_of("limits.seam_um"), place_of("0.5"));
  EXPECT_EQ(job.place_of("image.pixels_per_line"), place_of("[image]")) << "left out: where its section stands";
  EXPECT_EQ(Job().place_of("laser.seed_hz"), "") << "a job made in memory has no places";
}

TEST(Job, MayBePlannedWithoutImages) {
  const Result<Job> result =
      parse_job(sample_with("files        = [\"layers/*.tif\"]", "pixels_per_line = 3500"), "job.toml");
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result.value().image.pixels_per_line, 3500);
  EXPECT_TRUE(result.value().image.files.empty());
}

TEST(Job, ReadsDottedKeysInlineTablesWindowsLinesAndByteOrderMark) {
  std::string text = sample_with("[limits]\nseam_um = 0.5\n", "");
  text = "\xEF\xBB\xBFlimits = { seam_um = 0.125 }\n" + text;
  std::string windows;
  for (const char c : text) {
    windows += c == '\n' ? "\r\n" : std::string(1, c);
  }
  const Result<Job> result = parse_job(windows, "job.toml");
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result.value().limits.seam_um, Rational(1, 8));
  const Result<Job> dotted = parse_job("limits.seam_um = 0.75\n" + sample_with("[limits]\nseam_um = 0.5\n", ""), "j");
  ASSERT_TRUE(dotted) << dotted.error().message;
  EXPECT_EQ(dotted.value().limits.seam_um, Rational(3, 4));
}

TEST(StarterJob, ParsesAndNeedsTheStatedImage) {
  const Result<Job> result = parse_job(starter_job(Mode::rotary), "job.toml");
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result.value().rotary.lines_per_revolution, kStarterLines);
  EXPECT_EQ(result.value().image.files, std::vector<std::string>{"layers/*.tif"});
  EXPECT_EQ(result.value().image.lines_along, LinesAlong::rows);
  EXPECT_FALSE(result.value().image.revolutions);
  // Whole microvectors without padding, so that the comments in the file tell the real line.
  EXPECT_EQ((kStarterPixels + result.value().scanner.turn_slots) % result.value().scanner.slots_per_microvector, 0);
}

TEST(StarterJob, OfEveryModeParsesAndNeedsTheSameImages) {
  for (const Mode mode : {Mode::rotary, Mode::helical, Mode::flat}) {
    const Result<Job> result = parse_job(starter_job(mode), "job.toml");
    ASSERT_TRUE(result) << result.error().message;
    const Job& job = result.value();
    EXPECT_EQ(job.mode, mode);
    EXPECT_EQ(mode == Mode::flat ? job.stage.lines : job.rotary.lines_per_revolution.value_or(0), kStarterLines);
    if (mode == Mode::helical) {
      EXPECT_EQ(job.carriage.layers, kStarterLayers);
      EXPECT_EQ(job.carriage.feed_pixels, Rational(16));
      EXPECT_EQ(job.carriage.encoder_pitch_um, Rational(20));
      EXPECT_EQ(job.carriage.interpolation_bits, 8);
      EXPECT_EQ(job.carriage.max_ab_hz, 2'000'000);
    }
    if (mode == Mode::flat) {
      EXPECT_EQ(job.stage.line_pitch_um, Rational(8));
      EXPECT_EQ(job.stage.encoder_pitch_um, Rational(20));
      EXPECT_EQ(job.stage.interpolation_bits, 8);
      EXPECT_EQ(job.stage.max_ab_hz, 2'000'000);
      EXPECT_EQ(job.scanner.field_mm, ratio(3, 10));
    } else {  // the scanner is described, so that plan, verify and report know where each pulse lands
      EXPECT_EQ(job.scanner.field_mm, Rational(20));
      EXPECT_TRUE(job.scanner.max_speed_mm_s && job.scanner.max_acceleration_mm_s2 && job.scanner.max_jerk_mm_s3);
    }
  }
}

TEST_F(JobFile, IsReadFromDisk) {
  const std::string path = write(sample_job());
  const Result<Job> result = read_job(path);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result.value().path, path);
  EXPECT_EQ(result.value().text, sample_job());
}

TEST_F(JobFile, IsRefusedWhenMissingOrAFolder) {
  const std::string missing = (folder_ / "none.toml").string();
  const Result<Job> none = read_job(missing);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::bad_file);
  EXPECT_NE(none.error().message.find(missing), std::string::npos);
  const Result<Job> folder = read_job(folder_.string());
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, ErrorCode::bad_file);
}

TEST_F(JobFile, IsRefusedWhenLargerThanAMebibyte) {
  const std::string filling = sample_job() + std::string(kMaxJobBytes - sample_job().size(), '\n');
  EXPECT_TRUE(read_job(write(filling)));
  for (const Result<Job>& result : {read_job(write(filling + "\n")), parse_job(filling + "\n", "job.toml")}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::bad_file);
    EXPECT_NE(result.error().message.find("1048577 bytes"), std::string::npos) << result.error().message;
    EXPECT_NE(result.error().message.find("1048576"), std::string::npos) << result.error().message;
  }
}

}  // namespace
}  // namespace gravure
