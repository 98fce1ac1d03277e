#include "gravure/formats/zones_job.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "gravure/formats/job_file.hpp"
#include "markdown_table.hpp"

namespace gravure {
namespace {

const std::string kEveryKey = R"([job]
title = "core"
mode = "zones"
[contours]
file = "c.json"
transform = "t.json"
[zones]
method = "kmeans"
max_incidence_deg = 4.5
k = 10
normalised = false
seed = 7
[beam]
wavelength_um = 1.03
m_squared = 1.1
diameter_mm = 6
focal_length_mm = 100
fluence_share = 0.97
average_power_w = 2
threshold_j_cm2 = 0.5
[laser]
seed_hz = 82_000_000
pulse_divider = 41
[fpga]
clock_multiplier = 4
[marking]
pulse_pitch_um = 2.5
mark_speed_mm_s = 150
jump_speed_mm_s = 900
servo_us = 25
[machine]
file = "m.toml"
field_mm = 55.5
[limits]
landing_um = 0.7
)";

const std::string kLeast =
    "[job]\nmode = \"zones\"\n[contours]\nfile = \"c.json\"\n[zones]\nmax_incidence_deg = 5\nlayer_mm = 0.1\n"
    "[laser]\nseed_hz = 1000\npulse_divider = 1\n[marking]\npulse_pitch_um = 1\nmark_speed_mm_s = 1\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ZonesJob, EveryKeyArrivesWhereItBelongs) {
  const auto read = parse_zones_job(kEveryKey, "j.toml");
  ASSERT_TRUE(read) << read.error().message;
  const ZonesJob& job = read.value();
  EXPECT_EQ(job.job.title, "core");
  EXPECT_EQ(job.contours, "c.json");
  EXPECT_EQ(job.transform, "t.json");
  EXPECT_TRUE(job.by_kmeans);
  EXPECT_EQ(job.clusters, 10U);
  EXPECT_FALSE(job.normalised);
  EXPECT_EQ(job.seed, 7U);
  EXPECT_EQ(job.max_incidence_deg, ratio(9, 2));
  EXPECT_FALSE(job.layer_mm);
  ASSERT_TRUE(job.beam);
  EXPECT_EQ(job.beam->wavelength_um, ratio(103, 100));
  EXPECT_EQ(job.beam->m_squared, ratio(11, 10));
  EXPECT_EQ(job.beam->diameter_mm, 6);
  EXPECT_EQ(job.beam->focal_length_mm, 100);
  EXPECT_EQ(job.beam->fluence_share, ratio(97, 100));
  EXPECT_EQ(job.beam->average_power_w, 2);
  EXPECT_EQ(job.beam->threshold_j_cm2, ratio(1, 2));
  EXPECT_EQ(job.job.laser.seed_hz, 82'000'000);
  EXPECT_EQ(job.job.laser.pulse_divider, 41);
  EXPECT_EQ(job.job.fpga.clock_multiplier, 4);
  EXPECT_EQ(job.servo_us, 25);
  EXPECT_EQ(job.pulse_pitch_um, ratio(5, 2));
  EXPECT_EQ(job.mark_speed_mm_s, 150);
  EXPECT_EQ(job.jump_speed_mm_s, Rational(900));
  EXPECT_EQ(job.machine, "m.toml");
  EXPECT_EQ(job.field_mm, ratio(111, 2));
  EXPECT_EQ(job.max_landing_um, ratio(7, 10));
}

TEST(ZonesJob, TakesTheDefaultsOfTheTable) {
  const auto read = parse_zones_job(kLeast, "j.toml");
  ASSERT_TRUE(read) << read.error().message;
  const ZonesJob& job = read.value();
  EXPECT_TRUE(job.job.title.empty() && job.transform.empty() && job.machine.empty());
  EXPECT_FALSE(job.by_kmeans || job.beam || job.jump_speed_mm_s || job.field_mm || job.max_landing_um);
  EXPECT_EQ(job.layer_mm, ratio(1, 10));
  EXPECT_EQ(job.job.fpga.clock_multiplier, 2);
  EXPECT_EQ(job.servo_us, 50);
}

struct ZonesRefusal {
  std::string from;
  std::string to;
  std::string place;
  std::string says;
  ErrorCode code = ErrorCode::bad_argument;
};

