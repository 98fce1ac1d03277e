#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "dice.hpp"
#include "gravure/core/exact.hpp"

namespace gravure {
namespace {

using test::Dice;

Integer power(unsigned base, unsigned exponent) {
  return boost::multiprecision::pow(Integer(base), exponent);
}

TEST(ParseDecimal, GivesTheExactRatio) {
  const auto expect = [](const char* text, const Rational& value) {
    const Result<Rational> got = parse_decimal(text);
    ASSERT_TRUE(got) << text;
    EXPECT_EQ(got.value(), value) << text;
  };
  expect("70", Rational(70));
  expect("-0.35", ratio(-7, 20));
  expect("+8.0", Rational(8));
  expect("1_000.5e-3", ratio(10005, 10000));
  expect("0.1", ratio(1, 10));
  expect("0", Rational(0));
  expect("-0.0", Rational(0));
  expect("0010", Rational(10));  // not octal
  expect("08.25", ratio(33, 4));
  expect("82_000_000", Rational(82'000'000));
  expect("1e400", Rational(power(10, 400)));
  expect("1E-400", ratio(1, power(10, 400)));
  expect("2.50E+2", Rational(250));
  expect("3.000e-400", ratio(3, power(10, 400)));
  expect("0e-400", Rational(0));
  expect("123456789012345678901234567890.000000000000000000000000000001",
         ratio(Integer("123456789012345678901234567890000000000000000000000000000001"), power(10, 30)));
}

TEST(ParseDecimal, RefusesEverythingElse) {
  const std::string many(401, '7');
  for (const std::string& text : {std::string(),
                                  std::string("."),
                                  std::string("5."),
                                  std::string(".5"),
                                  std::string("-"),
                                  std::string("+"),
                                  std::string("--1"),
                                  std::string("1-"),
                                  std::string("e5"),
                                  std::string("1e"),
                                  std::string("1e+"),
                                  std::string("1e1.5"),
                                  std::string("1.5.2"),
                                  std::string("0x10"),
                                  std::string("1p3"),
                                  std::string("inf"),
                                  std::string("nan"),
                                  std::string("-inf"),
                                  std::string("1__0"),
                                  std::string("_1"),
                                  std::string("1_"),
                                  std::string("1_.5"),
                                  std::string("1._5"),
                                  std::string("1e_5"),
                                  std::string("1e5_"),
                                  std::string(" 1"),
                                  std::string("1 "),
                                  std::string("1\n"),
                                  std::string("1,5"),
                                  std::string("1e401"),
                                  std::string("1e-401"),
                                  std::string("1e99999"),
                                  std::string("1e999999999999999999999"),
                                  std::string("1/2"),
                                  std::string("\xD9\xA1"),
                                  std::string("1\0", 2),
                                  std::string("\0", 1),
                                  std::string("\0001", 2),
                                  many,
                                  "0." + many,
                                  std::string(1'000'000, '9'),
                                  "1" + std::string(1'000'000, '_'),
                                  "1e" + std::string(1'000'000, '0')}) {
    const Result<Rational> got = parse_decimal(text);
    ASSERT_FALSE(got) << text.substr(0, 80);
    EXPECT_EQ(got.error().code, ErrorCode::bad_argument);
    EXPECT_NE(got.error().message.find("is not a decimal number"), std::string::npos);
    EXPECT_LT(got.error().message.size(), 200U) << "a hostile text must not flood the operator";
  }
}

TEST(ParseDecimal, NeverDoesMoreThanRefuseOnRandomBytes) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  constexpr char kLetters[] = "0123456789+-._eE \0x";
  int parsed = 0;
  for (int trial = 0; trial < 100'000; ++trial) {
    std::string text;
    for (std::int64_t left = dice.between(0, 9); left > 0; --left) {
      text += kLetters[static_cast<std::size_t>(dice.between(0, sizeof kLetters - 2))];
    }
    const Result<Rational> got = parse_decimal(text);
    if (!got) {
      continue;
    }
    ++parsed;
    std::string plain;
    for (const char c : text) {
      plain += c == '_' ? "" : std::string(1, c);
    }
    char* end = nullptr;
    const double reference = std::strtod(plain.c_str(), &end);
    ASSERT_EQ(*end, '\0') << text << " is more than C reads";
    ASSERT_EQ(to_double(got.value()), reference == 0 ? 0.0 : reference) << text;
  }
  EXPECT_GT(parsed, 1000);
}

/// Parsing and printing together against the C library, which rounds correctly; subnormals and overflow included.
TEST(ParseDecimal, ThenToDoubleEqualsStrtod) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 20'000; ++trial) {
    std::string text = dice.coin() ? "-" : "";
    for (std::int64_t digits = dice.between(1, 40); digits > 0; --digits) {
      text += static_cast<char>('0' + dice.between(0, 9));
    }
    text += ".";
    for (std::int64_t digits = dice.between(1, 40); digits > 0; --digits) {
      text += static_cast<char>('0' + dice.between(0, 9));
    }
    text += "e" + std::to_string(trial % 2 == 0 ? dice.between(-350, 280) : dice.between(-30, 30));
    const Result<Rational> got = parse_decimal(text);
    ASSERT_TRUE(got) << text;
    const double reference = std::strtod(text.c_str(), nullptr);
    ASSERT_EQ(to_double(got.value()), reference) << text;
  }
}

TEST(ToDecimalString, IsTheShortestExactText) {
  EXPECT_EQ(to_decimal_string(ratio(1, 8)), "0.125");
  EXPECT_EQ(to_decimal_string(ratio(-7, 20)), "-0.35");
  EXPECT_EQ(to_decimal_string(Rational(70)), "70");
  EXPECT_EQ(to_decimal_string(Rational(0)), "0");
  EXPECT_EQ(to_decimal_string(ratio(1, 3)), "1/3");
  EXPECT_EQ(to_decimal_string(ratio(-1, power(10, 40))), "-0." + std::string(39, '0') + "1");
  EXPECT_EQ(to_decimal_string(ratio(1, power(10, 41))), "1/1" + std::string(41, '0'));
  EXPECT_EQ(to_decimal_string(ratio(1, power(2, 40))).size(), 42U);
}

TEST(ToDecimalString, IsReadBackToTheSameRatio) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 5000; ++trial) {
    const Integer den =
        power(2, static_cast<unsigned>(dice.between(0, 40))) * power(5, static_cast<unsigned>(dice.between(0, 40)));
    const Rational value = ratio(Integer(static_cast<std::int64_t>(dice.word())), den);
    const std::string text = to_decimal_string(value);
    const Result<Rational> back = parse_decimal(text);
    ASSERT_TRUE(back) << text;
    ASSERT_EQ(back.value(), value) << text;
    if (text.find('.') != std::string::npos) {
      ASSERT_NE(text.back(), '0') << text << " is not the shortest";
    }
  }
}

}  // namespace
}  // namespace gravure
