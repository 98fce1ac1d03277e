#include "gravure/motion/five_axis.hpp"

#include <gtest/gtest.h>

#include "gravure/motion/blade_points.hpp"
#include "gravure/motion/ruled_blade.hpp"
#include "gravure/motion/unreverse.hpp"
#include "motion_test_support.hpp"
#include "vector3.hpp"

namespace gravure::motion {
namespace {

void expect_axes(const AxisPose& pose, const std::array<double, 5>& expected) {
  EXPECT_NEAR(pose.x_mm, expected[0], 5e-8);
  EXPECT_NEAR(pose.y_mm, expected[1], 5e-7);
  EXPECT_NEAR(pose.z_mm, expected[2], 5e-8);
  EXPECT_NEAR(pose.a_rad / kDegree, expected[3], 5e-7);
  EXPECT_NEAR(pose.c_rad / kDegree, expected[4], 5e-8);
}

TEST(PostProcessor, GivesTheVectorOfBothBranches) {
  const ToolPose tool{{30, 10, 5}, {0.3, 0.4, 0.8660254037844387}};
  expect_axes(axes_of(tool, {0, 0, 0}, Branch::positive_a), {18, 20.0166605, 17.33012702, 30, 36.86989765});
  expect_axes(axes_of(tool, {0, 0, 0}, Branch::negative_a), {-18, -20.0166605, 17.33012702, -30, -143.13010235});
}

TEST(PostProcessor, HasTheSenseOfTheFourStatedPoses) {
  const auto angles = [](const Vector3& axis) {
    const AxisPose pose = axes_of({{0, 0, 0}, axis}, {0, 0, 0}, Branch::positive_a, 0);
    return std::pair(pose.a_rad / kDegree, pose.c_rad / kDegree);
  };
  EXPECT_EQ(angles({0, 0, 1}), std::pair(0.0, 0.0));
  EXPECT_NEAR(angles({0, 1, 0}).first, 90, 1e-12);
  EXPECT_NEAR(angles({0, 1, 0}).second, 0, 1e-12);
  EXPECT_NEAR(angles({1, 0, 0}).second, 90, 1e-12);
  EXPECT_NEAR(std::abs(angles({0, -1, 0}).second), 180, 1e-12);
}

TEST(PostProcessor, ComesBackFromTenThousandPosesInBothBranches) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 10'000; ++trial) {
    const double a = random.between(0, 3.14);
    const double c = random.between(-3.14, 3.14);
    const ToolPose tool{{random.between(-100, 100), random.between(-100, 100), random.between(-100, 100)},
                        {std::sin(a) * std::sin(c), std::sin(a) * std::cos(c), std::cos(a)}};
    const Vector3 rotary{random.between(-50, 50), random.between(-50, 50), random.between(-50, 50)};
    const double before = random.between(-20, 20);
    for (const Branch branch : {Branch::positive_a, Branch::negative_a}) {
      const AxisPose axes = axes_of(tool, rotary, branch, before);
      EXPECT_LE(std::abs(axes.c_rad - before), 3.1416);
      const ToolPose back = tool_of(axes, rotary);
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_NEAR(back.centre_mm[i], tool.centre_mm[i], 2e-13 * 1e2);
        ASSERT_NEAR(back.axis[i], tool.axis[i], 2e-14);
      }
    }
  }
}

TEST(PostProcessor, KeepsCAtThePoleAndIsExactBesideIt) {
  EXPECT_EQ(axes_of({{1, 2, 3}, {0, 0, 1}}, {0, 0, 0}, Branch::positive_a, 7.5).c_rad, 7.5);
  const AxisPose beside = axes_of({{1, 2, 3}, {1e-9, 0, 1}}, {0, 0, 0}, Branch::positive_a, 0);
  EXPECT_NEAR(beside.a_rad, 1e-9, 1e-24);
  EXPECT_NEAR(beside.c_rad, 90 * kDegree, 1e-15);
}

TEST(Tilted, HoldsTheBallCentreOrTheFocus) {
  const ToolPose tool{{1, 2, 3}, {0, 0.6, 0.8}};
  const ToolPose moved = tilted(tool, 2.5, 0.3, 1.1);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(moved.centre_mm[i] + 2.5 * moved.axis[i], tool.centre_mm[i] + 2.5 * tool.axis[i], 1e-15);
    EXPECT_EQ(tilted(tool, 0, 0.3, 1.1).centre_mm[i], tool.centre_mm[i]);
  }
}

