#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "gravure/core/error.hpp"

namespace gravure {
namespace {

/// The table of docs/errors.md: name -> exit status.
std::map<std::string, int> documented() {
  std::map<std::string, int> table;
  std::ifstream file(std::string(GRAVURE_DOCS) + "/errors.md");
  const std::regex row(R"(^\| `([a-z_]+)` \| (\d+) \| \S.* \|$)");
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_match(line, match, row)) {
      EXPECT_TRUE(table.emplace(match[1], std::stoi(match[2])).second) << match[1] << " has two lines";
    }
  }
  return table;
}

TEST(ErrorCodes, AreTheOnesOfTheDocumentationWithTheirExitStatus) {
  std::map<std::string, int> known;
  for (const ErrorCode code : kAllErrorCodes) {
    known.emplace(error_code_name(code), exit_status(code));
  }
  EXPECT_EQ(known.size(), std::size(kAllErrorCodes)) << "two codes share a name";
  EXPECT_EQ(known, documented());
}

TEST(ErrorCodes, AreAllListed) {
  // The list has every value from 0 on, in order: a code added to the enumeration alone ends up here as "unknown".
  for (std::size_t i = 0; i < std::size(kAllErrorCodes); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(kAllErrorCodes[i]), i);
    EXPECT_NE(error_code_name(kAllErrorCodes[i]), "unknown");
  }
  EXPECT_EQ(error_code_name(static_cast<ErrorCode>(std::size(kAllErrorCodes))), "unknown") << "not in kAllErrorCodes";
}

TEST(ErrorCodes, TellInputDeviceAndInterruptionApart) {
  const std::set<int> statuses{2, 3, 4};
  for (const ErrorCode code : kAllErrorCodes) {
    EXPECT_TRUE(statuses.count(exit_status(code))) << error_code_name(code);
  }
  EXPECT_EQ(exit_status(ErrorCode::cancelled), 4);
  EXPECT_EQ(exit_status(ErrorCode::io), 3);
  EXPECT_EQ(exit_status(ErrorCode::out_of_range), 2);
}

Result<int> half(int value) {
  if (value % 2 != 0) {
    return Error{ErrorCode::bad_argument, "value = " + std::to_string(value) + ": must be even"};
  }
  return value / 2;
}

Result<int> quarter(int value) {
  GRAVURE_TRY(const int first, half(value));
  GRAVURE_CHECK(half(first));
  GRAVURE_TRY(const int second, half(first));
  return second;
}

TEST(Result, CarriesTheValueOrTheFirstError) {
  ASSERT_TRUE(quarter(12));
  EXPECT_EQ(quarter(12).value(), 3);
  ASSERT_FALSE(quarter(7));
  EXPECT_EQ(quarter(7).error().message, "value = 7: must be even");
  EXPECT_EQ(quarter(14).error().message, "value = 7: must be even");
  EXPECT_EQ(quarter(14).error().code, ErrorCode::bad_argument);
}

TEST(Result, ThrowsWhenTheWrongSideIsRead) {
  EXPECT_THROW(static_cast<void>(half(3).value()), std::bad_variant_access);
  const Result<void> fine;
  EXPECT_THROW(static_cast<void>(fine.error()), std::bad_variant_access);
}

}  // namespace
}  // namespace gravure
