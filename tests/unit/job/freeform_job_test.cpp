#include "gravure/formats/freeform_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "gravure/formats/job_file.hpp"
#include "markdown_table.hpp"
#include "sample_job.hpp"

namespace gravure {
namespace {

std::string freeform_page() {
  std::ifstream file(GRAVURE_FREEFORM_DOC, std::ios::binary);
  EXPECT_TRUE(file) << GRAVURE_FREEFORM_DOC;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The starter with the first `from` in it replaced.
std::string starter_with(const std::string& from, const std::string& to) {
  std::string text = freeform_starter_job();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(FreeformDocument, HasTheReadersKeysAndNoOthers) {
  const std::vector<JobKey> known = freeform_job_keys();
  std::size_t i = 0;
  std::istringstream stream(freeform_page());
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("| `[", 0) != 0) {
      continue;
    }
    ASSERT_LT(i, known.size()) << line;
    const JobKey& key = known[i++];
    const std::vector<std::string> cells = test::cells_of(line);
    ASSERT_EQ(cells.size(), 7U) << line;
    EXPECT_EQ(cells[0], "[" + key.section + "]");
    EXPECT_EQ(cells[1], key.key);
    EXPECT_EQ(cells[2], key.type) << key.key;
    EXPECT_EQ(cells[3], key.unit) << key.key;
    EXPECT_EQ(cells[4], key.range) << key.key;
    EXPECT_EQ(cells[5], key.fallback) << key.key;
    EXPECT_FALSE(cells[6].empty()) << key.key;
  }
  EXPECT_EQ(i, known.size());
}

TEST(FreeformDocument, ShowsJobsThatParse) {
  const std::string text = freeform_page();
  int examples = 0;
  std::size_t end = 0;
  for (std::size_t at = text.find("```toml\n"); at != std::string::npos; at = text.find("```toml\n", end)) {
    end = text.find("```", at + 8);
    ASSERT_NE(end, std::string::npos);
    const auto job = parse_freeform_job(text.substr(at + 8, end - at - 8), "example");
    EXPECT_TRUE(job) << job.error().message;
    ++examples;
  }
  EXPECT_GE(examples, 2);
}

TEST(FreeformJob, ReadsTheStarter) {
  const auto job = parse_freeform_job(freeform_starter_job(), "dir/job.toml");
  ASSERT_TRUE(job) << job.error().message;
  const FreeformJob& got = job.value();
  EXPECT_EQ(got.job.title, "starter saddle");
  EXPECT_EQ(got.job.mode, Mode::freeform);
  EXPECT_EQ(got.job.laser.seed_hz, 82'000'000);
  EXPECT_EQ(got.job.fpga.clock_multiplier, 2);
  EXPECT_EQ(got.job.text, freeform_starter_job());
  EXPECT_EQ(got.texture.folder, "dir/");
  EXPECT_EQ(got.texture.surface, "0.02*x*y");
  EXPECT_EQ(got.texture.bitmap, "texture.tif");
  EXPECT_EQ(got.texture.pitch_um, 50.0);
  EXPECT_EQ(got.texture.run_out_um, 300);
  EXPECT_EQ(got.texture.fires, "white");
  EXPECT_EQ(got.split.method, "gaussian");
  EXPECT_EQ(got.split.rule, "time");
  EXPECT_FALSE(got.split.sigma_um);
  EXPECT_EQ(got.motion.servo_us, 50);
  EXPECT_EQ(got.motion.limits[0].acceleration, 100.0);
  EXPECT_FALSE(got.motion.limits[1].speed);
  EXPECT_EQ(got.job.place_of("texture.bitmap"), "dir/job.toml:" + place_of(got.job.text, "\"texture.tif\"") + ": ");
}

TEST(FreeformJob, TakesEveryKeyOfASurfaceAndTexture) {
  const auto job = parse_freeform_job(R"([job]
mode = "freeform"
[laser]
seed_hz = 80_000_000
pulse_divider = 40
max_pulse_on_demand_hz = 2_000_000
[fpga]
clock_multiplier = 1
[surface]
height_field = "/maps/map.tif"
pixel_um = 12.5
pixel_y_um = 20
height_mm = [-1, 3.5]
max_slope_deg = 45
[texture]
svg = "d.svg"
pitch_um = 8
step_um = 60
tolerance_um = 0.5
[split]
method = "adaptive"
sigma_um = 3000
cut = 4
focus_axis = true
[limits]
fod_um = 50
focus_mm = 1.5
bia_deg = 5
displacement_mm = 4
landing_um = 2
[clamping]
origin_mm = [1, 2, -3.25]
tilt_deg = [10, -5]
[motion]
signs = "post-processor"
branch = "negative"
stops = "points"
servo_us = 100
[axis.W]
max_speed_mm_s = 80
max_acceleration_mm_s2 = 2_000
max_jerk_mm_s3 = 1e5
servo_hz = 75
[axis.C]
max_speed_deg_s = 180
max_jerk_deg_s3 = 3600
servo_hz = 25.5
[axis.V]
servo_damping = 0.6
)",
                                      "job.toml");
  ASSERT_TRUE(job) << job.error().message;
  const FreeformJob& got = job.value();
  EXPECT_EQ(got.texture.folder, "");
  EXPECT_EQ(got.texture.height_mm, (std::vector<double>{-1, 3.5}));
  EXPECT_EQ(got.texture.pixel_y_um, 20.0);
  EXPECT_EQ(got.texture.max_slope_deg, 45);
  EXPECT_EQ(got.texture.svg, "d.svg");
  EXPECT_EQ(got.texture.step_um, 60.0);
  EXPECT_EQ(got.texture.tolerance_um, 0.5);
  EXPECT_EQ(got.split.sigma_um, 3000.0);
  EXPECT_EQ(got.split.cut, 4);
  EXPECT_EQ(got.split.fod_um, 50);
  EXPECT_EQ(got.split.bia_deg, 5);
  EXPECT_EQ(got.split.displacement_mm, 4);
  EXPECT_EQ(got.split.landing_um, 2.0);
  EXPECT_TRUE(got.split.focus_axis);
  EXPECT_EQ(got.split.focus_mm, 1.5);
  EXPECT_EQ(got.motion.limits[kFocusAxis].speed, 80.0);
  EXPECT_EQ(got.motion.limits[kFocusAxis].acceleration, 2000.0);
  EXPECT_EQ(got.motion.limits[kFocusAxis].jerk, 1e5);
  EXPECT_EQ(got.motion.servos[kFocusAxis].natural_hz, 75.0);
  EXPECT_EQ(got.axes.origin_mm, (std::vector<double>{1, 2, -3.25}));
  EXPECT_EQ(got.axes.tilt_deg, (std::vector<double>{10, -5}));
  EXPECT_EQ(got.axes.signs, "post-processor");
  EXPECT_EQ(got.axes.branch, "negative");
  EXPECT_EQ(got.motion.stops, "points");
  EXPECT_NEAR(*got.motion.limits[4].speed, 3.141592653589793, 1e-15);  // rad/s
  EXPECT_FALSE(got.motion.limits[4].acceleration);
  EXPECT_NEAR(*got.motion.limits[4].jerk, 62.83185307179586, 1e-13);
  EXPECT_EQ(got.motion.servos[4].natural_hz, 25.5);
  EXPECT_FALSE(got.motion.servos[4].damping);
  EXPECT_EQ(got.motion.servos[6].damping, 0.6);
}

struct Wrong {
  const char* name;
  std::string from, to;  ///< piece of the starter and what replaces it
  ErrorCode code;
  std::string at;    ///< piece of the bent text where the message must point
  std::string says;  ///< what the line says after the place, whole
};

void PrintTo(const Wrong& wrong, std::ostream* out) {
  *out << wrong.name;
}

class FreeformRefusal : public testing::TestWithParam<Wrong> {};

TEST_P(FreeformRefusal, NamesPlaceKeyValueAndRange) {
  const Wrong& wrong = GetParam();
  const std::string text = starter_with(wrong.from, wrong.to);
  const auto job = parse_freeform_job(text, "dir/job.toml");
  ASSERT_FALSE(job);
  EXPECT_EQ(job.error().code, wrong.code);
  EXPECT_EQ(job.error().message, "dir/job.toml:" + place_of(text, wrong.at) + ": " + wrong.says);
}

constexpr ErrorCode kNotSo = ErrorCode::bad_argument;
constexpr ErrorCode kOutside = ErrorCode::out_of_range;

const Wrong kWrongs[] = {
    {"MisspeltKey", "pitch_um  ", "ptich_um  ", kNotSo, "ptich_um",
     "[texture] ptich_um = 50: unknown key; did you mean pitch_um?"},
    {"KeyOfAnotherSection", "[split]", "[split]\nfod_um = 3", kNotSo, "fod_um = 3",
     "[split] fod_um = 3: unknown key; it belongs in [limits]"},
    {"MisspeltSection", "[split]", "[spilt]\n[split]", kNotSo, "[spilt]",
     "[spilt]: unknown section; did you mean [split]?"},
    {"AxisOfNoMachine", "[axis.X]", "[axis.B]", kNotSo, "[axis.B]",
     "[axis.B]: unknown section; did you mean [axis.X]?"},
    {"DegreesOfALinearAxis", "max_speed_mm_s ", "max_speed_deg_s", kNotSo, "max_speed_deg_s",
     "[axis.X] max_speed_deg_s = 100: unknown key; it belongs in [axis.A]"},
    {"SizeOutOfRange", "pitch_um      = 50 ", "pitch_um      = -7 ", kOutside, "-7 ",
     "[texture] pitch_um = -7: must be a number from 0.000_001 to 1_000_000_000 um"},
    {"DivisorBeyondItsBits", "pulse_divider = 41 ", "pulse_divider = 65_536 ", kOutside, "65_536",
     "[laser] pulse_divider = 65_536: must be an integer from 1 to 65_535 seed pulses"},
    {"WordOfNoMethod", "\"gaussian\"", "\"gausian\"", kNotSo, "\"gausian\"",
     "[split] method = \"gausian\": must be \"gaussian\", \"savitzky-golay\", \"fft\", \"adaptive\" or \"optimal\"; "
     "did "
     "you mean \"gaussian\"?"},
    {"NoSurface", "expression    = \"0.02*x*y\"", "", kNotSo, "[surface]",
     "[surface] expression, height_field or mesh is missing: give one of them"},
    {"TwoSurfaces", "max_slope_deg = 60", "mesh = \"a.stl\"", kNotSo, "mesh = \"a.stl\"",
     "[surface] mesh = \"a.stl\": contradicts expression = \"0.02*x*y\" (line 22); give one of expression, "
     "height_field or mesh"},
    {"HeightFieldWithoutPixels", "expression    = \"0.02*x*y\"", "height_field = \"a.tif\"", kNotSo, "[surface]",
     "[surface] pixel_um is missing: height_field needs a number from 0.000_001 to 1_000_000_000 um"},
    {"PixelsOfAnExpression", "max_slope_deg = 60", "pixel_um = 5", kNotSo, "pixel_um = 5",
     "[surface] pixel_um = 5: has a meaning only with height_field; take it out"},
    {"BitmapWithoutPolarity", "fires         = \"white\"", "", kNotSo, "[texture]",
     "[texture] fires is missing: bitmap needs \"white\" or \"black\""},
    {"SizeOfABitmap", "pitch_um      = 50 ", "pitch_um      = 50\nsize_mm = 3 ", kNotSo, "size_mm",
     "[texture] size_mm = 3: has a meaning only with hilbert_order; take it out"},
    {"RuleWithSigma", "rule   = \"time\"", "sigma_um = 5000\nrule   = \"time\"", kNotSo, "rule   = \"time\"",
     "[split] rule = \"time\": has no meaning with sigma_um (line 34); take one of them out"},
    {"FocusAxisNobodyAskedFor", "[motion]", "[axis.W]\nservo_hz = 50\n[motion]", kNotSo, "[axis.W]",
     "[axis.W]: has a meaning only with [split] focus_axis = true; take it out"},
    {"ReachOfNoFocusAxis", "fod_um          = 100 ", "focus_mm = 2 ", kNotSo, "focus_mm",
     "[limits] focus_mm = 2: has a meaning only with [split] focus_axis = true; take it out"},
    {"OriginOfTwo", "[motion]", "[clamping]\norigin_mm = [1, 2]\n[motion]", kNotSo, "[1, 2]",
     "[clamping] origin_mm = [1, 2]: must be [x, y, z], three numbers from -1_000 to 1_000 mm"},
    {"TiltBeyondATurn", "[motion]", "[clamping]\ntilt_deg = [0, 190]\n[motion]", kOutside, "190",
     "[clamping] tilt_deg = [0, 190]: must be [first, second], two numbers from -180 to 180 deg"},
    {"NoClock", "clock_multiplier = 2 ", "", kNotSo, "[fpga]",
     "[fpga] clock_multiplier is missing: give an integer from 1 to 16 FPGA ticks per seed pulse"},
    {"ModeOfOthers", "\"freeform\"", "\"flat\"", kNotSo, "\"flat\"",
     "[job] mode = \"flat\": must be \"freeform\"; the nearest known one is \"freeform\""},
    {"LooseKey", "[job]", "mode = 3\n[job]", kNotSo, "mode = 3",
     "mode = 3: unknown key outside every section; it belongs in [job]"},
};
std::string wrong_name(const testing::TestParamInfo<Wrong>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Files, FreeformRefusal, testing::ValuesIn(kWrongs), wrong_name);

TEST(FreeformJob, WantsTheLimitsOfItsFocusAxis) {
  std::string text = starter_with("[split]", "[split]\nfocus_axis = true");
  const auto none = parse_freeform_job(text, "job.toml");
  ASSERT_FALSE(none);
  const std::string place = "job.toml:" + place_of(text, "focus_axis") + ": ";
  for (const char* key : {"max_speed_mm_s", "max_acceleration_mm_s2", "max_jerk_mm_s3"}) {
    EXPECT_NE(none.error().message.find(place + "[axis.W] " + key + " is missing: focus_axis needs a number"),
              std::string::npos)
        << none.error().message;
  }
  text += "\n[axis.W]\nmax_speed_mm_s = 80\nmax_jerk_mm_s3 = 1e5\n";
  const auto two = parse_freeform_job(text, "job.toml");
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().message.find("job.toml:" + place_of(text, "[axis.W]") + ": [axis.W] max_acceleration_mm_s2"),
            0U)
      << two.error().message;
  EXPECT_TRUE(parse_freeform_job(text + "max_acceleration_mm_s2 = 2000\n", "job.toml"));
}

