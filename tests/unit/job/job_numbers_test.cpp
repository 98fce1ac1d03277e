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

TEST(JobNumber, IsFoundBehindCharactersOfSeveralBytes) {
  const std::string text =
      sample_with("[limits]\nseam_um = 0.5\n", "") + "[limits]\n\"seam_um\" = 0.3 # \xC3\xA4\xE2\x82\xAC\n";
  const std::string start = "job = { title = \"\xC3\xA4\xE2\x82\xAC\xF0\x9F\x94\xA5\", mode = \"rotary\" }\n";
  const std::string inlined = "limits = { \"seam\\u005Fum\" = 0.3 }\n";
  std::string body = text.substr(text.find("[laser]"));
  const Result<Job> result = parse_job(start + body, "job.toml");
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result.value().limits.seam_um, Rational(3, 10));
  body.resize(body.find("[limits]"));
  const Result<Job> escaped = parse_job(start + inlined + body, "job.toml");
  ASSERT_TRUE(escaped) << escaped.error().message;
  EXPECT_EQ(escaped.value().limits.seam_um, Rational(3, 10));
}

TEST(JobNumber, IsExactWhereverItStands) {
  const char* text = std::getenv("GRAVURE_TEST_SEED");
  const auto seed = static_cast<std::uint32_t>(text == nullptr ? 1 : std::strtoul(text, nullptr, 10));
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  const auto below = [&rng](std::uint32_t n) { return static_cast<std::uint32_t>(rng() % n); };
  const char* const fillings[] = {"", "a", " ", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x94\xA5"};
  const std::string head = sample_with("[limits]\nseam_um = 0.5\n", "");
  for (int trial = 0; trial < 500; ++trial) {
    std::string title;
    for (std::uint32_t i = below(30); i > 0; --i) {
      title += fillings[below(6)];
    }
    std::string digits;
    for (std::uint32_t i = 1 + below(60); i > 0; --i) {
      digits += static_cast<char>('0' + below(10));
    }
    // All on one line, the number last.
    std::string bent = head;
    bent.replace(bent.find("[job]"), bent.find("[laser]") - bent.find("[job]"),
                 "job = { title = \"" + title + "\", mode = \"rotary\" }\n");
    const std::string line = "limits = { \"seam_um\" = 1." + digits + " }\n";
    const Result<Job> result = parse_job(line + bent, "job.toml");
    ASSERT_TRUE(result) << result.error().message;
    Integer scale = 1;
    for (std::size_t i = 0; i < digits.size(); ++i) {
      scale *= 10;
    }
    ASSERT_EQ(result.value().limits.seam_um, Rational(Integer("1" + digits), scale)) << digits;
    ASSERT_EQ(result.value().title, title);
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
