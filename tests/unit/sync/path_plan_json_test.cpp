#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gravure/formats/plan_json.hpp"

namespace gravure {
namespace {

/// 82 MHz, every 41st pulse, j = 2; servo periods of 50 us.
Plan path_plan() {
  Plan plan;
  plan.title = "saddle";
  plan.mode = Mode::freeform;
  plan.clock = {82'000'000, 164'000'000, 41, Rational(2'000'000), 82};
  plan.line.pixels = 100;
  plan.line.slots = 100;
  plan.line.ticks = 8200;
  plan.line.bidirectional = false;
  plan.line.rate_hz = 20'000;
  plan.line.pixel_pitch_um = 5;
  plan.line.scan_speed_m_s = 10;
  plan.rotary.lines_per_revolution = 1000;
  plan.rotary.ticks_per_revolution = 8'200'000;
  plan.job = {1, 8'200'000, ratio(1, 20)};
  PathPlan path;
  for (PathAxisPlan& axis : path.axes) {
    axis.counts_per_unit = Rational(10'000'000'000'000);
    axis.limits.max_jerk = ratio(21, 2);
  }
  path.axes[4].least = ratio(-1, 3);
  path.along_counts_per_mm = Rational(1'000'000'000);
  path.pulses = 12;
  path.targets = 5;
  path.picture = PathPicture{4, 3};
  path.max_incidence_deg = 10;
  path.machine = "texturing";
  path.rotary_centre_mm = {Rational(1), ratio(-1, 8), Rational(0)};
  path.surface = "cos(x)";
  plan.path = path;
  return plan;
}

TEST(PathPlanJson, ComesBackAsItWas) {
  const std::string text = plan_to_json(path_plan());
  const Result<Plan> back = plan_from_json(text);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(plan_to_json(back.value()), text);
  const PathPlan& path = back.value().path.value();
  EXPECT_EQ(path.axes[4].least, ratio(-1, 3));
  EXPECT_EQ(path.axes[6].limits.max_jerk, ratio(21, 2));
  EXPECT_FALSE(path.axes[0].limits.max_speed);
  EXPECT_EQ(path.picture->height, 3);
  EXPECT_EQ(path.rotary_centre_mm[1], ratio(-1, 8));
  EXPECT_EQ(back.value().rotary.lines_per_revolution, 1000);
}

TEST(PathPlanJson, HasAFocusAxisOrNoWordOfOne) {
  EXPECT_EQ(plan_to_json(path_plan()).find("\"W\""), std::string::npos);
  Plan plan = path_plan();
  plan.path->axes.push_back(plan.path->axes[6]);
  plan.path->axes.back().most = ratio(5, 4);
  const std::string text = plan_to_json(plan);
  const Result<Plan> back = plan_from_json(text);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(plan_to_json(back.value()), text);
  ASSERT_TRUE(back.value().path->has_focus_axis());
  EXPECT_EQ(back.value().path->axes[kFocusAxis].most, ratio(5, 4));
  plan.path->axes.back().limits.max_jerk = Rational(0);
  const Result<Plan> wrong = plan_from_json(plan_to_json(plan));
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("path.axes.W.max_jerk"), std::string::npos) << wrong.error().message;
}

TEST(PathPlanJson, HasItsPathInPlaceOfARotaryAxis) {
  const auto json = nlohmann::json::parse(plan_to_json(path_plan()));
  EXPECT_EQ(json["mode"], "freeform");
  EXPECT_FALSE(json.contains("rotary"));
  EXPECT_FALSE(json.contains("ab"));
  EXPECT_EQ(json["path"]["periods"], 1000);
  EXPECT_EQ(json["path"]["axes"]["C"]["max_jerk_deg_s3"], 10.5);
  EXPECT_EQ(json["path"]["axes"]["U"]["max_jerk_mm_s3"], 10.5);
}

TEST(PathPlanJson, RefusesWhatContradictsItself) {
  const auto refused = [](auto&& change, const std::string& says) {
    Plan plan = path_plan();
    change(plan);
    const Result<Plan> back = plan_from_json(plan_to_json(plan));
    ASSERT_FALSE(back) << says;
    EXPECT_EQ(back.error().code, ErrorCode::bad_file);
    EXPECT_NE(back.error().message.find(says), std::string::npos) << back.error().message;
  };
  refused([](Plan& plan) { plan.path.reset(); }, "path must be there");
  refused([](Plan& plan) { plan.line.bidirectional = true; }, "line.bidirectional");
  refused([](Plan& plan) { plan.rotary.ticks_per_revolution += 1; }, "path.ticks");
  refused([](Plan& plan) { plan.job.revolutions = 2; }, "job.revolutions");
  refused([](Plan& plan) { plan.path->axes[2].counts_per_unit = 0; }, "path.axes.Z.counts");
  refused([](Plan& plan) { plan.path->axes[4].most = Rational(-1); }, "path.axes.C.least");
  refused([](Plan& plan) { plan.path->picture->width = 5; }, "path.pulses");
  refused([](Plan& plan) { plan.path->targets = 1; }, "path.targets");
  refused([](Plan& plan) { plan.path->machine = "mill"; }, "path.machine");
}

}  // namespace
}  // namespace gravure