std::vector<ToolPose> path_of(const std::vector<std::pair<double, double>>& angles_deg) {
  std::vector<ToolPose> path;
  for (const auto& [a, c] : angles_deg) {
    path.push_back(tool_of({0, 0, 0, a * kDegree, c * kDegree}, {0, 0, 0}));
  }
  return path;
}

TEST(Branches, PassThePoleByChangingTheSignOfAInsteadOfTurningC) {
  std::vector<std::pair<double, double>> angles;
  for (int k = -20; k <= 20; ++k) {
    angles.emplace_back(k, 30);  // straight over the pole
  }
  const auto poses = choose_branches(path_of(angles), {0, 0, 0}, {}).value();
  for (const AxisPose& pose : poses) {
    EXPECT_NEAR(std::remainder(pose.c_rad - poses[0].c_rad, 100), 0, 1e-9);
  }
  EXPECT_NEAR(std::abs(poses.back().a_rad - poses.front().a_rad), 40 * kDegree, 1e-9);
  // With A not allowed below 0, C has to turn by half a turn.
  BranchCosts positive;
  positive.a_min_rad = 0;
  const auto turning = choose_branches(path_of(angles), {0, 0, 0}, positive).value();
  EXPECT_NEAR(std::abs(turning.back().c_rad - turning.front().c_rad), 180 * kDegree, 1e-9);
}

double total_cost(const std::vector<AxisPose>& poses, const BranchCosts& costs) {
  double cost = 0;
  int sense = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double turn = poses[k].c_rad - poses[k - 1].c_rad;
    const int now = turn > 0 ? 1 : turn < 0 ? -1 : sense;
    cost += costs.per_a_rad * std::abs(poses[k].a_rad - poses[k - 1].a_rad) + costs.per_c_rad * std::abs(turn) +
            (sense != 0 && now != sense ? costs.per_reversal_rad : 0);
    sense = now;
  }
  return cost;
}

TEST(Branches, AreTheCheapestOfAllSequences) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<ToolPose> path;
    for (int k = 0; k < 8; ++k) {
      path.push_back({{0, 0, 0}, {random.between(-1, 1), random.between(-1, 1), random.between(0.5, 3)}});
    }
    const BranchCosts costs;
    const double found = total_cost(choose_branches(path, {0, 0, 0}, costs).value(), costs);
    double best = 1e9;
    for (unsigned bits = 0; bits < 256; ++bits) {
      std::vector<AxisPose> poses;
      for (std::size_t k = 0; k < 8; ++k) {
        const Branch branch = (bits >> k & 1U) != 0 ? Branch::negative_a : Branch::positive_a;
        poses.push_back(axes_of(path[k], {0, 0, 0}, branch, k == 0 ? 0 : poses.back().c_rad));
      }
      best = std::min(best, total_cost(poses, costs));
    }
    ASSERT_LE(found, best * (1 + 1e-9)) << trial;
  }
}

TEST(Branches, RefuseSamplesOutsideTheLimitsByNumber) {
  BranchCosts costs;
  costs.a_max_rad = 20 * kDegree;
  costs.a_min_rad = -20 * kDegree;
  const auto refused = choose_branches(path_of({{10, 0}, {15, 0}, {30, 0}}), {0, 0, 0}, costs);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("sample 3"), std::string::npos);
  EXPECT_FALSE(choose_branches({}, {0, 0, 0}, {}));
  EXPECT_FALSE(choose_branches(std::vector<ToolPose>{{{0, 0, 0}, {0, 0, 0}}}, {0, 0, 0}, {}));
}

RuledBlade published_blade() {
  return {{[](double u) {
             return Vector3{50 * std::cos(u), 50 * std::sin(u), 40 - 20 * u};
           },
           [](double u) {
             return Vector3{-50 * std::sin(u), 50 * std::cos(u), -20};
           }},
          {[](double u) {
             return Vector3{20 * std::cos(1.2 * u), 20 * std::sin(1.2 * u), 30 - 25 * u};
           },
           [](double u) {
             return Vector3{-24 * std::sin(1.2 * u), 24 * std::cos(1.2 * u), -25};
           }},
          2};
}

