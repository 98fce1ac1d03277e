#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "gravure/formats/job_file.hpp"
#include "sample_job.hpp"

namespace gravure {
namespace {

/// The diameter that the sample holds when its literal is `literal`.
Rational diameter_from(std::string_view literal) {
  const Result<Job> result =
      parse_job(sample_with("diameter_mm        = 70.0 ", "diameter_mm = " + std::string(literal)), "job.toml");
  EXPECT_TRUE(result) << literal << ": " << result.error().message;
  return result ? result.value().rotary.diameter_mm.value() : Rational(0);
}

TEST(JobNumber, IsTheExactDecimalOfItsLiteral) {
  EXPECT_EQ(diameter_from("0.1"), Rational(1, 10));
  EXPECT_NE(diameter_from("0.1"), Rational(0.1)) << "the binary fraction";
  EXPECT_EQ(diameter_from("8.0"), Rational(8));
  EXPECT_EQ(diameter_from("8"), Rational(8));
  EXPECT_EQ(diameter_from("0x46"), Rational(70));
  EXPECT_EQ(diameter_from("+8.50"), Rational(17, 2));
  EXPECT_EQ(diameter_from("7e1"), Rational(70));
  EXPECT_EQ(diameter_from("1_000.5e-3"), Rational(2001, 2000));
  EXPECT_EQ(diameter_from("6.9999999999999E+1"), Rational(Integer("69999999999999"), Integer("1000000000000")));
  EXPECT_EQ(diameter_from("69.9999999999999999999999"),
            Rational(Integer("699999999999999999999999"), Integer("10000000000000000000000")));
  EXPECT_LT(diameter_from("69.9999999999999999999999"), 70);
}

TEST(JobNumber, IsJudgedExactlyAtTheEdgesOfItsRange) {
  EXPECT_EQ(diameter_from("0.01"), Rational(1, 100));
  EXPECT_EQ(diameter_from("10000"), Rational(10000));
  for (const char* literal : {"0.009999999999999999999999999999", "10000.000000000000000000000001"}) {
    const Result<Job> result =
        parse_job(sample_with("diameter_mm        = 70.0 ", "diameter_mm = " + std::string(literal)), "job.toml");
    ASSERT_FALSE(result) << literal;
    EXPECT_EQ(result.error().code, ErrorCode::out_of_range);
    EXPECT_NE(result.error().message.find(literal), std::string::npos) << result.error().message;
  }
}

/// The sample with its images replaced by a depth map, all on one line that ends in `depth_min = literal`.
std::string sample_with_depth_map(const std::string& name, const std::string& literal) {
  std::string text = sample_job();
  const std::size_t image = text.find("[image]");
  text.erase(image, text.find("[limits]") - image);
  return "image = { depth_map = \"" + name + "\", levels = 5, fires = \"white\", depth_min = " + literal + " }\n" +
         text;
}

TEST(JobNumber, IsFoundBehindCharactersOfSeveralBytesOnItsLine) {
  for (const char* name :
       {"a", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x94\xA5", "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x94\xA5.tif"}) {
    const Result<Job> result = parse_job(sample_with_depth_map(name, "0.3"), "job.toml");
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result.value().image.depth_min, Rational(3, 10)) << name;
    EXPECT_EQ(result.value().image.depth_map, name);
  }
}

TEST(JobNumber, IsExactWhereverItStands) {
  const char* text = std::getenv("GRAVURE_TEST_SEED");
  const auto seed = static_cast<std::uint32_t>(text == nullptr ? 1 : std::strtoul(text, nullptr, 10));
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  const auto below = [&rng](std::uint32_t n) { return static_cast<std::uint32_t>(rng() % n); };
  const char* const fillings[] = {"/", "a", " ", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x94\xA5"};
  for (int trial = 0; trial < 500; ++trial) {
    std::string name = "n";
    for (std::uint32_t i = below(30); i > 0; --i) {
      name += fillings[below(6)];
    }
    std::string digits;
    for (std::uint32_t i = 1 + below(60); i > 0; --i) {
      digits += static_cast<char>('0' + below(10));
    }
    const Result<Job> result = parse_job(sample_with_depth_map(name, "1." + digits), "job.toml");
    ASSERT_TRUE(result) << result.error().message;
    Integer scale = 1;
    for (std::size_t i = 0; i < digits.size(); ++i) {
      scale *= 10;
    }
    ASSERT_EQ(result.value().image.depth_min, Rational(Integer("1" + digits), scale)) << name << ", " << digits;
    ASSERT_EQ(result.value().image.depth_map, name);
  }
}

TEST(JobNumber, MayBeHexadecimalOctalOrBinaryWhereIntegersAre) {
  const Result<Job> result = parse_job(sample_with("pulse_divider = 41 ", "pulse_divider = 0x29 "), "job.toml");
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result.value().laser.pulse_divider, 41);
  EXPECT_EQ(parse_job(sample_with("= 13 ", "= 0o15 "), "j").value().rotary.interpolation_bits, 13);
  EXPECT_EQ(parse_job(sample_with("= 13 ", "= 0b1101 "), "j").value().rotary.interpolation_bits, 13);
}

TEST(JobNumber, IsRefusedWhenNotFiniteOrNotReadable) {
  for (const char* literal : {"inf", "-inf", "+nan", "nan"}) {
    const Result<Job> result = parse_job(sample_with("seam_um = 0.5", "seam_um = " + std::string(literal)), "job.toml");
    ASSERT_FALSE(result) << literal;
    EXPECT_EQ(result.error().code, ErrorCode::bad_argument);
    EXPECT_NE(result.error().message.find("[limits] seam_um = " + std::string(literal) + ": must be a number from"),
              std::string::npos)
        << result.error().message;
    EXPECT_NE(result.error().message.find("not inf or nan"), std::string::npos) << result.error().message;
  }
  const Result<Job> tiny = parse_job(sample_with("seam_um = 0.5", "seam_um = 1e-999"), "job.toml");
  ASSERT_FALSE(tiny);
  EXPECT_EQ(tiny.error().code, ErrorCode::bad_argument);
  EXPECT_NE(tiny.error().message.find("an exponent of at most 400"), std::string::npos) << tiny.error().message;
}

}  // namespace
}  // namespace gravure
