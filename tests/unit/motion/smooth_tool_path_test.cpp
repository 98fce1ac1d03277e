#include "gravure/motion/smooth_tool_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "vector3.hpp"

namespace gravure::motion {
namespace {

/// A focus that travels along y between two walls at x = -6 and x = 6, the beam tilted by 20 degrees; C wobbles by half
/// a degree about 0 and so does A.
struct Channel {
  std::vector<double> s;
  std::vector<double> a;
  std::vector<double> c;
  std::vector<ToolPose> path;
  std::vector<Vector3> walls;

  explicit Channel(double wall_from_y_mm, double lean_deg = 0) {
    for (int k = 0; k <= 200; ++k) {
      s.push_back(k);
      a.push_back(20 + 0.02 * k + 0.3 * std::sin(0.4 * k));
      c.push_back(lean_deg + 0.05 * k + 0.4 * std::sin(0.3 * k));
      const double ar = a.back() * kDegree;
      const double cr = c.back() * kDegree;
      path.push_back({{0, 0.2 * k, 0}, {std::sin(ar) * std::sin(cr), std::sin(ar) * std::cos(cr), std::cos(ar)}});
    }
    for (double y = wall_from_y_mm; y <= 80; y += 0.5) {
      for (double z = 0; z <= 40; z += 0.5) {
        walls.push_back({-6, y, z});
        walls.push_back({6, y, z});
      }
    }
  }

