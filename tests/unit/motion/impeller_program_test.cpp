// The impeller program of Debian's linuxcnc-uspace, read from the package (fetch_impeller), never copied.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "gravure/motion/rotary_rewrite.hpp"
#include "gravure/motion/smooth_tool_path.hpp"

namespace gravure::motion {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The program, its path and the poses of its tool; X, Y and Z are the tip on the workpiece.
class ImpellerProgram : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("GRAVURE_IMPELLER_FOLDER");
    if (folder == nullptr) {
      GTEST_SKIP() << "GRAVURE_IMPELLER_FOLDER is not set: fetch_impeller fills such a folder";
    }
    text_ = file_text(std::string(folder) + "/impeller.ngc");
    if (text_.empty()) {
      GTEST_SKIP() << "the program of Debian's linuxcnc-uspace is not here: "
                   << file_text(std::string(folder) + "/reason");
    }
    path_ = parse_rotary_program(text_).value();
    for (std::size_t k = 0; k < path_.line.size(); ++k) {
      block_.push_back(static_cast<double>(k));
      ToolPose tool = tool_of({0, 0, 0, path_.a_deg[k] * kDegree, path_.c_deg[k] * kDegree}, {0, 0, 0});
      tool.centre_mm = path_.xyz_mm[k];
      tools_.push_back(tool);
    }
  }

  std::string text_;
  RotaryPath path_;
  std::vector<double> block_;
  std::vector<ToolPose> tools_;
};

TEST_F(ImpellerProgram, HasItsReversalsFoundRemovedOrKeptAndTheDeviationBounded) {
  ASSERT_EQ(path_.a_deg.size(), 4491U);
  EXPECT_EQ(count_reversals(path_.a_deg), 178U);
  EXPECT_EQ(count_reversals(path_.c_deg), 100U);
  const std::vector<double> c_whole = unwrapped(path_.c_deg, 360);
  std::size_t removed = 0;
  for (const auto& [angle, tolerance] :
       {std::pair(path_.a_deg, 0.2), std::pair(path_.a_deg, 1.0), std::pair(path_.c_deg, 1.0), std::pair(c_whole, 2.5),
        std::pair(c_whole, 20.0)}) {
    const auto result = remove_reversals({block_, angle, tolerance, 16});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result.value().reversals_after, result.value().turns.size() - 2);
    EXPECT_LE(result.value().largest_deviation, tolerance);
    removed += result.value().reversals_before - result.value().reversals_after;
    std::printf("%zu of %zu reversals kept, %zu control points, at most %.3f degrees off\n",
                result.value().reversals_after, result.value().reversals_before, result.value().control_points,
                result.value().largest_deviation);
  }
  EXPECT_GT(removed, 50U);
}

// It retracts along the tool's axis, which shows that the sense of A and C is ours.
TEST_F(ImpellerProgram, RetractsAlongTheAxisOfTheTool) {
  int retracts = 0;
  for (std::size_t k = 1; k < tools_.size(); ++k) {
    const Vector3& here = tools_[k].centre_mm;
    const Vector3& before = tools_[k - 1].centre_mm;
    const Vector3 step{here[0] - before[0], here[1] - before[1], here[2] - before[2]};
    const double length = std::hypot(step[0], step[1], step[2]);
    if (path_.a_deg[k] == path_.a_deg[k - 1] && path_.c_deg[k] == path_.c_deg[k - 1] && length > 5) {
      const Vector3& axis = tools_[k].axis;
      EXPECT_NEAR(std::abs(step[0] * axis[0] + step[1] * axis[1] + step[2] * axis[2]), length, 1e-3 * length)
          << "line " << path_.line[k];
      ++retracts;
    }
  }
  EXPECT_GT(retracts, 10);
}

TEST_F(ImpellerProgram, IsWrittenAnewWithTheCentreOfItsBallWhereItWas) {
  const std::vector<double> c_whole = unwrapped(path_.c_deg, 360);
  SmoothPathRequest request{tools_, path_.a_deg, c_whole, block_, 1.0, 16, 1.5, {}};
  const SmoothPath smooth = smooth_tool_path(request).value();
  std::vector<double> c = smooth.c.angle;
  for (std::size_t k = 0; k < c.size(); ++k) {
    c[k] += path_.c_deg[k] - c_whole[k];
  }
  const auto rewritten = rewrite_rotary_program({text_, smooth.a.angle, c, ProgramFrame::workpiece, 1.5, {}});
  ASSERT_TRUE(rewritten) << rewritten.error().message;
  EXPECT_GT(rewritten.value().changed_lines, 1000U);
  const RotaryPath back = parse_rotary_program(rewritten.value().program).value();
  ASSERT_EQ(back.line, path_.line);
  EXPECT_EQ(count_reversals(back.a_deg), smooth.a.reversals_after);
  for (std::size_t k = 0; k < back.line.size(); ++k) {
    const ToolPose now = tool_of({0, 0, 0, back.a_deg[k] * kDegree, back.c_deg[k] * kDegree}, {0, 0, 0});
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(back.xyz_mm[k][i] + 1.5 * now.axis[i], path_.xyz_mm[k][i] + 1.5 * tools_[k].axis[i], 2e-6)
          << "line " << back.line[k];
    }
    ASSERT_LE(std::abs(back.a_deg[k] - path_.a_deg[k]), 1 + 1e-6);
    ASSERT_LE(std::abs(back.c_deg[k] - path_.c_deg[k]), 1 + 1e-6);
  }
}

// The cheapest branches and turns are those the program has, but for turns it winds up and takes back.
TEST_F(ImpellerProgram, NeedsNoMoreTurningWithBranchesChosenOverTheWholePath) {
  const auto poses = choose_branches(tools_, {0, 0, 0}, {}, path_.c_deg.front() * kDegree).value();
  double chosen = 0;
  double programmed = 0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    chosen += std::abs(poses[k].c_rad - poses[k - 1].c_rad) + std::abs(poses[k].a_rad - poses[k - 1].a_rad);
    programmed += std::abs(path_.c_deg[k] - path_.c_deg[k - 1]) * kDegree +
                  std::abs(path_.a_deg[k] - path_.a_deg[k - 1]) * kDegree;
  }
  std::printf("travel of A and C: %.0f degrees chosen, %.0f programmed\n", chosen / kDegree, programmed / kDegree);
  EXPECT_LE(chosen, programmed * (1 + 1e-9));
}

}  // namespace
}  // namespace gravure::motion
