#include "gravure/core/csv_rows.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gravure {
namespace {

using Rows = std::vector<std::vector<double>>;

Result<Rows> rows_of(std::string_view text, std::string_view heading = {}) {
  Rows rows;
  const Result<void> read =
      read_csv_rows(text, {"table", "two numbers", 2, heading},
                    [&rows](std::span<const double> row) { rows.emplace_back(row.begin(), row.end()); });
  return read ? Result<Rows>(rows) : read.error();
}

TEST(CsvRows, TakesEverySeparatorHeadingsAndComments) {
  const Rows expected = {{1, -2.5}, {3, 4}};
  for (const char* text :
       {"1,-2.5\n3,4\n", "1;-2.5\r\n3;4\r\n", "t in s\ta\n1\t-2.5\n3\t4", "# scope\n1  -2.5 # first\n\n 3 , +4 ,,\n",
        "\xEF\xBB\xBF"
        "1,-2.5\n3,4"}) {
    const auto rows = rows_of(text);
    ASSERT_TRUE(rows) << rows.error().message;
    EXPECT_EQ(rows.value(), expected) << text;
  }
}

TEST(CsvRows, RefusesAFirstLineThatWasMeantAsARow) {
  for (const char* text : {"l0,-10\n1,2\n",
                           "\xE2\x88\x92"
                           "10,3\n1,2\n",
                           "t,5\n1,2\n"}) {
    const auto rows = rows_of(text);
    ASSERT_FALSE(rows) << text;
    EXPECT_NE(rows.error().message.find("line 1"), std::string::npos);
  }
}

TEST(CsvRows, RefusesEmptyCellsThatWouldShiftTheOthers) {
  EXPECT_FALSE(rows_of("1,,2\n"));
  EXPECT_FALSE(rows_of(",1,2\n"));
  EXPECT_FALSE(rows_of("1\t\t2\n"));
  EXPECT_TRUE(rows_of("1,2,,\n")) << "as tables of spreadsheets end";
}

TEST(CsvRows, TakesOnlyTheHeadingItIsTold) {
  EXPECT_TRUE(rows_of("a_mm, b_mm\n1,2\n", "a_mm,b_mm"));
  const auto swapped = rows_of("b_mm,a_mm\n1,2\n", "a_mm,b_mm");
  ASSERT_FALSE(swapped);
  EXPECT_NE(swapped.error().message.find("or the heading a_mm,b_mm"), std::string::npos);
}

}  // namespace
}  // namespace gravure