TEST(RuledBlade, GivesTheVectorOfBothSides) {
  const RuledBlade blade = published_blade();
  Vector3 sides[] = {blade.side(0.4, 0.3, 1), blade.side(0.4, 0.3, -1)};
  if (sides[0][0] > sides[1][0]) {
    std::swap(sides[0], sides[1]);
  }
  const Vector3 expected[] = {{37.1020868, 16.67128773, 29.24717758}, {38.01612186, 16.12934634, 27.55282242}};
  double gap = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(sides[0][i], expected[0][i], 5e-8);
    EXPECT_NEAR(sides[1][i], expected[1][i], 5e-8);
    gap += (sides[1][i] - sides[0][i]) * (sides[1][i] - sides[0][i]);
  }
  EXPECT_NEAR(std::sqrt(gap), 2, 1e-12);
}

TEST(RuledBlade, SweepsItsHubAboutZ) {
  const RuledBlade blade = published_blade();
  const Vector3 foot = blade.hub.at(0.7);
  const Vector3 turned = blade.hub_surface(0.7, 1.3);
  EXPECT_NEAR(std::hypot(turned[0], turned[1]), std::hypot(foot[0], foot[1]), 1e-12);
  EXPECT_EQ(turned[2], foot[2]);
  EXPECT_NEAR(blade.middle(0.7, 1)[0], foot[0], 1e-12);
}

TEST(Interference, IsTheDistanceFromTheAxisAgainstTheRadius) {
  const ToolPose tool{{0, 0, 0}, {0, 0, 2}};
  const std::vector<Vector3> points{{3, 0, 10}, {0, 4.5, 20}, {0, 0, 60}, {0.1, 0, 0.5}};
  const Interference cylinder = find_interference(tool, {2, 0, 50, 1}, points);
  EXPECT_FALSE(cylinder.touches);
  EXPECT_NEAR(cylinder.depth_mm, -1, 1e-15);
  const Interference cone = find_interference(tool, {0.5, 0.25, 50, 1}, points);  // a beam, wider with height
  EXPECT_TRUE(cone.touches);
  EXPECT_EQ(cone.point, 1U);
  EXPECT_NEAR(cone.depth_mm, 1, 1e-15);
  EXPECT_NEAR(find_interference(tool, {2, 0, 50, 1}, points, 1.5).depth_mm, 0.5, 1e-15);
}

TEST(Interference, IsClearedByTurningCOrRefusedWithTheDepthLeft) {
  const std::vector<Vector3> points = sample_sides(published_blade(), 0, 1, 60, 30);
  const Vector3 near_blade = published_blade().side(0.5, 0.5, 1);
  // A tool whose axis leans into the blade.
  const ToolPose tool{{near_blade[0], near_blade[1], near_blade[2] - 3}, {0.2, 0.2, 1}};
  const ToolShape shape{1.5, 0, 60, 2};
  ASSERT_TRUE(find_interference(tool, shape, points, 0.5).touches);
  const std::vector<ToolPose> here{tool};
  const auto thick = turn_clear(here, {40, 0, 60, 2}, points, 0.5, 3, 1.5 * kDegree, 30 * kDegree);
  ASSERT_FALSE(thick);
  EXPECT_EQ(thick.error().code, ErrorCode::out_of_range);
  EXPECT_NE(thick.error().message.find("slimmer"), std::string::npos);
  // A wall beside the tool at x = 3: leaning to +x hits it; a quarter turn of c clears.
  std::vector<Vector3> wall;
  for (int y = -30; y <= 30; ++y) {
    for (int z = 0; z <= 60; ++z) {
      wall.push_back({3, static_cast<double>(y), static_cast<double>(z)});
    }
  }
  const ToolShape slim{1, 0, 50, 0};
  const std::vector<ToolPose> leaning{{{0, 0, 0}, {0.3, 0, 1}}};
  const auto free_at = [](const ToolPose& place, double c) {
    return tilted(place, 0, std::atan2(std::hypot(place.axis[0], place.axis[1]), place.axis[2]), c);
  };
  const auto around = turn_clear(leaning, slim, wall, 0.5, 0, 2 * kDegree, 180 * kDegree);
  ASSERT_TRUE(around) << around.error().message;
  EXPECT_GT(std::abs(around.value().turned_rad), 60 * kDegree);
  EXPECT_FALSE(find_interference(free_at(leaning[0], around.value().c_rad), slim, wall, 0.5).touches);
}

