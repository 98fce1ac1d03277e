#include <gtest/gtest.h>

#include "gravure/formats/nc_program.hpp"

namespace gravure::nc {
namespace {

StageProgram two_blocks() {
  StageProgram program;
  program.start = {1, -2, 0.5, 10, -370};
  program.blocks = {{0.005, {1.25, -2, 0.5, 10, -371}, {50, 0, 0, 0, -200}}, {0.002, {1.5, -2, 0.5, 10, -371.5}, {}}};
  return program;
}

void expect_equal(const Result<StageProgram>& read, const StageProgram& wanted, bool with_speed) {
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read.value().start, wanted.start);
  ASSERT_EQ(read.value().blocks.size(), wanted.blocks.size());
  for (std::size_t i = 0; i < wanted.blocks.size(); ++i) {
    EXPECT_NEAR(read.value().blocks[i].duration_s, wanted.blocks[i].duration_s, 1e-12);
    EXPECT_EQ(read.value().blocks[i].place, wanted.blocks[i].place);
    EXPECT_EQ(read.value().blocks[i].speed, with_speed ? wanted.blocks[i].speed : StagePlace{});
  }
}

std::string g_code(const StageProgram& program) {
  std::string text = g_code_start(program.start, "a (title)\nof two lines");
  for (const StageBlock& block : program.blocks) {
    append_g_code(block, text);
  }
  return text + g_code_end();
}

std::string pvt(const StageProgram& program) {
  std::string text = pvt_start(program.start, "title");
  for (const StageBlock& block : program.blocks) {
    append_pvt(block, text);
  }
  return text + pvt_end();
}

TEST(GCode, ComesBackAsItWas) {
  expect_equal(parse_g_code(g_code(two_blocks())), two_blocks(), false);
}

/// W stands behind C, in every block or in none.
TEST(StageProgram, HasAFocusAxisWhereItsStartHasOne) {
  StageProgram program = two_blocks();
  program.stages = kMostStages;
  program.start[5] = 0.25;
  program.blocks[0].place[5] = -0.5;
  program.blocks[0].speed[5] = 3;
  std::string iso = g_code_start(program.start, "title", kMostStages);
  std::string pvt = pvt_start(program.start, "title", kMostStages);
  for (const StageBlock& block : program.blocks) {
    append_g_code(block, iso, kMostStages);
    append_pvt(block, pvt, kMostStages);
  }
  iso += g_code_end();
  pvt += pvt_end();
  EXPECT_NE(iso.find(" C-371.000000000 W-0.500000000 F12000"), std::string::npos) << iso;
  EXPECT_NE(pvt.find(" W-0.500000000:3.000000000\n"), std::string::npos) << pvt;
  expect_equal(parse_g_code(iso), program, false);
  expect_equal(parse_pvt(pvt), program, true);
  EXPECT_EQ(parse_g_code(iso).value().stages, kMostStages);
  EXPECT_EQ(straight_between(program.start, program.blocks[0], 0.5)[5], -0.125);
  iso.replace(iso.find(" W-0.500000000"), 14, "");
  EXPECT_NE(parse_g_code(iso).error().message.find("line 6: must go on with W"), std::string::npos)
      << parse_g_code(iso).error().message;
  pvt.replace(pvt.find(" W-0.500000000:3.000000000"), 26, "");
  EXPECT_NE(parse_pvt(pvt).error().message.find("must go on with W"), std::string::npos);
}

TEST(GCode, GivesTheFeedAsTheInverseOfTheTime) {
  EXPECT_NE(g_code(two_blocks())
                .find("G93\nG1 X1.250000000 Y-2.000000000 Z0.500000000 A10.000000000 C-371.000000000 "
                      "F12000.000000000\n"),
            std::string::npos);
}

TEST(GCode, IsRefusedWithTheLineThatIsWrong) {
  const auto refused = [](std::string text, const std::string& from, const std::string& to, const std::string& says) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    const auto read = parse_g_code(text.replace(at, from.size(), to));
    ASSERT_FALSE(read) << to;
    EXPECT_EQ(read.error().code, ErrorCode::bad_file);
    EXPECT_NE(read.error().message.find(says), std::string::npos) << read.error().message;
  };
  const std::string text = g_code(two_blocks());
  refused(text, "F12000.000000000", "F0", "line 6");
  refused(text, " Z0.5", " W0.5", "line 4: must go on with Z");
  refused(text, "G93", "G94", "line 5: must be G93");
  refused(text, "M30", "M2", "must be M30");
  refused(text, "G94\nM30\n%\n", "", "ends without M30");
}

TEST(Pvt, ComesBackAsItWas) {
  expect_equal(parse_pvt(pvt(two_blocks())), two_blocks(), true);
}

TEST(Pvt, IsRefusedWhereItEndsEarly) {
  const std::string text = pvt(two_blocks());
  for (std::size_t bytes = 0; bytes + 7 < text.size(); bytes += 3) {
    EXPECT_FALSE(parse_pvt(text.substr(0, bytes))) << bytes;
  }
}

TEST(Pvt, MovesByTheCubicWithItsPlacesAndSpeeds) {
  // x = t^2 from 1 s to 3 s is a cubic with these ends.
  const StageBlock block{2, {9, 0, 0, 0, 0}, {6, 0, 0, 0, 0}};
  EXPECT_DOUBLE_EQ(cubic_between({1, 0, 0, 0, 0}, {2, 0, 0, 0, 0}, block, 0.25)[0], 1.5 * 1.5);
  EXPECT_DOUBLE_EQ(straight_between({1, 0, 0, 0, 0}, block, 0.25)[0], 3);
}

}  // namespace
}  // namespace gravure::nc
