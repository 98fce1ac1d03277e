#include <gtest/gtest.h>

#include <cmath>

#include "dice.hpp"
#include "gravure/scan/field_grid.hpp"

namespace gravure::scan {
namespace {

/// Pincushion, a little turned and shifted.
GridPoint distortion(const GridPoint& p) {
  const double share = 0.0004 * (p.u_mm * p.u_mm + p.v_mm * p.v_mm) / 15;
  return {share * p.u_mm + 0.002 * p.v_mm + 0.03, share * p.v_mm - 0.002 * p.u_mm - 0.01};
}

FieldGrid grid_of(std::size_t columns, std::size_t rows) {
  FieldGrid grid{columns, rows, -15, 15, -12, 12, {}};
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      grid.errors.push_back(distortion(grid.node(column, row)));
    }
  }
  return grid;
}

TEST(FieldGrid, UndoesWhatItDescribes) {
  SCOPED_TRACE(gravure::test::Dice::note());
  gravure::test::Dice dice(41);
  const FieldGrid grid = grid_of(11, 9);
  ASSERT_TRUE(check_field_grid(grid));
  for (int trial = 0; trial < 10'000; ++trial) {
    const GridPoint place{static_cast<double>(dice.between(-13'000'000, 13'000'000)) * 1e-6,
                          static_cast<double>(dice.between(-10'000'000, 10'000'000)) * 1e-6};
    const auto order = grid.command_for(place);
    ASSERT_TRUE(order) << order.error().message;
    const auto landed = grid.lands_at(order.value());
    ASSERT_TRUE(landed);
    ASSERT_LT(std::hypot(landed.value().u_mm - place.u_mm, landed.value().v_mm - place.v_mm), 1e-12);
  }
}

TEST(FieldGrid, EstimatesTheErrorOfItsInterpolation) {
  for (const std::size_t nodes : {5U, 9U, 17U, 33U}) {
    const FieldGrid grid = grid_of(nodes, nodes);
    double worst = 0;
    for (double u = -15; u <= 15; u += 0.217) {
      for (double v = -12; v <= 12; v += 0.193) {
        const GridPoint exact = distortion({u, v});
        const GridPoint landed = grid.lands_at({u, v}).value();
        worst = std::max(worst, std::hypot(landed.u_mm - u - exact.u_mm, landed.v_mm - v - exact.v_mm) * 1000);
      }
    }
    EXPECT_LT(worst, 1.25 * grid.interpolation_error_um()) << nodes;
    EXPECT_GT(worst, 0.3 * grid.interpolation_error_um()) << nodes << ": or the bound says nothing";
  }
  EXPECT_EQ(grid_of(2, 2).interpolation_error_um(), 0);
}

TEST(FieldGrid, IsNeverExtrapolated) {
  const FieldGrid grid = grid_of(5, 5);
  EXPECT_FALSE(grid.lands_at({15.001, 0}));
  EXPECT_FALSE(grid.lands_at({0, -12.001}));
  const auto refused = grid.command_for({15.4, 0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_FALSE(grid.command_for({std::nan(""), 0}));
  EXPECT_TRUE(grid.lands_at({15, 12})) << "its last nodes are inside";
}

TEST(FieldGrid, TextGivesTheSameNumbersBack) {
  const FieldGrid grid = grid_of(7, 4);
  const auto again = parse_field_grid(field_grid_text(grid), "field.grid");
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_EQ(again.value().columns, 7U);
  ASSERT_EQ(again.value().rows, 4U);
  EXPECT_EQ(again.value().v_first_mm, -12);
  for (std::size_t i = 0; i < grid.errors.size(); ++i) {
    EXPECT_EQ(again.value().errors[i].u_mm, grid.errors[i].u_mm);
    EXPECT_EQ(again.value().errors[i].v_mm, grid.errors[i].v_mm);
  }
}

constexpr const char* kSmall =
    "gravure-field-grid 1\n"
    "# a comment\n"
    "columns 2\n"
    "rows 2\r\n"
    "u_mm -15 15\n"
    "\n"
    "v_mm -15 15   # the same\n"
    "0.1 0\n0.1 0\n0.1 0\n0.1 0.2\n";

TEST(FieldGrid, TextMayHaveCommentsAndEmptyLines) {
  const auto grid = parse_field_grid(kSmall, "field.grid");
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(grid.value().errors[3].v_mm, 0.2);
}

TEST(FieldGrid, TextMayBeginWithAByteOrderMark) {
  const auto grid = parse_field_grid("\xEF\xBB\xBF" + std::string(kSmall), "field.grid");
  ASSERT_TRUE(grid) << grid.error().message;
  EXPECT_EQ(field_grid_text(grid.value()), field_grid_text(parse_field_grid(kSmall, "field.grid").value()));
  EXPECT_FALSE(parse_field_grid("\xEF\xBB" + std::string(kSmall), "field.grid")) << "half a mark is none";
}

TEST(FieldGrid, FlawsOfTheTextAreNamedByLine) {
  struct Flaw {
    const char* from;
    const char* to;
    const char* said;
  };
  const Flaw flaws[] = {
      {"grid 1", "grid 2", "field.grid:1: "},
      {"columns 2", "columns 1", "field.grid:4: "},
      {"columns 2", "columns 2.5", "2.5 nodes"},
      {"columns 2", "columns 2000", "2000 nodes"},
      {"columns 2", "rows 2", "field.grid:3: "},
      {"u_mm -15 15", "u_mm -15", "field.grid:5: "},
      {"u_mm -15 15", "u_mm -15 15 3", "field.grid:5: "},
      {"u_mm -15 15", "u_mm -15 nan", "field.grid:5: "},
      {"u_mm -15 15", "u_mm 15 -15", "U from 15 to -15 mm"},
      {"0.1 0.2", "", "field.grid:12: "},
      {"0.1 0.2", "0.1 0.2\n1 1", "field.grid:12: "},
      {"0.1 0.2", "0.1 x", "field.grid:11: "},
      {"0.1 0.2", "0.1 20", "column 1, row 1"},
  };
  for (const Flaw& flaw : flaws) {
    std::string text = kSmall;
    text.replace(text.find(flaw.from), std::string(flaw.from).size(), flaw.to);
    const auto grid = parse_field_grid(text, "field.grid");
    ASSERT_FALSE(grid) << flaw.to;
    EXPECT_NE(grid.error().message.find(flaw.said), std::string::npos) << flaw.to << ": " << grid.error().message;
  }
  EXPECT_FALSE(parse_field_grid("", "field.grid"));
}

}  // namespace
}  // namespace gravure::scan