TEST(FreeformJob, TellsAllThatIsMissing) {
  const auto job = parse_freeform_job("[job]\nmode = \"freeform\"\n[texture]\npath = \"p.csv\"\n", "j.toml");
  ASSERT_FALSE(job);
  EXPECT_EQ(job.error().message,
            "j.toml:3:1: [texture] pitch_um is missing: give a number from 0.000_001 to 1_000_000_000 um\n"
            "j.toml:3:1: [texture] step_um is missing: path needs a number from 0.000_001 to 1_000_000_000 um\n"
            "j.toml:5:1: section [laser] is missing: it needs seed_hz, pulse_divider, max_pulse_on_demand_hz\n"
            "j.toml:5:1: section [fpga] is missing: it needs clock_multiplier\n"
            "j.toml:5:1: section [surface] is missing: it needs one of expression, height_field and mesh");
}

TEST(FreeformJob, IsRefusedWhereItIsNoToml) {
  const auto job = parse_freeform_job("[job\n", "j.toml");
  ASSERT_FALSE(job);
  EXPECT_EQ(job.error().message.rfind("j.toml:1:", 0), 0U) << job.error().message;
  EXPECT_FALSE(parse_freeform_job(std::string(kMaxJobBytes + 1, '#'), "j.toml"));
}

TEST(FreeformJob, IsToldByItsMode) {
  EXPECT_EQ(mode_of_job_text(freeform_starter_job()), Mode::freeform);
  EXPECT_EQ(mode_of_job_text("job.mode = \"zones\""), Mode::zones);
  EXPECT_EQ(mode_of_job_text(starter_job(Mode::flat)), Mode::flat);
  for (const char* text : {"", "[job", "[job]\nmode = 3", "[job]\nmode = \"spiral\"", "job = \"freeform\""}) {
    EXPECT_FALSE(mode_of_job_text(text)) << text;
  }
}

}  // namespace
}  // namespace gravure
