#include "gravure/formats/svg.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gravure {
namespace {

std::string drawing(const std::string& inside,
                    const std::string& size = R"(width="40mm" height="20mm" viewBox="0 0 400 200")") {
  return R"(<svg xmlns="http://www.w3.org/2000/svg" )" + size + ">" + inside + "</svg>";
}

std::vector<SvgStroke> strokes_of(const std::string& text, double tolerance_mm = 0.01) {
  auto strokes = parse_svg(text, "test.svg", tolerance_mm);
  EXPECT_TRUE(strokes) << strokes.error().message;
  return strokes ? std::move(strokes).value() : std::vector<SvgStroke>();
}

void expect_at(const std::array<double, 2>& point, double x, double y) {
  EXPECT_NEAR(point[0], x, 1e-9);
  EXPECT_NEAR(point[1], y, 1e-9);
}

TEST(Svg, PutsLinesWhereViewBoxAndTransformsSay) {
  const auto strokes =
      strokes_of(drawing(R"x(<g transform="translate(10 20) scale(2)"><path d="M0 0 h10 v5 m1 1 l2 2 z"/></g>)x"
                         R"x(<polyline points="0,0 5,5 10 0"/>)x"));
  ASSERT_EQ(strokes.size(), 3U);
  ASSERT_EQ(strokes[0].size(), 3U);
  expect_at(strokes[0][0], 1, -2);  // a unit is 0.1 mm here, y goes up
  expect_at(strokes[0][1], 3, -2);
  expect_at(strokes[0][2], 3, -3);
  expect_at(strokes[1].front(), 3.2, -3.2);
  expect_at(strokes[1].back(), 3.2, -3.2);
  expect_at(strokes[2][1], 0.5, -0.5);
}

TEST(Svg, TakesUnitsWithoutNameFor96OfAnInch) {
  const auto strokes = strokes_of(drawing(R"(<path d="M0 0 L96 48"/>)", ""));
  expect_at(strokes.at(0).at(1), 25.4, -12.7);
}

/// Points lie on the circle, chords leave it by no more than what is allowed and not by much less.
TEST(Svg, KeepsChordsOfCirclesWithinTolerance) {
  for (const double tolerance_mm : {0.1, 0.01, 0.001}) {
    const auto strokes = strokes_of(drawing(R"(<circle cx="100" cy="100" r="80"/>)"), tolerance_mm);
    ASSERT_EQ(strokes.size(), 1U);
    double worst = 0;
    for (std::size_t i = 0; i < strokes[0].size(); ++i) {
      const auto& [x, y] = strokes[0][i];
      EXPECT_NEAR(std::hypot(x - 10, y + 10), 8, 1e-9);
      if (i > 0) {
        const double middle = std::hypot((x + strokes[0][i - 1][0]) / 2 - 10, (y + strokes[0][i - 1][1]) / 2 + 10);
        worst = std::max(worst, 8 - middle);
      }
    }
    EXPECT_LE(worst, tolerance_mm);
    EXPECT_GT(worst, tolerance_mm / 8);
  }
}

/// A cubic whose points are known at every share: chords leave it by no more than what is allowed.
TEST(Svg, KeepsChordsOfCurvesWithinTolerance) {
  const auto strokes = strokes_of(drawing(R"(<path d="M0 0 C 0 300, 400 -300, 400 0"/>)"), 0.02);
  const auto& chords = strokes.at(0);
  for (int i = 0; i <= 2000; ++i) {
    const double t = i / 2000.0;
    const double x = 40 * (3 * (1 - t) * t * t + t * t * t);
    const double y = -(3 * (1 - t) * (1 - t) * t * 30 - 3 * (1 - t) * t * t * 30);
    double nearest = 1e9;
    for (std::size_t k = 1; k < chords.size(); ++k) {
      const double dx = chords[k][0] - chords[k - 1][0];
      const double dy = chords[k][1] - chords[k - 1][1];
      const double share =
          std::clamp(((x - chords[k - 1][0]) * dx + (y - chords[k - 1][1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(x - chords[k - 1][0] - share * dx, y - chords[k - 1][1] - share * dy));
    }
    ASSERT_LE(nearest, 0.02) << t;
  }
}

TEST(Svg, RefusesWhatIsNoDrawing) {
  const auto code = [](const std::string& text) { return parse_svg(text, "test.svg", 0.01).error().code; };
  EXPECT_EQ(code(""), ErrorCode::bad_file);
  EXPECT_EQ(code("<svg"), ErrorCode::bad_file);
  EXPECT_EQ(code("<html/>"), ErrorCode::bad_file);
  EXPECT_EQ(code(drawing("")), ErrorCode::bad_file);
  EXPECT_EQ(code(drawing("<text>no stroke</text>")), ErrorCode::bad_file);
  EXPECT_EQ(code(drawing(R"(<path d="M0 0 L1e300 0"/>)")), ErrorCode::bad_file);
  EXPECT_EQ(code(drawing(R"(<path d="M0 0 L one"/>)")), ErrorCode::bad_file);
  EXPECT_EQ(parse_svg(drawing(R"(<path d="M0 0 L1 0"/>)"), "test.svg", 0).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure
