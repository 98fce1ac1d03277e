#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "gravure/formats/job_file.hpp"
#include "gravure/formats/job_keys.hpp"
#include "sample_job.hpp"

namespace gravure {
namespace {

constexpr ErrorCode kBad = ErrorCode::bad_argument;
constexpr ErrorCode kRange = ErrorCode::out_of_range;

std::vector<std::string> lines_of(const std::string& message) {
  std::vector<std::string> lines;
  std::istringstream stream(message);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// One thing wrong with the sample, and the one line that must say so.
struct Refusal {
  const char* name;
  std::string from, to;  ///< piece of the sample and what replaces it
  ErrorCode code;
  std::string at;    ///< piece of the bent text where the message must point
  std::string says;  ///< what the line says after the place, whole
};

void PrintTo(const Refusal& refusal, std::ostream* out) {
  *out << refusal.name;
}

class JobRefusal : public testing::TestWithParam<Refusal> {};

TEST_P(JobRefusal, NamesPlaceKeyValueAndRange) {
  const Refusal& refusal = GetParam();
  const std::string text = sample_with(refusal.from, refusal.to);
  const Result<Job> result = parse_job(text, "dir/job.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, refusal.code);
  EXPECT_EQ(result.error().message, "dir/job.toml:" + place_of(text, refusal.at) + ": " + refusal.says);
}

std::string name_of(const testing::TestParamInfo<Refusal>& info) {
  return info.param.name;
}

const Refusal kNames[] = {
    {"UnknownKeyNearAKnownOne", "seed_hz ", "sede_hz = 1\nseed_hz ", kBad, "sede_hz",
     "[laser] sede_hz = 1: unknown key; did you mean seed_hz?"},
    {"UnknownKeyOfAnotherSection", "[fpga]", "[fpga]\nseed_hz = 1", kBad, "seed_hz = 1",
     "[fpga] seed_hz = 1: unknown key; it belongs in [laser]"},
    {"UnknownKeyNearOneOfAnotherSection", "[fpga]", "[fpga]\nseed_khz = 1", kBad, "seed_khz",
     "[fpga] seed_khz = 1: unknown key; did you mean [laser] seed_hz?"},
    {"UnknownKeyLikeNone", "[limits]", "[limits]\nxyzzyplughxyzzy = [1,\n2]", kBad, "xyzzyplughxyzzy",
     "[limits] xyzzyplughxyzzy = [1,...: unknown key; the nearest known one is seam_um"},
    {"UnknownSubsection", "[limits]", "[rotary.motor]\npoles = 4\n[limits]", kBad, "motor]",
     "[rotary] motor = [rotary.motor]: unknown key; the nearest known one is gear"},
    {"UnknownSection", "[limits]", "[limit]\nx = 1\n[limits]", kBad, "[limit]",
     "[limit]: unknown section; did you mean [limits]?"},
    {"KeyOutsideEverySection", "[job]\n", "fires = \"white\"\n[job]\n", kBad, "fires",
     "fires = \"white\": unknown key outside every section; it belongs in [image]"},
    {"SectionThatIsAValue", "[limits]\nseam_um = 0.5\n", "[[limits]]\nseam_um = 0.5\n", kBad, "limits]]",
     "limits = [[limits]]: must be a section [limits], not a list"},
    {"MissingKey", "encoder_lines      = 11840\n", "", kBad, "[rotary]",
     "[rotary] encoder_lines is missing: give an integer from 1 to 1_000_000_000 lines per encoder turn"},
    {"MissingPolarity", "fires        = \"white\"", "", kBad, "[image]",
     "[image] fires is missing: give \"white\" or \"black\", the pixels that get a pulse; polarity is never assumed"},
};
INSTANTIATE_TEST_SUITE_P(Names, JobRefusal, testing::ValuesIn(kNames), name_of);

const Refusal kTypes[] = {
    {"StringForInteger", "= 82_000_000", "= \"82 MHz\"", kBad, "\"82 MHz\"",
     "[laser] seed_hz = \"82 MHz\": must be an integer from 1 to 10_000_000_000 Hz, not a string"},
    {"DecimalForInteger", "= 82_000_000", "= 82e6", kBad, "82e6",
     "[laser] seed_hz = 82e6: must be an integer from 1 to 10_000_000_000 Hz, not a decimal number"},
    {"DateForDecimal", "seam_um = 0.5", "seam_um = 1979-05-27", kBad, "1979",
     "[limits] seam_um = 1979-05-27: must be a number from 0.000_001 to 1_000_000 um, not a date or time"},
    {"ListForInteger", "= 11840", "= [11840]", kBad, "[11840]",
     "[rotary] encoder_lines = [11840]: must be an integer from 1 to 1_000_000_000 lines per encoder turn, "
     "not a list"},
    {"IntegerForBoolean", "fractional       = false", "fractional = 0", kBad, "0      # the counter",
     "[fpga] fractional = 0: must be true or false, not an integer"},
    {"StringForList", "[\"layers/*.tif\"]", "\"layers/*.tif\"", kBad, "\"layers/*.tif\"",
     "[image] files = \"layers/*.tif\": must be a list of one or more file patterns such as [\"layers/*.tif\"], each "
     "1 to 4095 bytes, no control characters, not a string"},
    {"EmptyList", "[\"layers/*.tif\"]", "[]", kBad, "[]",
     "[image] files = []: must be a list of one or more file patterns such as [\"layers/*.tif\"], each 1 to 4095 "
     "bytes, no control characters"},
    {"IntegerInList", "[\"layers/*.tif\"]", "[\"a\", 7]", kBad, "7]",
     "[image] files = [\"a\", 7]: must be a list of one or more file patterns such as [\"layers/*.tif\"], each 1 to "
     "4095 bytes, no control characters; 7 is an integer"},
    {"EmptyStringInList", "[\"layers/*.tif\"]", "[\"\"]", kBad, "\"\"]",
     "[image] files = [\"\"]: must be a list of one or more file patterns such as [\"layers/*.tif\"], each 1 to 4095 "
     "bytes, no control characters"},
    {"NulInPath", "[\"layers/*.tif\"]", "[\"a\\u0000\"]", kBad, "\"a\\u0000\"",
     "[image] files = [\"a\\u0000\"]: must be a list of one or more file patterns such as [\"layers/*.tif\"], each 1 "
     "to 4095 bytes, no control characters"},
    {"LineFeedInTitle", "\"honeycomb embossing roller\"", "\"a\\nb\"", kBad, "\"a\\nb\"",
     "[job] title = \"a\\nb\": must be a string of at most 200 bytes, no control characters"},
    {"UnknownWord", "fires        = \"white\"", "fires = \"White\"", kBad, "\"White\"",
     "[image] fires = \"White\": must be \"white\" or \"black\"; did you mean \"white\"?"},
    {"WordOfManyLetters", "\"sequence\" ", "\"sequenze\" ", kBad, "\"sequenze\"",
     "[image] order = \"sequenze\": must be \"sequence\", \"cycle\" or \"hold\"; did you mean \"sequence\"?"},
    {"GearOfOneNumber", "[1, 1]", "[1]", kBad, "[1]",
     "[rotary] gear = [1]: must be [encoder turns, workpiece turns], two integers from 1 to 1_000_000"},
    {"GearOfDecimals", "[1, 1]", "[1.5, 1]", kBad, "[1.5, 1]",
     "[rotary] gear = [1.5, 1]: must be [encoder turns, workpiece turns], two integers from 1 to 1_000_000"},
};
INSTANTIATE_TEST_SUITE_P(Types, JobRefusal, testing::ValuesIn(kTypes), name_of);

const Refusal kRanges[] = {
    {"CounterTooNarrow", "= 32 ", "= 7 ", kRange, "7 ",
     "[fpga] counter_bits = 7: must be an integer from 8 to 64 bits"},
    {"CounterTooWide", "= 32 ", "= 65 ", kRange, "65 ",
     "[fpga] counter_bits = 65: must be an integer from 8 to 64 bits"},
    {"NoPitch", "line_pitch_um      = 8.0", "line_pitch_um = 0", kRange, "0      # or lines",
     "[rotary] line_pitch_um = 0: must be a number from 0.001 to 10_000 um"},
    {"NegativeTurn", "= 1800", "= -1", kRange, "-1 ",
     "[scanner] turn_slots = -1: must be an integer from 0 to 10_000_000 pulse slots"},
    {"GearOfNothing", "[1, 1]", "[1, 0]", kRange, "0]",
     "[rotary] gear = [1, 0]: must be [encoder turns, workpiece turns], two integers from 1 to 1_000_000"},
    {"ThresholdOfNothing", "order ", "threshold = 0\norder ", kRange, "0\norder",
     "[image] threshold = 0: must be an integer from 1 to 65_535"},
    {"ThresholdBeyondSamples", "order ", "threshold = 65536\norder ", kRange, "65536",
     "[image] threshold = 65536: must be an integer from 1 to 65_535"},
};
INSTANTIATE_TEST_SUITE_P(Ranges, JobRefusal, testing::ValuesIn(kRanges), name_of);

const Refusal kContradictions[] = {
    {"TwoSizes", "encoder_lines ", "circumference_mm = 220\nencoder_lines ", kBad, "circumference_mm = 220",
     "[rotary] circumference_mm = 220: contradicts diameter_mm = 70.0 (line 25); give either diameter_mm or "
     "circumference_mm"},
    {"NoSize", "diameter_mm        = 70.0", "", kBad, "[rotary]",
     "[rotary] diameter_mm or circumference_mm is missing: give one of them"},
    {"TwoPitches", "diameter_mm ", "lines_per_revolution = 27489\ndiameter_mm ", kBad, "line_pitch_um      =",
     "[rotary] line_pitch_um = 8.0: contradicts lines_per_revolution = 27489 (line 25); give either line_pitch_um or "
     "lines_per_revolution"},
    {"NoPitch", "line_pitch_um      = 8.0", "", kBad, "[rotary]",
     "[rotary] line_pitch_um or lines_per_revolution is missing: give one of them"},
    {"NoImage", "files        = [\"layers/*.tif\"]", "", kBad, "[image]",
     "[image] files or depth_map is missing: give one of them (pixels_per_line alone is enough to plan)"},
    {"FilesAndDepthMap", "fires ", "depth_map = \"d.png\"\nlevels = 100\nfires ", kBad, "depth_map",
     "[image] depth_map = \"d.png\": contradicts files = [\"layers/*.tif\"] (line 33); give either files or depth_map"},
    {"DepthMapWithoutLevels", "files        = [\"layers/*.tif\"]", "depth_map = \"d.png\"", kBad, "depth_map",
     "[image] depth_map = \"d.png\": needs levels, the number of layers to slice into"},
    {"LevelsWithoutDepthMap", "fires ", "levels = 100\nfires ", kBad, "levels",
     "[image] levels = 100: has a meaning only with depth_map"},
    {"DepthMinWithoutDepthMap", "fires ", "depth_min = 0.5\nfires ", kBad, "depth_min",
     "[image] depth_min = 0.5: has a meaning only with depth_map"},
    {"DepthMaxWithoutDepthMap", "fires ", "depth_max = 0.5\nfires ", kBad, "depth_max",
     "[image] depth_max = 0.5: has a meaning only with depth_map"},
    {"ThresholdWithDepthMap", "files        = [\"layers/*.tif\"]",
     "depth_map = \"d.png\"\nlevels = 100\nthreshold = 128", kBad, "threshold",
     "[image] threshold = 128: contradicts depth_map = \"d.png\" (line 33); a depth map is sliced into levels, never "
     "thresholded"},
    {"DepthsThatAreEqual", "files        = [\"layers/*.tif\"]",
     "depth_map = \"d.exr\"\nlevels = 100\ndepth_min = 0.5\ndepth_max = 0.50", kBad, "depth_max",
     "[image] depth_max = 0.50: contradicts depth_min = 0.5 (line 35); depth_min and depth_max must differ"},
    {"DepthMaxEqualToTheDefaultMin", "files        = [\"layers/*.tif\"]",
     "depth_map = \"d.exr\"\nlevels = 100\ndepth_max = 0.0", kBad, "depth_max",
     "[image] depth_max = 0.0: must differ from depth_min, which is 0 where not given"},
    {"ServoWithoutBandwidth", "[image]", "[twin.servo]\nenabled = true\n\n[image]", kBad, "[twin.servo]",
     "[twin.servo] bandwidth_hz is missing: give the natural frequency of the axis in Hz, or take out enabled = true"},
    {"TermOfNoBudget", "[image]", "[twin.srvo]\nenabled = true\n\n[image]", kBad, "[twin.srvo]",
     "[twin.srvo]: unknown section; did you mean [twin.servo]?"},
    {"LevelsThatAreNotRevolutions", "files        = [\"layers/*.tif\"]", "depth_map = \"d.png\"\nlevels = 99", kBad,
     "revolutions ",
     "[image] revolutions = 100: contradicts levels = 99 (line 34); order = \"sequence\" needs one layer per "
     "revolution; say order = \"cycle\" or \"hold\", or make them equal"},
    {"ModeWithKeysOfItsOwn", "\"rotary\"", "\"freeform\"", kBad, "\"freeform\"",
     "[job] mode = \"freeform\": must be \"rotary\", \"helical\" or \"flat\" here; use `gravure plan`, `compile` and "
     "`verify` for this job"},
    {"CarriageOfARotaryJob", "[image]", "[carriage]\nlayers = 0\n[image]", kBad, "[carriage]",
     "[carriage]: only mode = \"helical\" has this section, not mode = \"rotary\": take it out, or set that mode"},
    {"StageOfARotaryJob", "[image]", "[stage]\nlines = 10\n[image]", kBad, "[stage]",
     "[stage]: only mode = \"flat\" has this section, not mode = \"rotary\": take it out, or set that mode"},
    {"ModeOfNoVersion", "\"rotary\"", "\"rotery\"", kBad, "\"rotery\"",
     "[job] mode = \"rotery\": must be \"rotary\", \"helical\" or \"flat\"; did you mean \"rotary\"?"},
};
INSTANTIATE_TEST_SUITE_P(Contradictions, JobRefusal, testing::ValuesIn(kContradictions), name_of);

TEST(JobSyntax, IsRefusedWithPlaceAndLine) {
  const std::string text = sample_with("seed_hz       = 82_000_000", "seed_hz = 82 MHz");
  const Result<Job> result = parse_job(text, "job.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, kBad);
  EXPECT_EQ(result.error().message.find("job.toml:6:14: not TOML: "), 0U) << result.error().message;
  EXPECT_NE(result.error().message.find("in: seed_hz = 82 MHz"), std::string::npos) << result.error().message;
}

TEST(JobSyntax, RefusesAnIntegerBeyond64BitsByItsLine) {
  const Result<Job> result = parse_job(sample_with("= 82_000_000", "= 99999999999999999999"), "job.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, kBad);
  EXPECT_EQ(result.error().message.find("job.toml:6:"), 0U) << result.error().message;
  EXPECT_NE(result.error().message.find("seed_hz"), std::string::npos) << result.error().message;
}

TEST(JobSyntax, RefusesAKeyGivenTwiceAtTheSecond) {
  const Result<Job> result = parse_job(sample_with("[limits]", "[limits]\nseam_um = 1"), "job.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message.find("job.toml:41:"), 0U) << result.error().message;
}

TEST(JobSyntax, RefusesBadUtf8AndNestingWithoutEnd) {
  std::string dotted = "a";
  for (int i = 0; i < 300'000; ++i) {
    dotted += ".a";
  }
  for (const std::string& text :
       {std::string("[\n"), std::string("[[\n"), std::string("[ =\n"), std::string("[job]\ntitle = \"\xFF\"\n"),
        dotted + " = 1\n", "[" + dotted + "]\n", "x = {" + dotted + " = 1}\n", "# \"\n'''' = '\"' \n" + dotted,
        "x = " + std::string(100'000, '['), "s = '''\n'\\''' \n" + dotted + "=1"}) {
    const Result<Job> result = parse_job(text, "job.toml");
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, kBad);
    EXPECT_NE(result.error().message.find("not TOML"), std::string::npos) << result.error().message;
    EXPECT_LT(result.error().message.size(), 600U);
  }
}

TEST(JobSyntax, RefusesLettersOutsideAsciiOutsideStrings) {
  for (unsigned letter = 0x80; letter < 0x10000; letter += letter < 0x600 ? 1 : 61) {
    if (letter >= 0xD800 && letter < 0xE000) {
      continue;  // no characters
    }
    std::string utf8;
    if (letter < 0x800) {
      utf8 = {static_cast<char>(0xC0U | (letter >> 6U)), static_cast<char>(0x80U | (letter & 0x3FU))};
    } else {
      utf8 = {static_cast<char>(0xE0U | (letter >> 12U)), static_cast<char>(0x80U | ((letter >> 6U) & 0x3FU)),
              static_cast<char>(0x80U | (letter & 0x3FU))};
    }
    for (const std::string& text : {utf8 + " = 1\n", "a = \"x\"" + utf8 + "\n", "a = \"\"\"\\" + utf8 + "\"\"\"\n"}) {
      EXPECT_FALSE(parse_job(text, "job.toml")) << text;
    }
  }
}

TEST(JobRules, LetADepthMapBeDeepAtEitherEnd) {
  const Result<Job> result =
      parse_job(sample_with("files        = [\"layers/*.tif\"]",
                            "depth_map = \"d.exr\"\nlevels = 100\ndepth_min = 0.5\ndepth_max = -0.5"),
                "job.toml");
  EXPECT_TRUE(result) << result.error().message;
}

TEST(JobSyntax, LetsStringsAndCommentsHoldAnyNumberOfDots) {
  std::string dots;
  for (int i = 0; i < 100; ++i) {
    dots += "a.b";
  }
  const Result<Job> result =
      parse_job(sample_with("[\"layers/*.tif\"]", "[\"" + dots + "\", '" + dots + "'] # " + dots), "job.toml");
  EXPECT_TRUE(result) << result.error().message;
}

TEST(JobViolations, AreAllToldOnceInFileOrder) {
  const Result<Job> result = parse_job(R"(zzz = 1
[image]
files = ["a"]
levels = 4
fires = "grey"
[scanner]
pixel_pitch_um = -8.0
turn_slots = "many"
[laser]
seed_hz = 0
[fpga]
counter_bits = 4
counter_bit = 4
clock_multiplier = 2
)",
                                       "job.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, kBad);
  const std::vector<std::string> starts = {"job.toml:1:1: zzz = 1: unknown",
                                           "job.toml:4:1: [image] levels = 4: has",
                                           "job.toml:5:9: [image] fires = \"grey\": must",
                                           "job.toml:7:18: [scanner] pixel_pitch_um = -8.0: must",
                                           "job.toml:8:14: [scanner] turn_slots = \"many\": must",
                                           "job.toml:9:1: [laser] pulse_divider is missing",
                                           "job.toml:9:1: [laser] max_pulse_on_demand_hz is missing",
                                           "job.toml:10:11: [laser] seed_hz = 0: must",
                                           "job.toml:12:16: [fpga] counter_bits = 4: must",
                                           "job.toml:13:1: [fpga] counter_bit = 4: unknown",
                                           "job.toml:15:1: section [job] is missing: it needs mode",
                                           "job.toml:15:1: section [rotary] is missing: it needs encoder_lines, "
                                           "interpolation_bits, max_ab_hz, diameter_mm or circumference_mm, "
                                           "line_pitch_um or lines_per_revolution",
                                           "job.toml:15:1: section [limits] is missing: it needs seam_um"};
  const std::vector<std::string> lines = lines_of(result.error().message);
  ASSERT_EQ(lines.size(), starts.size()) << result.error().message;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].substr(0, starts[i].size()), starts[i]);
  }
}

TEST(JobViolations, AreOutOfRangeWhenRangesAloneAreViolated) {
  std::string text = sample_with("= 32 ", "= 65 ");
  text.replace(text.find("seam_um = 0.5"), 13, "seam_um = 0.0");
  const Result<Job> ranges = parse_job(text, "job.toml");
  ASSERT_FALSE(ranges);
  EXPECT_EQ(ranges.error().code, kRange);
  EXPECT_EQ(lines_of(ranges.error().message).size(), 2U);
  const Result<Job> mixed = parse_job("a = 1\n" + text, "job.toml");
  ASSERT_FALSE(mixed);
  EXPECT_EQ(mixed.error().code, kBad);
}

TEST(JobViolations, OfAHostileFileStayReadable) {
  std::string text;
  for (int i = 0; i < 50'000; ++i) {
    text += "k" + std::to_string(i) + "=1\n";
  }
  const Result<Job> result = parse_job(text, "job.toml");
  ASSERT_FALSE(result);
  const std::vector<std::string> lines = lines_of(result.error().message);
  ASSERT_EQ(lines.size(), 1001U);
  EXPECT_EQ(lines.back(), "job.toml: and 49007 more");  // 50,000 keys and 7 missing sections, less 1,000
}

TEST(JobViolations, NeverPrintControlCharacters) {
  const Result<Job> result = parse_job("\"\\u001B[31m\\n\" = \"\"\"\nx\ty\"\"\"\n", "job.toml");
  ASSERT_FALSE(result);
  for (const char c : result.error().message) {
    EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20U);
  }
  EXPECT_NE(result.error().message.find("?[31m? = "), std::string::npos) << result.error().message;
}

TEST(JobRanges, HoldAtBothEndsOfEveryNumber) {
  // Each number of the sample at its bounds and one beyond; the keys the sample has no room for are tested above.
  for (const JobKey& key : job_keys()) {
    const std::size_t to = key.range.find(" to ");
    const std::string with_key = "\n" + key.key + " ";
    const std::size_t line = sample_job().find(with_key);
    if ((key.type != "integer" && key.type != "decimal") || line == std::string::npos || key.key == "revolutions") {
      continue;
    }
    const std::size_t end = sample_job().find('\n', line + 1);
    const auto parse_with = [&](const std::string& value) {
      std::string text = sample_job();
      return parse_job(text.replace(line + 1, end - line - 1, key.key + " = " + value), "job.toml");
    };
    const std::string low = key.range.substr(0, to);
    const std::string high = key.range.substr(to + 4);
    EXPECT_TRUE(parse_with(low)) << key.key;
    EXPECT_TRUE(parse_with(high)) << key.key;
    const Rational below = parse_decimal(low).value() - (key.type == "integer" ? Rational(1) : Rational(1, 10'000'000));
    const Rational above = parse_decimal(high).value() + 1;
    for (const Rational& outside : {below, above}) {
      const Result<Job> result = parse_with(to_decimal_string(outside));
      ASSERT_FALSE(result) << key.key << " = " << to_decimal_string(outside);
      if (fits_int64(floor_of(outside))) {
        EXPECT_EQ(result.error().code, kRange) << result.error().message;
        EXPECT_NE(result.error().message.find("] " + key.key + " = "), std::string::npos) << result.error().message;
        EXPECT_NE(result.error().message.find(key.range), std::string::npos) << result.error().message;
      }
    }
  }
}

/// The starter job of the mode that has a section.
std::string job_with(const std::string& section) {
  return starter_job(section == "carriage" ? Mode::helical : section == "stage" ? Mode::flat : Mode::rotary);
}

TEST(JobRequired, MissesEveryKeyThatHasNoDefault) {
  int required = 0;
  for (const JobKey& key : job_keys()) {
    if (key.fallback != "required") {
      continue;
    }
    ++required;
    const std::string text = key.section == "carriage" || key.section == "stage"
                                 ? without_key(job_with(key.section), key.section, key.key)
                                 : without_line(sample_job(), key.key + " ");
    const Result<Job> result = parse_job(text, "job.toml");
    ASSERT_FALSE(result) << key.key;
    EXPECT_EQ(result.error().code, kBad);
    EXPECT_EQ(result.error().message.find("job.toml:" + place_of(text, "[" + key.section + "]") + ": [" + key.section +
                                          "] " + key.key + " is missing: give "),
              0U)
        << result.error().message;
  }
  EXPECT_EQ(required, 23);
}

/// All that a job says wrong of its mode, and nothing else.
TEST(JobModes, RefuseWhatBelongsToOthers) {
  const auto refused = [](std::string text, std::string_view from, const std::string& to, const std::string& says) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const Result<Job> result = parse_job(text, "job.toml");
    ASSERT_FALSE(result) << says;
    EXPECT_EQ(result.error().message, "job.toml:" + place_of(text, to) + ": " + says);
  };
  refused(
      starter_job(Mode::flat), "[limits]", "[rotary]\ndiameter_mm = 5\n[limits]",
      "[rotary]: nothing turns with mode = \"flat\": describe the stage in [stage] instead, or set mode = \"rotary\"");
  refused(starter_job(Mode::flat), "[limits]", "[carriage]\n[limits]",
          "[carriage]: only mode = \"helical\" has this section, not mode = \"flat\": take it out, or set that mode");
  refused(starter_job(Mode::helical), "[limits]", "[stage]\n[limits]",
          "[stage]: only mode = \"flat\" has this section, not mode = \"helical\": take it out, or set that mode");
  refused(
      starter_job(Mode::helical), "lines_along", "revolutions = 3\nlines_along",
      "[image] revolutions = 3: has no meaning with mode = \"helical\", where [carriage] feed_pixels and layers decide "
      "what each turn exposes; take it out");
  refused(starter_job(Mode::helical), "lines_along", "order = \"hold\"\nlines_along",
          "[image] order = \"hold\": has no meaning with mode = \"helical\", where [carriage] feed_pixels and layers "
          "decide "
          "what each turn exposes; take it out");
}

TEST(JobModes, NeedTheirOwnSections) {
  const auto without_section = [](std::string text, const std::string& section) {
    const std::size_t at = text.find("[" + section + "]");
    return text.erase(at, text.find("\n[", at) + 1 - at);
  };
  const Result<Job> helical = parse_job(without_section(starter_job(Mode::helical), "carriage"), "job.toml");
  ASSERT_FALSE(helical);
  EXPECT_NE(helical.error().message.find("section [carriage] is missing: it needs feed_pixels, layers, "
                                         "encoder_pitch_um, interpolation_bits, max_ab_hz"),
            std::string::npos)
      << helical.error().message;
  const Result<Job> flat = parse_job(without_section(starter_job(Mode::flat), "stage"), "job.toml");
  ASSERT_FALSE(flat);
  EXPECT_NE(flat.error().message.find("section [stage] is missing: it needs lines, line_pitch_um, encoder_pitch_um, "
                                      "interpolation_bits, max_ab_hz"),
            std::string::npos)
      << flat.error().message;
}

TEST(JobModes, HelicalDepthMapHasAsManyLevelsAsLayers) {
  std::string text = starter_job(Mode::helical);
  const std::string files = "files       = [\"layers/*.tif\"]";
  text.replace(text.find(files), files.size(), "depth_map = \"map.tif\"\nlevels = 3");
  const Result<Job> result = parse_job(text, "job.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message.find("job.toml:" + place_of(text, "levels = 3") +
                                        ": [image] levels = 3: contradicts [carriage] layers = 2"),
            0U)
      << result.error().message;
}

}  // namespace
}  // namespace gravure
