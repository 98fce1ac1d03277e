#include <gtest/gtest.h>

#include <algorithm>

#include "gravure/formats/machine_file.hpp"
#include "sample_machine.hpp"

namespace gravure {
namespace {

struct Flaw {
  const char* from;  ///< in the sample
  const char* to;
  ErrorCode code;
  const char* said;
};

const Flaw kFlaws[] = {
    {"[head]", "[heads]", ErrorCode::bad_argument,
     "m.toml:27:1: [heads]: not one of [machine] joints; did you mean [head]?"},
    {"[machine]", "[machin]", ErrorCode::bad_argument, "section [machine] is missing"},
    {"[c]", "[d]", ErrorCode::bad_argument, "section [c] is missing"},
    {"[machine]", "loose = 1\n[machine]", ErrorCode::bad_argument, "m.toml:1:1: loose = 1: stands outside"},
    {"[\"x\", \"c\"]", "[\"x\", \"c\", \"x\"]", ErrorCode::bad_argument, "m.toml:3:10: [machine] joints = "},
    {"[\"x\", \"c\"]", "[\"x\", \"head\"]", ErrorCode::bad_argument, "different names"},
    {"[\"x\", \"c\"]", "\"x\"", ErrorCode::bad_argument, "must be a list such as"},
    {"[\"x\", \"c\"]", "[\"x\", 3]", ErrorCode::bad_argument, "must be a list such as"},
    {"title = \"two joints\"", "title = 3", ErrorCode::bad_argument, "m.toml:2:9: [machine] title = 3"},
    {"kind = \"prismatic\"", "kind = \"linear\"", ErrorCode::bad_argument,
     "[x] kind = \"linear\": must be \"prismatic\" or \"revolute\""},
    {"kind = \"prismatic\"", "", ErrorCode::bad_argument, "[x] kind is missing: give \"prismatic\" or \"revolute\""},
    {"kind = \"revolute\"", "kind = \"prismatic\"", ErrorCode::bad_argument,
     "m.toml:21:1: [c] least_deg = -90: unknown key"},
    {"carries = \"tool\"", "carries = \"head\"", ErrorCode::bad_argument, "\"workpiece\" or \"tool\""},
    {"axis = [2, 0, 0]", "axis = [0, 0, 0]", ErrorCode::bad_argument,
     "m.toml:8:8: [x] axis = [0, 0, 0]: has no direction"},
    {"axis = [2, 0, 0]", "axis = [2, 0]", ErrorCode::bad_argument, "must be [x, y, z], three numbers"},
    {"axis = [2, 0, 0]", "axis = [2, 0, nan]", ErrorCode::bad_argument, "must be [x, y, z], three numbers"},
    {"axis = [2, 0, 0]", "axis = [2, 0, 1e7]", ErrorCode::out_of_range, "from -1_000_000 to 1_000_000"},
    {"axis = [2, 0, 0]", "axsi = [2, 0, 0]", ErrorCode::bad_argument, "unknown key; did you mean axis?"},
    {"least_mm = -5", "least_mm = 600", ErrorCode::bad_argument,
     "m.toml:5:1: [x]: its least position is beyond its most"},
    {"max_jerk_mm_s3 = 1e5", "max_jerk_mm_s3 = 0", ErrorCode::out_of_range,
     "[x] max_jerk_mm_s3 = 0: must be a number from"},
    {"lens = \"f_theta\"", "lens = \"telecentric\"", ErrorCode::bad_argument, "a telecentric lens has none"},
    {"tilt_deg_per_mm = 0.36", "", ErrorCode::bad_argument, "an f_theta lens needs it"},
    {"tilt_deg_per_mm = 0.36", "tilt_deg_per_mm = 9", ErrorCode::out_of_range,
     "m.toml:27:1: kinematics: scan head: tilt"},
    {"field_mm = 28.5", "", ErrorCode::bad_argument, "[head] field_mm is missing"},
    {"field_mm = 28.5", "field_mm = 0", ErrorCode::out_of_range, "[head] field_mm = 0"},
    {"resolution_bits = 18", "resolution_bits = 18.0", ErrorCode::bad_argument, "an integer from 8 to 26 bits"},
    {"resolution_bits = 18", "resolution_bits = 27", ErrorCode::out_of_range, "an integer from 8 to 26 bits"},
    {"lag_us = 12.3", "lag_us = -1", ErrorCode::out_of_range, "[head] lag_us = -1"},
    {"v_axis = [0, -1, 0]", "v_axis = [0, -1, 1]", ErrorCode::bad_argument, "right angles"},
    {"[head]", "[head", ErrorCode::bad_argument, "not TOML"},
};

TEST(MachineRefusals, NameThePlaceTheValueAndWhatIsAllowed) {
  for (const Flaw& flaw : kFlaws) {
    std::string text = test::sample_machine();
    const std::size_t at = text.find(flaw.from);
    ASSERT_NE(at, std::string::npos) << flaw.from;
    text.replace(at, std::string(flaw.from).size(), flaw.to);
    const auto refused = parse_machine(text, "m.toml");
    ASSERT_FALSE(refused) << flaw.to;
    EXPECT_EQ(refused.error().code, flaw.code) << refused.error().message;
    EXPECT_NE(refused.error().message.find(flaw.said), std::string::npos)
        << flaw.to << "\n  said: " << refused.error().message;
    EXPECT_EQ(refused.error().message.rfind("m.toml:", 0), 0U) << refused.error().message;
  }
}

TEST(MachineRefusals, TellEverythingAtOnceInFileOrder) {
  std::string text = test::sample_machine();
  for (const auto& [from, to] :
       {std::pair("[2, 0, 0]", "[0, 0, 0]"), std::pair("= 28.5", "= -1"), std::pair("least_deg", "least_dge")}) {
    text.replace(text.find(from), std::string(from).size(), to);
  }
  const std::string message = parse_machine(text, "m.toml").error().message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 2) << message;
  EXPECT_LT(message.find("m.toml:8:8"), message.find("m.toml:21:1"));
  EXPECT_LT(message.find("m.toml:21:1"), message.find("m.toml:30:12"));
}

TEST(MachineRefusals, LargeFilesAreNotRead) {
  EXPECT_EQ(parse_machine(std::string(kMaxMachineBytes + 1, '#'), "m.toml").error().code, ErrorCode::bad_file);
}

}  // namespace
}  // namespace gravure
