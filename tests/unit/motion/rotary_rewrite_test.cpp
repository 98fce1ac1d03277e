#include "gravure/motion/rotary_rewrite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "gravure/motion/unreverse.hpp"
#include "motion_test_support.hpp"
#include "vector3.hpp"

namespace gravure::motion {
namespace {

constexpr const char* kProgram =
    "( a short path )\n"
    "G90 G21 G93\n"
    "G0  X  10  Y -5.5  Z 30  A -40  C 10 ; start\n"
    "G1 X 9 Y -5 Z 29 A-41 C12 F 100\r\n"
    "G1 Z 28 (tip only) F90\n"
    "g1 a-41.5 F 80\n"
    "M30";

RewriteRequest request_for(const std::vector<double>& a, const std::vector<double>& c) {
  return {kProgram, a, c, ProgramFrame::workpiece, 0, {0, 0, 0}};
}

TEST(RotaryRewrite, LeavesEveryByteWhereNothingTurns) {
  const std::vector<double> a{-40, -41, -41.5};
  const std::vector<double> c{10, 12, 12};
  for (const ProgramFrame frame : {ProgramFrame::workpiece, ProgramFrame::machine}) {
    RewriteRequest request = request_for(a, c);
    request.frame = frame;
    request.ball_radius_mm = 3;
    const Rewritten rewritten = rewrite_rotary_program(request).value();
    EXPECT_EQ(rewritten.program, kProgram);
    EXPECT_EQ(rewritten.changed_lines, 0U);
    EXPECT_EQ(rewritten.largest_tilt_deg, 0);
  }
}

TEST(RotaryRewrite, ChangesAnglesAloneWhereTheTipIsHeldOnTheWorkpiece) {
  const std::vector<double> a{-40, -41.25, -41.5};
  const std::vector<double> c{10, 12, 12.5};
  const Rewritten rewritten = rewrite_rotary_program(request_for(a, c)).value();
  EXPECT_EQ(rewritten.program,
            "( a short path )\n"
            "G90 G21 G93\n"
            "G0  X  10  Y -5.5  Z 30  A -40  C 10 ; start\n"
            "G1 X 9 Y -5 Z 29 A-41.25 C12 F 100\r\n"
            "G1 Z 28 (tip only) F90\n"
            "g1 a-41.5 F 80 C12.5\n"
            "M30");
  EXPECT_EQ(rewritten.changed_lines, 2U);
  EXPECT_NEAR(rewritten.largest_tilt_deg, 0.5 * std::sin(41.5 * kDegree), 1e-3);
  EXPECT_EQ(rewritten.largest_shift_mm, 0);
}

/// Centre of the ball in the workpiece's frame at every block that turns.
std::vector<Vector3> ball_centres(const std::string& program, const RewriteRequest& request) {
  std::vector<Vector3> centres;
  const RotaryPath path = parse_rotary_program(program).value();
  for (std::size_t k = 0; k < path.line.size(); ++k) {
    const auto& x = path.xyz_mm[k];
    const ToolPose tool =
        tool_of({x[0], x[1], x[2], path.a_deg[k] * kDegree, path.c_deg[k] * kDegree}, request.rotary_centre_mm);
    const Vector3 tip = request.frame == ProgramFrame::workpiece ? Vector3{x[0], x[1], x[2]} : tool.centre_mm;
    centres.push_back({tip[0] + request.ball_radius_mm * tool.axis[0], tip[1] + request.ball_radius_mm * tool.axis[1],
                       tip[2] + request.ball_radius_mm * tool.axis[2]});
  }
  return centres;
}

TEST(RotaryRewrite, HoldsTheCentreOfTheBallInBothFrames) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed());
  for (int trial = 0; trial < 200; ++trial) {
    std::string program = "G1 X1 Y2 Z3 A0 C0\n";
    std::vector<double> a{0};
    std::vector<double> c{0};
    for (int k = 0; k < 20; ++k) {
      a.push_back(random.between(-80, 80));
      c.push_back(random.between(-400, 400));
      program += "G1 X" + std::to_string(random.between(-50, 50)) + " Z" + std::to_string(random.between(-50, 50)) +
                 " A" + std::to_string(a.back()) + " C" + std::to_string(c.back()) + "\n";
      a.back() += random.between(-3, 3);
      c.back() += random.between(-3, 3);
    }
    RewriteRequest request{
        program,      a, c, trial % 2 == 0 ? ProgramFrame::workpiece : ProgramFrame::machine, trial % 3 == 0 ? 0 : 4.0,
        {10, -20, 30}};
    const Rewritten rewritten = rewrite_rotary_program(request).value();
    const auto before = ball_centres(program, request);
    const auto after = ball_centres(rewritten.program, request);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_NEAR(after[k][i], before[k][i], 4e-6) << trial << " block " << k;
      }
    }
    EXPECT_LE(rewritten.largest_error_mm, 4e-6);
  }
}

TEST(RotaryRewrite, ComputesMovesOfXyzAnewThatFollowATurn) {
  const std::string program = "G1 X10 Y0 Z0 A30 C0\nG1 X20\nG1 Y5\n";
  const std::vector<double> a{32};
  const std::vector<double> c{0};
  const Rewritten rewritten = rewrite_rotary_program({program, a, c, ProgramFrame::machine, 0, {0, 0, 100}}).value();
  // The tip of X20 Y5 at A30, stood at A32 instead.
  const ToolPose tip = tool_of({20, 5, 0, 30 * kDegree, 0}, {0, 0, 100});
  const AxisPose axes = axes_at(tip.centre_mm, {0, 0, 100}, 32 * kDegree, 0);
  EXPECT_NE(rewritten.program.find("A32"), std::string::npos);
  const std::string last = rewritten.program.substr(rewritten.program.rfind("G1"));
  EXPECT_NEAR(std::stod(last.substr(last.find('Y') + 1)), axes.y_mm, 1e-6);
  EXPECT_NEAR(std::stod(last.substr(last.find('Z') + 1)), axes.z_mm, 1e-6);
}