TEST(ZonesJob, NamesLineAndColumnOfWhatIsWrong) {
  const ZonesRefusal refusals[] = {
      {"layer_mm = 0.1", "layer_mm = 0", "j.toml:7:12: ", "[zones] layer_mm = 0: must be a number from 0.0001",
       ErrorCode::out_of_range},
      {"layer_mm = 0.1", "layer_mm = \"thin\"", "j.toml:7:12: ", "must be a number"},
      {"layer_mm = 0.1", "layer_mm = 0.1\nlayer_um = 100", "j.toml:8:1: ", "unknown key; did you mean layer_mm?"},
      {"layer_mm = 0.1", "", "j.toml:5:1: ", "or [beam] with fluence_share"},
      {"max_incidence_deg = 5", "", "j.toml:5:1: ", "[zones] max_incidence_deg is missing"},
      {"layer_mm = 0.1", "layer_mm = 0.1\nk = 3", "j.toml:8:1: ", "belongs to method = \"kmeans\""},
      {"\"zones\"", "\"rotary\"", "j.toml:2:8: ", "must be \"zones\""},
      {"[zones]", "[zone]", "j.toml:5:1: ", "unknown section; did you mean [zones]?"},
      {"[job]", "depth = 3\n[job]", "j.toml:1:1: ", "unknown key outside every section"},
      {"\"c.json\"", "\"\"", "j.toml:4:8: ", "must be a string of 1 to 4095 bytes"},
      {"[laser]", "[beam]\nfocal_length_mm = 100\n[laser]", "j.toml:8:1: ", "[beam] wavelength_um is missing"},
      {"[job]", "[job", "j.toml:1:", "not TOML"},
  };
  for (const ZonesRefusal& refusal : refusals) {
    const auto read = parse_zones_job(with(kLeast, refusal.from, refusal.to), "j.toml");
    ASSERT_FALSE(read) << refusal.to;
    const std::string& message = read.error().message;
    EXPECT_EQ(message.rfind(refusal.place, 0), 0U) << message;
    EXPECT_NE(message.find(refusal.says), std::string::npos) << message;
    EXPECT_EQ(read.error().code, refusal.code) << message;
  }
}

TEST(ZonesJob, RefusesTwoThicknessesAndHalfAThreshold) {
  const auto both = parse_zones_job(with(kEveryKey, "k = 10", "k = 10\nlayer_mm = 0.1"), "j.toml");
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().message.rfind("j.toml:11:1: [zones] layer_mm: [beam] fluence_share decides", 0), 0U)
      << both.error().message;
  const auto half = parse_zones_job(with(kEveryKey, "threshold_j_cm2 = 0.5", ""), "j.toml");
  ASSERT_FALSE(half);
  EXPECT_NE(half.error().message.find("belong together"), std::string::npos) << half.error().message;
}

TEST(ZonesJob, RefusesHugeText) {
  EXPECT_EQ(parse_zones_job(std::string(kMaxJobBytes + 1, '#'), "j.toml").error().code, ErrorCode::bad_file);
}

TEST(ZonesJob, StarterIsAJobWithContoursOfLengthOneDirections) {
  const auto read = parse_zones_job(starter_zones_job(), "job.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read.value().contours, "contours.json");
  const std::vector<Contour> contours = starter_contours();
  ASSERT_EQ(contours.size(), 12U);
  for (const Contour& contour : contours) {
    EXPECT_NEAR(std::hypot(contour.direction[1], contour.direction[2]), 1, 1e-6);
  }
}

TEST(ZonesJobDocument, HasTheReadersKeysAndNoOthers) {
  const std::vector<JobKey> known = zones_job_keys();
  std::size_t row = 0;
  std::ifstream stream(GRAVURE_ZONES_JOB_DOC);
  ASSERT_TRUE(stream) << GRAVURE_ZONES_JOB_DOC;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("| `[", 0) != 0) {
      continue;
    }
    const std::vector<std::string> cells = test::cells_of(line);
    ASSERT_EQ(cells.size(), 7U) << line;
    ASSERT_LT(row, known.size()) << line;
    const JobKey& key = known[row++];
    std::string fallback;
    for (const char c : key.fallback) {
      fallback += c == '`' ? "" : std::string(1, c);
    }
    const std::vector<std::string> expected = {
        "[" + key.section + "]", key.key, key.type, key.unit, key.range, fallback};
    EXPECT_EQ(std::vector<std::string>(cells.begin(), cells.begin() + 6), expected);
  }
  EXPECT_EQ(row, known.size());
}

}  // namespace
}  // namespace gravure
