#include "gravure/formats/motion_json.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "indexing_models.hpp"

namespace gravure::formats {
namespace {

using nlohmann::json;

TEST(MotionJson, OfAProfileHasItsKeys) {
  const auto profile = motion::plan_profile(motion::test::indexing(500, 30000, 30000, 115)).value();
  const json parsed = json::parse(profile_to_json(profile));
  EXPECT_EQ(parsed["times_s"].size(), 8U);
  EXPECT_EQ(parsed["velocity_constants"].size(), 7U);
  EXPECT_EQ(parsed["position_constants"].size(), 7U);
  EXPECT_NEAR(parsed["access_time_s"].get<double>(), 0.115, 1e-12);
  EXPECT_TRUE(parsed["reduced"]["velocity"].get<bool>());
  EXPECT_TRUE(parsed["reduced"]["acceleration"].get<bool>());
}

TEST(MotionJson, AndTablesHaveNoDigitsThatAreRoundingOfSums) {
  const auto profile = motion::plan_profile(motion::test::indexing(250, 7000, 6600, 115)).value();
  const std::regex noise("[1-9][0-9]{12}");  // more than twelve digits that count
  for (const std::string& text :
       {profile_to_json(profile), samples_to_csv(motion::sample_profile(profile, 4000).value())}) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, noise)) << found.str() << " in " << text;
  }
}

TEST(MotionJson, OfSeveralAxesHasTheirProfiles) {
  const std::vector<motion::JerkRequest> axes{{{20, 375, 14000, 14000, 0, 0}, 7e5, 7e5},
                                              {{-5, 100, 3000, 3000, 0, 0}, 2e5, 2e5}};
  const auto move = motion::synchronise(axes).value();
  const json parsed = json::parse(synchronised_to_json(move));
  EXPECT_EQ(parsed["slowest_axis"], move.slowest_axis);
  ASSERT_EQ(parsed["axes"].size(), 2U);
  EXPECT_EQ(parsed["axes"][1]["stroke_mm"], -5);
  EXPECT_EQ(parsed["axes"][0]["access_time_s"], parsed["access_time_s"]);
  EXPECT_EQ(parsed["axes"][1]["access_time_s"], parsed["access_time_s"]);
  const auto samples = motion::sample_profile(move.axes[0], 1000).value();
  const std::string csv = samples_to_csv({samples, samples});
  EXPECT_EQ(csv.substr(0, 17), "axis,time_s,posit");
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), 1 + 2 * samples.size());
  EXPECT_NE(csv.find("\n1,0,0,"), std::string::npos);
}

TEST(MotionJson, OfAResponseHasItsKeysAndNullForNever) {
  const auto profile = motion::plan_profile(motion::test::indexing(375, 14000, 13500, 82.5)).value();
  const auto modes = motion::test::fit_b();
  Response response{modes, motion::test::kPublishedBand, {}, 1, 0, 0};
  response.settling = motion::settle(modes, motion::input_of(profile), response.band).value();
  json parsed = json::parse(response_to_json(response));
  EXPECT_NEAR(parsed["positioning_time_s"].get<double>(), 0.118083014, 1e-9);
  EXPECT_NEAR(parsed["residual_after_s"].get<double>(), 0.118083014 - 0.101240079, 2e-9);
  response.settling.positioning_time_s = std::numeric_limits<double>::infinity();
  parsed = json::parse(response_to_json(response));
  EXPECT_TRUE(parsed["positioning_time_s"].is_null());
}