// The second place is nearer to the wall: turning for the first alone would leave it inside.
TEST(Interference, IsClearedForEveryPlaceOfTheTool) {
  std::vector<Vector3> wall;
  for (int y = -30; y <= 30; ++y) {
    for (int z = 0; z <= 60; ++z) {
      wall.push_back({9, static_cast<double>(y), static_cast<double>(z)});
    }
  }
  const ToolShape slim{1, 0, 50, 0};
  const std::vector<ToolPose> places{{{0, 0, 0}, {0.3, 0, 1}}, {{6, 0, 0}, {0.3, 0, 1}}};
  const double one =
      turn_clear(std::span(places).first(1), slim, wall, 0.5, 0, 2 * kDegree, 180 * kDegree).value().turned_rad;
  const auto both = turn_clear(places, slim, wall, 0.5, 0, 2 * kDegree, 180 * kDegree).value();
  EXPECT_GT(std::abs(both.turned_rad), std::abs(one) + 4 * kDegree);
  for (const ToolPose& place : places) {
    EXPECT_FALSE(find_interference(tilted(place, 0, std::atan2(0.3, 1), both.c_rad), slim, wall, 0.5).touches);
  }
  EXPECT_FALSE(turn_clear({}, slim, wall, 0.5, 0, 2 * kDegree, 180 * kDegree));
}

TEST(BladePoints, LeaveNoGapWiderThanTheSpacing) {
  BladeRails rails;
  for (int k = 0; k <= 20; ++k) {
    const double u = 0.05 * k;
    rails.shroud.push_back(published_blade().shroud.at(u));
    rails.hub.push_back(published_blade().hub.at(u));
  }
  const BladeSampling sampling{2, 7, {0, 0, 0}, 0.8};
  const std::vector<Vector3> points = blade_points(rails, sampling).value();
  ASSERT_EQ(points.size() % 7, 0U);
  // Any point of both sides of the smooth blade, and of its copy two sevenths of a turn on, has a sample near.
  const double turn = 2 * 2 * 3.14159265358979323846 / 7;
  for (int i = 0; i <= 30; ++i) {
    const Vector3 p = published_blade().side(i / 30.0, (i * 7 % 31) / 30.0, i % 2 == 0 ? 1 : -1);
    const Vector3 copy{std::cos(turn) * p[0] - std::sin(turn) * p[1], std::sin(turn) * p[0] + std::cos(turn) * p[1],
                       p[2]};
    for (const Vector3& wanted : {p, copy}) {
      double nearest = 1e9;
      for (const Vector3& q : points) {
        nearest = std::min(nearest, std::hypot(q[0] - wanted[0], q[1] - wanted[1], q[2] - wanted[2]));
      }
      EXPECT_LE(nearest, 0.8 / std::sqrt(2.0) + 0.01) << i;
    }
  }
  EXPECT_EQ(blade_points(rails, {2, 7, {}, 1e-3}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(blade_points(rails, {-1, 7, {}, 1}).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(blade_points(rails, {1, 0, {}, 1}).error().code, ErrorCode::out_of_range);
  rails.hub[3][1] = -1e300;
  EXPECT_EQ(blade_points(rails, {1, 1, {}, 1}).error().code, ErrorCode::out_of_range);
}

TEST(BladePoints, PassThroughTheRowsWithTheSlopeOfTheCurve) {
  const Curve curve = curve_through({{0, 0, 0}, {1, 2, 0}, {3, 3, 1}, {6, 2, 1}});
  EXPECT_EQ(curve.at(2)[0], 3);
  EXPECT_EQ(curve.at(3)[1], 2);
  for (const double u : {0.0, 0.4, 1.0, 1.7, 2.5}) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR((curve.at(u + 1e-6)[i] - curve.at(u - 1e-6)[i]) / 2e-6, curve.slope(u)[i], 1e-5) << u;
    }
  }
}

TEST(BladeCsv, ReadsSixColumnsAndNamesTheLineThatIsNone) {
  const BladeRails rails = parse_blade_csv("px,py,pz,qx,qy,qz\n1,2,3,4,5,6\n2,2,3,5,5,6\n").value();
  ASSERT_EQ(rails.hub.size(), 2U);
  EXPECT_EQ(rails.hub[1][0], 5);
  EXPECT_NE(parse_blade_csv("1,2,3,4,5,6\n1,2,3\n").error().message.find("line 2"), std::string::npos);
  EXPECT_NE(parse_blade_csv("1,2,3\n").error().message.find("line 1"), std::string::npos);
  EXPECT_NE(parse_blade_csv("1,2,3,4,5,6\n").error().message.find("2 or more"), std::string::npos);
}

}  // namespace
}  // namespace gravure::motion
