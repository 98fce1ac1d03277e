#include "grv_damage.hpp"

namespace gravure {
namespace {

using namespace grv_test;

/// A program whose plan describes the scanner, with set-points that no two places share.
Program scanned_program(bool bidirectional = true) {
  Program program = make_program(70, 30, {Picture::noise, Picture::stripes}, bidirectional);
  ProgramHeader& header = program.header;
  header.plan.scanner.emplace();
  header.plan.scanner->field_mm = 30;
  header.set_points = kinds_of_lines(header.plan);
  std::int32_t next = -2'000'000'000;
  for (LineSetPoints& line : header.set_points) {
    for (std::int64_t k = 0; k < header.plan.line.slots / header.plan.line.slots_per_microvector; ++k) {
      line.u_counts.push_back(next += 100'000'007);
      line.v_counts.push_back(static_cast<std::int32_t>(-k));
    }
  }
  return program;
}

TEST(GrvMicrovectors, ComeBackAsTheyWere) {
  for (const bool bidirectional : {true, false}) {
    const Program program = scanned_program(bidirectional);
    const Folder folder;
    expect_ok(write_program(folder.file("a.grv"), program, {}));
    const auto source = open_grv(folder.file("a.grv"));
    ASSERT_TRUE(source) << source.error().message;
    const std::vector<LineSetPoints>& found = source.value()->header().set_points;
    ASSERT_EQ(found.size(), bidirectional ? 2U : 1U);
    for (std::size_t row = 0; row < found.size(); ++row) {
      EXPECT_EQ(found[row].reverse, row == 1);
      EXPECT_FALSE(found[row].backwards);
      EXPECT_EQ(found[row].u_counts, program.header.set_points[row].u_counts);
      EXPECT_EQ(found[row].v_counts, program.header.set_points[row].v_counts);
    }
  }
}

TEST(GrvMicrovectors, MayBeMissingAsInOlderPrograms) {
  Program program = scanned_program();
  program.header.set_points.clear();
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), program, {}));
  const auto source = open_grv(folder.file("a.grv"));
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_TRUE(source.value()->header().set_points.empty());
  EXPECT_TRUE(source.value()->header().plan.scanner);
}

TEST(GrvMicrovectors, AreRefusedWhereTheyDoNotFitThePlan) {
  const auto refusal = [](const std::function<void(ProgramHeader&)>& change) {
    Program program = scanned_program();
    change(program.header);
    const Folder folder;
    const auto written = write_program(folder.file("a.grv"), program, {});
    EXPECT_TRUE(written || folder.names().empty());
    return written ? std::string() : written.error().message;
  };
  EXPECT_EQ(refusal([](ProgramHeader&) {}), "");
  EXPECT_NE(
      refusal([](ProgramHeader& h) { h.set_points.pop_back(); }).find("set-points for 1 kinds of lines: must be 2"),
      std::string::npos);
  EXPECT_NE(refusal([](ProgramHeader& h) { h.plan.scanner.reset(); }).find("must be 0"), std::string::npos);
  EXPECT_NE(refusal([](ProgramHeader& h) { h.set_points[1].v_counts.pop_back(); }).find("row 1"), std::string::npos);
  EXPECT_NE(refusal([](ProgramHeader& h) { h.set_points[0].reverse = true; }).find("row 0"), std::string::npos);
}

TEST(GrvMicrovectors, AreRefusedWhereTheFileWasAltered) {
  const auto refused = [](const std::function<void(hid_t)>& change, const std::string& naming) {
    const Folder folder;
    const std::string path = folder.file("a.grv");
    expect_ok(write_program(path, scanned_program(), {}));
    edit(path, change);
    expect_refused(path, ErrorCode::bad_file, "");
    reseal(path);
    expect_refused(path, ErrorCode::bad_file, naming);
  };
  for (const char* name :
       {"microvectors/u_count", "microvectors/v_count", "microvectors/reverse", "microvectors/backwards"}) {
    refused([name](hid_t file) { ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0); }, "missing");
  }
  refused(
      [](hid_t file) {
        const hid_t table = H5Dopen2(file, "microvectors/reverse", H5P_DEFAULT);
        const std::uint8_t swapped[2] = {1, 0};
        ASSERT_GE(H5Dwrite(table, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, swapped), 0);
        H5Dclose(table);
      },
      "microvectors: row 0 says reverse 1");
}

}  // namespace
}  // namespace gravure