  SmoothPathRequest request() const {
    SmoothPathRequest r{path, a, c, s, 1, 16, 0, {}};
    r.around = {walls, {0.5, 0.05, 40, 0}, 0.4, 1.5 * kDegree, 60 * kDegree};
    return r;
  }
};

TEST(SmoothToolPath, RemovesReversalsAndHoldsTheFocus) {
  const Channel channel(0);
  const SmoothPath smooth = smooth_tool_path(channel.request()).value();
  EXPECT_GT(smooth.a.reversals_before, 10U);
  EXPECT_EQ(smooth.a.reversals_after, 0U);
  EXPECT_EQ(smooth.c.reversals_after, 0U);
  EXPECT_LE(smooth.c.largest_deviation, 1);
  EXPECT_EQ(smooth.turned_samples, 0U);
  EXPECT_EQ(smooth.rounds, 1U);
  EXPECT_GT(smooth.clearance_mm, 0);
  for (std::size_t k = 0; k < channel.path.size(); ++k) {
    EXPECT_EQ(smooth.tools[k].centre_mm, channel.path[k].centre_mm);
    EXPECT_NEAR(std::atan2(smooth.tools[k].axis[0], smooth.tools[k].axis[1]), smooth.c.angle[k] * kDegree, 1e-12);
  }
}

TEST(SmoothToolPath, TurnsCOutOfTheWayWhereTheBeamTouchesAndNowhereElse) {
  const Channel channel(25, 15);  // leans sideways; the walls begin half-way
  const SmoothPathRequest request = channel.request();
  const auto result = smooth_tool_path(request);
  ASSERT_TRUE(result) << result.error().message;
  const SmoothPath& smooth = result.value();
  EXPECT_GT(smooth.turned_samples, 10U);
  EXPECT_LT(smooth.turned_samples, channel.path.size());
  EXPECT_GT(smooth.rounds, 1U);
  EXPECT_GT(smooth.largest_turn_deg, 1);
  for (const ToolPose& tool : smooth.tools) {
    EXPECT_FALSE(find_interference(tool, request.around.shape, channel.walls, request.around.margin_mm).touches);
  }
  for (std::size_t k = 0; k + 1 < channel.path.size(); ++k) {
    for (const double share : {0.1, 0.35, 0.6, 0.85}) {
      const auto at = [share, k](const std::vector<double>& v) { return (v[k] + share * (v[k + 1] - v[k])) * kDegree; };
      const double a = at(smooth.a.angle);
      const double c = at(smooth.c.angle);
      const ToolPose tool{{0, 0.2 * (static_cast<double>(k) + share), 0},
                          {std::sin(a) * std::sin(c), std::sin(a) * std::cos(c), std::cos(a)}};
      EXPECT_LT(find_interference(tool, request.around.shape, channel.walls, request.around.margin_mm).depth_mm,
                0.9 / 31);
    }
  }
  EXPECT_NEAR(smooth.c.angle[20], channel.c[20], 1);
  EXPECT_LE(smooth.c.largest_deviation, smooth.largest_turn_deg + 1);
}

// A block that moves X alone, half-way and towards the wall, with the angles of sample 100.
TEST(SmoothToolPath, TurnsCForAStopThatTouchesBetweenFreeSamples) {
  const Channel channel(0);
  SmoothPathRequest request = channel.request();
  const std::vector<HeldStop> stops{{100, {4, 20, 0}, 0}};
  EXPECT_EQ(smooth_tool_path(request).value().turned_samples, 0U);
  request.stops = stops;
  const SmoothPath smooth = smooth_tool_path(request).value();
  EXPECT_GE(smooth.turned_samples, 1U);
  EXPECT_GT(smooth.rounds, 1U);
  const ToolPose there{stops[0].centre_mm, smooth.tools[100].axis};
  EXPECT_FALSE(find_interference(there, request.around.shape, channel.walls, request.around.margin_mm).touches);
  const std::vector<HeldStop> inside{
      {3, {0, 0.6, 0}}, {100, {0, 20, 0}, 70}, {100, {6, 20, 0}, 71}};  // the last in the wall itself
  request.stops = inside;
  std::vector<std::size_t> lines(channel.path.size(), 7);
  request.line_of_sample = lines;
  const auto refused = smooth_tool_path(request);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("line 71: "), std::string::npos) << refused.error().message;
  const std::vector<HeldStop> outside{{channel.path.size(), {0, 0, 0}, 0}};
  request.stops = outside;
  EXPECT_EQ(smooth_tool_path(request).error().code, ErrorCode::out_of_range);
}

// Blocks 5 mm apart, the tool leans along the path; a thorn reaches into the tool's way between two blocks.
TEST(SmoothToolPath, TurnsCWhereTheToolTouchesBetweenTwoBlocksOnly) {
  const double a_rad = 30 * kDegree;
  std::vector<double> s;
  std::vector<double> a;
  std::vector<double> c;
  std::vector<ToolPose> path;
  for (int k = 0; k <= 20; ++k) {
    s.push_back(k);
    a.push_back(30);
    c.push_back(0);
    path.push_back({{0, 5.0 * k, 0}, {0, std::sin(a_rad), std::cos(a_rad)}});
  }
  const std::vector<Vector3> thorn{{0.5, 53.5, 20}};
  SmoothPathRequest request{path, a, c, s, 1, 16, 0, {}};
  request.around = {thorn, {0.5, 0, 40, 0}, 0.3, 1.5 * kDegree, 60 * kDegree};
  for (const ToolPose& tool : path) {  // every block is free as it stands
    ASSERT_FALSE(find_interference(tool, request.around.shape, thorn, request.around.margin_mm).touches);
  }
  for (const bool axes : {false, true}) {
    request.straight_axes_about_mm = axes ? std::optional(Vector3{0, 0, -30}) : std::nullopt;
    const auto result = smooth_tool_path(request);
    ASSERT_TRUE(result) << result.error().message;
    const SmoothPath& smooth = result.value();
    EXPECT_GE(smooth.turned_samples, 2U);
    EXPECT_GT(smooth.clearance_mm, 0);
    for (std::size_t k = 0; k + 1 < path.size() && !axes; ++k) {
      for (int i = 0; i <= 500; ++i) {  // finer than it tests itself; a 31st of the reach may be missed
        const double share = i / 500.0;
        const double c_rad = (smooth.c.angle[k] + share * (smooth.c.angle[k + 1] - smooth.c.angle[k])) * kDegree;
        const ToolPose tool{{0, 5.0 * (static_cast<double>(k) + share), 0},
                            {std::sin(a_rad) * std::sin(c_rad), std::sin(a_rad) * std::cos(c_rad), std::cos(a_rad)}};
        EXPECT_LT(find_interference(tool, request.around.shape, thorn, request.around.margin_mm).depth_mm, 0.8 / 31);
      }
    }
  }
  request.around.c_most_rad = 0;
  const auto refused = smooth_tool_path(request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.find("between sample 9 and sample 10: "), 0U) << refused.error().message;
  EXPECT_NE(refused.error().message.find("another tilt, or add points between the two"), std::string::npos);
  std::vector<std::size_t> lines;
  for (std::size_t k = 0; k < path.size(); ++k) {
    lines.push_back(100 + k);
  }
  request.line_of_sample = lines;
  EXPECT_EQ(smooth_tool_path(request).error().message.find("between line 108 and line 109: "), 0U)
      << smooth_tool_path(request).error().message;
}

// The nearest free C is on the outer side of the wall's edge at one block, on its inner side at the next.
TEST(SmoothToolPath, NamesBothBlocksWhereNoTurnAtThemFreesTheWayBetween) {
  const Channel channel(25, 25);
  const auto refused = smooth_tool_path(channel.request());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(refused.error().message.find("between sample "), 0U) << refused.error().message;
  EXPECT_NE(refused.error().message.find(" and sample "), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find("or add points between the two"), std::string::npos);
}

TEST(SmoothToolPath, SaysWhichSampleCannotBeFreed) {
  const Channel channel(25);
  SmoothPathRequest request = channel.request();
  request.around.shape.radius_mm = 7;
  const auto refused = smooth_tool_path(request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("sample "), std::string::npos);
  EXPECT_NE(refused.error().message.find("slimmer"), std::string::npos);
  request.path = std::span(channel.path).first(5);
  EXPECT_FALSE(smooth_tool_path(request));
}

TEST(PointsCsv, ReadsThreeColumnsAndNamesTheLineThatIsNone) {
  const auto points = parse_points_csv("x,y,z\n1,2,3\n# wall\n-1; 0.5\t7\n").value();
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[1][2], 7);
  EXPECT_NE(parse_points_csv("1,2\n1,2,3\n").error().message.find("line 1"), std::string::npos);
  EXPECT_NE(parse_points_csv("x,y,z\n").error().message.find("none"), std::string::npos);
  EXPECT_NE(parse_points_csv("1,2,3\n1,2\n").error().message.find("line 2"), std::string::npos);
}

}  // namespace
}  // namespace gravure::motion
