// Long straight runs: lines of pictures, timed point by point.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/path_timing.hpp"
#include "gravure/texture/picture_path.hpp"
#include "gravure/texture/split.hpp"

namespace gravure::texture {
namespace {

/// Lines of a picture on a surface.
struct Lines {
  Lines(const std::string& expression, double length_mm, std::int64_t rows) {
    surface = expression_surface(expression).value();
    path = picture_path({.columns = static_cast<std::int64_t>(length_mm * 100),
                         .rows = rows,
                         .pixel_mm = 0.01,
                         .line_mm = 0.02,
                         .run_out_mm = 0.3,
                         .step_mm = 0.1},
                        100'000)
               .value();
    split = split_path(*surface, path, {.sigma_mm = 2, .cut = 4}).value();
    machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, Vector3::Zero(), {});
    axes = seven_axes(machine, split.targets, split.stages).value();
    request.targets = split.targets;
    request.axes = axes;
    request.pulse_mm = path.pulse_mm;
    request.table = rotary_table(machine).value();
    request.limits = published_limits();
    request.sigma_points = split.sigma_mm / path.step_mm;
  }
  double time_s() const { return prove_seven_axes(request, {}).value().path.time_s; }

  std::unique_ptr<Surface> surface;
  TexturePath path;
  Split split;
  kinematics::Machine machine;
  std::vector<SevenAxes> axes;
  PathTimingRequest request;
};

TEST(LongRuns, KeepEveryLimitOnHardSurfaces) {
  for (const char* surface : {"0.1*x", "0.004*x*y", "2.6*(cos(2*pi*x/39+0.3)+cos(2*pi*y/39+1.1))", "(x^2+y^2)/60"}) {
    const Lines lines(surface, 12, 4);
    const auto proven = prove_seven_axes(lines.request, {});
    ASSERT_TRUE(proven) << surface << ": " << proven.error().message;
    ASSERT_EQ(proven.value().uses.size(), 21U);
    for (const LimitUse& use : broken(proven.value().uses)) {
      ADD_FAILURE() << surface << ": " << kPathAxes[use.axis] << " " << limit_name(use.kind) << " " << use.share();
    }
  }
}

/// A bump slows the line where it is: far from it the spot is where it is on the plane, before and behind. One line, so
/// that even a planner that finds no end stops soon.
TEST(LongRuns, AreAsFastAsEverAwayFromAHardPlace) {
  const auto passed_s = [](const char* surface, double from_mm, double to_mm) {
    const Lines lines(surface, 10, 1);
    const auto timed = time_seven_axes(lines.request, {});
    EXPECT_TRUE(timed) << timed.error().message;
    EXPECT_LT(timed.value().passes, 60) << surface;
    std::vector<PathInstant> at(static_cast<std::size_t>(timed.value().motion->instants()));
    EXPECT_TRUE(timed.value().motion->read(0, at));
    const auto periods = std::count_if(
        at.begin(), at.end(), [&](const PathInstant& now) { return now.along_mm > from_mm && now.along_mm < to_mm; });
    return static_cast<double>(periods) * lines.request.servo_s;
  };
  const char* easy = "0.3*x";
  const char* hard = "0.3*x + 0.3*exp(-(x/0.4)^2)";
  EXPECT_LT(passed_s(hard, 0, 2), 1.05 * passed_s(easy, 0, 2));
  EXPECT_LT(passed_s(hard, 8, 10), 1.05 * passed_s(easy, 8, 10));
  EXPECT_GT(passed_s(hard, 4.5, 5.5), 1.3 * passed_s(easy, 4.5, 5.5));
}

/// What a hard place costs does not grow with the line that it lies on: slowing whole lines would double it.
TEST(LongRuns, AreSlowOnlyWhereItIsHard) {
  const char* easy = "0.3*x";
  const char* hard = "0.3*x + 0.3*exp(-(x/0.4)^2)";
  const double cost_s = Lines(hard, 14, 2).time_s() - Lines(easy, 14, 2).time_s();
  const double cost_of_twice_s = Lines(hard, 28, 2).time_s() - Lines(easy, 28, 2).time_s();
  EXPECT_GT(cost_s, 0.1);
  EXPECT_LT(cost_of_twice_s, 1.35 * cost_s);
}

/// Forward kinematics of every instant: the light never leaves the lines, and stands exactly on both ends of each.
TEST(LongRuns, KeepTheLightOnTheirLine) {
  const Lines lines("0.02*x*x - 0.03*x*y", 8, 3);
  const auto timed = time_seven_axes(lines.request, {});
  ASSERT_TRUE(timed) << timed.error().message;
  std::vector<PathInstant> at(static_cast<std::size_t>(timed.value().motion->instants()));
  ASSERT_TRUE(timed.value().motion->read(0, at));
  const std::vector<std::size_t> rests = resting_points(lines.split.targets, Stops::corners);
  std::size_t reached = 0;
  double along_mm = 0;
  for (const PathInstant& now : at) {
    const Vector3& corner = lines.split.targets[rests[reached]].position_mm;
    const auto joints = std::span(now.axes).first(5);
    const auto field = kinematics::field_of(lines.machine, joints, corner);
    ASSERT_TRUE(field);
    const bool there = std::hypot(field.value().u_mm - now.axes[5], field.value().v_mm - now.axes[6]) < 1e-9;
    reached += there && reached + 1 < rests.size() ? 1 : 0;
    ASSERT_GE(now.along_mm, along_mm);
    along_mm = now.along_mm;
    // Where its pulses belong, the light is above the pixel: x by what has been run, y that of the row.
    const double width_mm = 8;
    const double row = std::floor(now.along_mm / width_mm);
    const double in_row = now.along_mm - row * width_mm;
    if (in_row > 0.01 && in_row < width_mm - 0.01) {
      const double way = static_cast<int>(row) % 2 == 0 ? 1 : -1;
      const Vector2 plane(way * (in_row - width_mm / 2), 0.02 * (1 - row));
      SurfacePoint wanted;
      ASSERT_TRUE(lines.surface->project(std::span(&plane, 1), std::span(&wanted, 1)));
      const auto spot = kinematics::field_of(lines.machine, joints, wanted.position_mm);
      ASSERT_TRUE(spot);
      ASSERT_NEAR(spot.value().u_mm, now.axes[5], 1e-6);
      ASSERT_NEAR(spot.value().v_mm, now.axes[6], 1e-6);
    }
  }
  EXPECT_EQ(reached + 1, rests.size());
  EXPECT_EQ(at.back().along_mm, lines.path.pulse_mm.back());
}

TEST(LongRuns, ReadTheSameFromAnyInstant) {
  const Lines lines("0.01*x*y", 6, 2);
  const auto timed = time_seven_axes(lines.request, {});
  ASSERT_TRUE(timed);
  const PathMotion& motion = *timed.value().motion;
  std::vector<PathInstant> at(static_cast<std::size_t>(motion.instants()));
  ASSERT_TRUE(motion.read(0, at));
  for (std::int64_t first = 0; first < motion.instants(); first += 333) {
    PathInstant one;
    ASSERT_TRUE(motion.read(first, std::span(&one, 1)));
    EXPECT_EQ(one.axes, at[static_cast<std::size_t>(first)].axes);
    EXPECT_EQ(one.along_mm, at[static_cast<std::size_t>(first)].along_mm);
  }
}

}  // namespace
}  // namespace gravure::texture
