#include "gravure/formats/machine_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "gravure/core/file_output.hpp"
#include "gravure/kinematics/machines.hpp"
#include "markdown_table.hpp"
#include "sample_machine.hpp"

namespace gravure {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

std::string document() {
  std::ifstream file(GRAVURE_MACHINE_DOC, std::ios::binary);
  EXPECT_TRUE(file) << GRAVURE_MACHINE_DOC;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(MachineFile, GivesItsNumbersExactlyByTheirPlaces) {
  const auto read = parse_machine_file(test::sample_machine(), "m.toml");
  ASSERT_TRUE(read) << read.error().message;
  const auto& numbers = read.value().numbers;
  EXPECT_EQ(numbers.at("x.max_acceleration_mm_s2"), 2000);
  EXPECT_EQ(numbers.at("x.most_mm"), ratio(50'525, 100));
  EXPECT_EQ(numbers.at("c.most_deg"), 36'000);
  EXPECT_EQ(numbers.at("head.tilt_deg_per_mm"), ratio(36, 100));
  EXPECT_EQ(numbers.at("head.resolution_bits"), 18);
  EXPECT_EQ(numbers.count("x.axis") + numbers.count("head.lens"), 0U);
  EXPECT_EQ(numbers.size(), 17U);
}

TEST(MachineFile, EveryKeyArrivesWhereItBelongs) {
  const auto read = parse_machine(test::sample_machine(), "m.toml");
  ASSERT_TRUE(read) << read.error().message;
  const kinematics::Machine& machine = read.value();
  EXPECT_EQ(machine.title, "two joints");
  ASSERT_EQ(machine.joints.size(), 2U);
  const kinematics::Joint& x = machine.joints[0];
  EXPECT_EQ(x.name, "x");
  EXPECT_EQ(x.kind, kinematics::JointKind::prismatic);
  EXPECT_EQ(x.side, kinematics::Side::tool);
  EXPECT_EQ(x.axis, kinematics::Vector3(1, 0, 0)) << "made a unit vector";
  EXPECT_EQ(x.origin_mm, kinematics::Vector3(1.5, 0, 0));
  EXPECT_EQ(x.limits.least, -5);
  EXPECT_EQ(x.limits.most, 505.25);
  EXPECT_EQ(x.limits.max_speed, 300);
  EXPECT_EQ(x.limits.max_acceleration, 2000);
  EXPECT_EQ(x.limits.max_jerk, 1e5);
  const kinematics::Joint& c = machine.joints[1];
  EXPECT_EQ(c.kind, kinematics::JointKind::revolute);
  EXPECT_EQ(c.side, kinematics::Side::workpiece);
  EXPECT_EQ(c.origin_mm, kinematics::Vector3(0, 0.25, -3));
  EXPECT_DOUBLE_EQ(*c.limits.least, -90 * kDegree);
  EXPECT_DOUBLE_EQ(*c.limits.most, 36'000 * kDegree);
  EXPECT_DOUBLE_EQ(*c.limits.max_speed, 720 * kDegree);
  EXPECT_DOUBLE_EQ(*c.limits.max_acceleration, 3600 * kDegree);
  EXPECT_DOUBLE_EQ(*c.limits.max_jerk, 36'000 * kDegree);
  const kinematics::ScanHead& head = machine.head;
  EXPECT_EQ(head.lens, kinematics::Lens::f_theta);
  EXPECT_DOUBLE_EQ(head.tilt_rad_per_mm, 0.36 * kDegree);
  EXPECT_EQ(head.field_mm, 28.5);
  EXPECT_EQ(head.resolution_bits, 18);
  EXPECT_EQ(head.lag_us, ratio(123, 10)) << "exact";
  EXPECT_EQ(head.max_speed_mm_s, 40'000);
  EXPECT_EQ(head.max_acceleration_mm_s2, 4e7);
  EXPECT_EQ(head.max_jerk_mm_s3, 4e12);
  EXPECT_EQ(head.origin_mm, kinematics::Vector3(0, 0, 35));
  EXPECT_EQ(head.v_axis, kinematics::Vector3(0, -1, 0));
}

TEST(MachineFile, OfNoJointsIsAGalvoAlone) {
  const auto read = parse_machine(
      "[machine]\njoints = []\n[head]\nlens = \"telecentric\"\nfield_mm = 30\nresolution_bits = 16\n", "m.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read.value().joints.empty());
  EXPECT_EQ(read.value().head.beam_axis, kinematics::Vector3(0, 0, 1));
  EXPECT_FALSE(read.value().head.max_speed_mm_s);
}

TEST(MachineFile, ExampleOfTheDocumentIsTheMachineOfTexturing) {
  const std::string text = document();
  const std::size_t begin = text.find("```toml\n") + 8;
  const auto read = parse_machine(text.substr(begin, text.find("```", begin) - begin), "machine.md");
  ASSERT_TRUE(read) << read.error().message;
  const kinematics::Machine& machine = read.value();
  const kinematics::Machine built =
      kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, kinematics::Vector3::Zero(), machine.head);
  const kinematics::JointPositions joints{1, -2, 3, 0.4, 5};
  const kinematics::FieldPoint field{6, -7, 0.8};
  EXPECT_LT((forward(machine, joints, field).position_mm - forward(built, joints, field).position_mm).norm(), 1e-12);
}

TEST(MachineFile, IsReadFromDiskWithItsPathInErrors) {
  const std::string path = testing::TempDir() + "machine_file_test.toml";
  ASSERT_TRUE(write_file(path, test::sample_machine()));
  EXPECT_TRUE(read_machine(path));
  ASSERT_TRUE(write_file(path, "[machine]\njoints = 1\n"));
  const auto refused = read_machine(path);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.rfind(path + ":2:10: ", 0), 0U) << refused.error().message;
  std::remove(path.c_str());
  EXPECT_EQ(read_machine(path).error().code, ErrorCode::bad_file);
}

using test::cells_of;

TEST(MachineDocument, HasTheReadersKeysAndNoOthers) {
  const std::vector<MachineKey> known = machine_keys();
  std::size_t row = 0;
  std::istringstream stream(document());
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("| `[", 0) != 0) {
      continue;
    }
    const std::vector<std::string> cells = cells_of(line);
    ASSERT_EQ(cells.size(), 7U) << line;
    ASSERT_LT(row, known.size()) << line;
    const MachineKey& key = known[row++];
    const std::vector<std::string> expected = {
        "[" + key.section + "]", key.key, key.type, key.unit, key.range, key.fallback};
    EXPECT_EQ(std::vector<std::string>(cells.begin(), cells.begin() + 6), expected);
  }
  EXPECT_EQ(row, known.size());
}

}  // namespace
}  // namespace gravure