// Any text: refused, or given back byte for byte where nothing turns.
TEST(RotaryRewrite, GivesBackAnyTextItReads) {
  GRAVURE_TRACE_SEED();
  test::Random random(test::seed() + 1);
  const std::vector<std::string> pieces{"X",  "Y-1.5", "Z.5",  "A10",  "C-370", " a ",  "c+5", "G1",   "(",    ")",
                                        ";",  "\n",    "\r\n", "F1",   "N7",    "G20",  "#1",  "X1e3", "X.25", "G4",
                                        "\t", "%",     "",     "M428", "Ann",   "C1C2", "--",  "O<x>"};
  int read = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    std::string program;
    for (double k = random.between(0, 14); k > 0; --k) {
      program += pieces[static_cast<std::size_t>(random.uniform() * static_cast<double>(pieces.size()))];
    }
    const auto path = parse_rotary_program(program);
    if (!path) {
      continue;
    }
    const auto rewritten =
        rewrite_rotary_program({program, path.value().a_deg, path.value().c_deg, ProgramFrame::workpiece, 0, {}});
    if (rewritten) {
      ASSERT_EQ(rewritten.value().program, program);
      ++read;
    }
  }
  EXPECT_GT(read, 2000);
}

TEST(RotaryProgram, RefusesWhatIsNoWordByLineAndColumn) {
  for (const auto& [line, column] : std::vector<std::pair<std::string, int>>{
           {"G1 A1.5.2", 4}, {"G1 A1,8", 4},          {"G1 A+2.5e1", 4},   {"G1 A2E1", 4}, {"G4 P1 A5", 7},
           {"G80 X1", 5},    {"G1 (A5", 4},           {"G1 A5 (", 7},      {"G1 A", 4},    {"G1 A5 F", 7},
           {"G1 A--5", 4},   {"G1 A+-5", 4},          {"G1 A1 2", 7},      {"G1 A5)", 6},  {"/G1 A5", 1},
           {"G1 A5 *37", 7}, {"G1 A5 (a (b) c)", 14}, {"G1 A\xC2\xB5", 4}, {"% G1 A5", 1}, {"G1 A1-2", 4},
           {"G1 Anan", 4},   {"G1 A1e400", 4},        {"\x01", 1},         {"G1 E5", 4},   {"X1 A5 A6", 4}}) {
    const auto read = parse_rotary_program("%\nG1 X0 A0 C0\n" + line + "\nM30\n%\n", "f.ngc");
    ASSERT_FALSE(read) << line;
    EXPECT_EQ(read.error().code, ErrorCode::bad_file);
    const std::string place = "f.ngc:3:" + std::to_string(column) + ": ";
    EXPECT_EQ(read.error().message.substr(0, place.size()), place) << line << ": " << read.error().message;
  }
  const RotaryPath path =
      parse_rotary_program("%\nN10 g1 x .5 a+2. c-0.25(C9)\tF 5 ; A7 (\r\nG4 P1\n( ; A8 )\nG1 A3\n%").value();
  EXPECT_EQ(path.a_deg, (std::vector<double>{2, 3}));
  EXPECT_EQ(path.c_deg, (std::vector<double>{-0.25, -0.25}));
}

TEST(RotaryRewrite, RefusesByLineWhatItCannotWriteAnew) {
  const std::vector<double> one{1};
  for (const char* line :
       {"G2 X1 Y1 I1 J0", "G91", "G20", "G92 X0", "G81 Z-1 R1", "#1=5", "o<sub> call", "O100 sub", "G1 X[1+2]", "G28",
        "G55", "G1 X1 X2", "G53 X1", "G10 L2 P1 X1", "G52 X1", "G43.4 H1", "M98 P2", "G1 B10", "G1 U1"}) {
    const std::string program = "G1 X0 Y0 Z0 A0 C0\n" + std::string(line) + "\nG90\nG1 A1\n";
    const auto read = parse_rotary_program(program);  // also where nothing is to be written
    ASSERT_FALSE(read) << line;
    EXPECT_NE(read.error().message.find("program:2:"), std::string::npos) << read.error().message;
    const auto refused = rewrite_rotary_program({program, one, one, ProgramFrame::workpiece, 0, {}});
    ASSERT_FALSE(refused) << line;
    EXPECT_EQ(refused.error().code, ErrorCode::bad_file);
    EXPECT_NE(refused.error().message.find("program:2:"), std::string::npos) << refused.error().message;
  }
  EXPECT_TRUE(parse_rotary_program("M428\nG1 X0 A0\nM429\nM30\n"));
  const auto other_frame = parse_rotary_program("M428\nG1 X0 A0\nM429\nG1 X1\n");
  ASSERT_FALSE(other_frame);
  EXPECT_NE(other_frame.error().message.find("program:4:"), std::string::npos) << other_frame.error().message;
  EXPECT_TRUE(rewrite_rotary_program({"G55\nG1 X0 Y0 Z0 A0 C0\n(G2)\n", one, one, ProgramFrame::machine, 0, {}}));
  const auto unknown = rewrite_rotary_program({"G1 X0 A0 C0\n", one, one, ProgramFrame::machine, 0, {}});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("program:1:"), std::string::npos);
  const std::vector<double> two{1, 2};
  EXPECT_EQ(rewrite_rotary_program({"G1 A0\n", two, two, ProgramFrame::workpiece, 0, {}}).error().code,
            ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::motion