TEST(MotionJson, OfASearchHasItsKeysInOrder) {
  const motion::SearchProblem problem{1, 500, 10000, 10000, 5e6, 250, {{38, 0.03, 1}}, {motion::BandOf::position, 1e-3},
                                      5};
  const std::string text = search_to_json(motion::search(problem, {}).value());
  const json parsed = json::parse(text);
  for (const char* key : {"v", "a_up", "a_down", "s_factor", "positioning_time_s"}) {
    EXPECT_TRUE(parsed["best"].contains(key)) << key;
  }
  EXPECT_GT(parsed["evaluated"].get<std::uint64_t>(), 1000U);
  EXPECT_EQ(parsed["alternatives"].size(), 6U);
  EXPECT_TRUE(parsed["grids"].is_null());
  motion::SearchReport with_grids;
  with_grids.grids = motion::SearchedGrids{{{}, 61634, 0}, {{}, 5, 0}};
  EXPECT_EQ(json::parse(search_to_json(with_grids))["grids"]["symmetric"]["evaluated"], 61634);
  EXPECT_LT(text.find("\"best\""), text.find("\"evaluated\""));
}

TEST(MotionJson, OfModesAndPathsHasItsKeys) {
  motion::Identification found;
  found.modes.push_back({{40, 0.1, 0.5}, 0.01, 0.001, 0.02});
  found.modes[0].resolution_hz = std::numeric_limits<double>::infinity();
  found.warnings = {"40 Hz may be two"};
  const json identified = json::parse(identification_to_json(found));
  EXPECT_EQ(identified["modes"][0]["f_hz"], 40);
  EXPECT_TRUE(identified["modes"][0]["resolution_hz"].is_null());
  EXPECT_EQ(identified["warnings"][0], "40 Hz may be two");
  const std::vector<double> s{0, 1, 2, 3};
  const std::vector<double> a{0, 2, 1.9, 3};
  const auto result = motion::remove_reversals({s, a, 0.5, 8}).value();
  const json parsed = json::parse(unreversed_to_json({{"a", 0.5, result}}));
  EXPECT_EQ(parsed["axes"][0]["reversals_before"], 2);
  EXPECT_EQ(parsed["axes"][0]["reversals_after"], 0);
  EXPECT_TRUE(parsed["axes"][0]["published_shift"].contains("largest_deviation_deg"));
  EXPECT_FALSE(parsed.contains("interference"));
  EXPECT_FALSE(parsed.contains("rewritten"));
}

TEST(MotionJson, OfAPathWithItsToolHasItsKeys) {
  ToolPathSummary tool;
  tool.clearance_mm = std::numeric_limits<double>::infinity();
  tool.turned_blocks = 3;
  tool.rewritten = motion::Rewritten{"G1", 0.5, 0.25, 1e-6, 7};
  const json parsed = json::parse(unreversed_to_json({}, tool));
  EXPECT_TRUE(parsed["interference"]["clearance_mm"].is_null());
  EXPECT_EQ(parsed["interference"]["turned_blocks"], 3);
  EXPECT_EQ(parsed["rewritten"]["largest_tilt_deg"], 0.5);
  EXPECT_EQ(parsed["rewritten"]["largest_shift_mm"], 0.25);
  EXPECT_EQ(parsed["rewritten"]["changed_lines"], 7);
}

TEST(MotionText, WritesSamplesAndFigures) {
  const auto profile = motion::plan_profile(motion::test::indexing(375, 14000, 13500, 82.5)).value();
  const std::string csv = samples_to_csv(motion::sample_profile(profile, 250).value());
  EXPECT_EQ(csv.rfind("time_s,", 0), 0U);
  EXPECT_NE(csv.find(",20,0,0,0\n"), std::string::npos);
  const std::string svg = curves_to_svg("a < b", "ms", {{"x", {0, 1}, {2, 2}}, {"left out", {0}, {1}}});
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  EXPECT_EQ(svg.find("left out"), std::string::npos);
  EXPECT_EQ(svg.find("dasharray"), std::string::npos);
  const std::string marked = curves_to_svg("", "ms", {{"x", {0, 1}, {-2, 2}, 1, {0.5, 7}}});
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = marked.find("dasharray", at)) != std::string::npos; ++at) {
    ++lines;
  }
  EXPECT_EQ(lines, 3U);  // the band on both sides, one mark; the other lies outside
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace gravure::formats
