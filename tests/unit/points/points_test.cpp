#include "gravure/formats/points.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "point_bytes.hpp"

namespace gravure {
namespace {

const std::vector<Point3> kCorners{{0, 0, 0}, {1.5, 0, 0}, {0, -2.5, 0}, {0, 0, 1e-3F}};

PointFile parsed(const std::string& bytes, PointKind kind) {
  auto file = parse_points(bytes, kind, "it");
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(file).value() : PointFile{};
}

std::string ply_header(const std::string& format, const std::string& end = "\n") {
  return "ply" + end + "format " + format + " 1.0" + end + "comment made by hand" + end + "element vertex 4" + end +
         "property float x" + end + "property float y" + end + "property float z" + end + "property uchar grey" + end +
         "property float nx" + end + "property float ny" + end + "property float nz" + end + "element face 2" + end +
         "property list uchar int vertex_indices" + end + "end_header" + end;
}

void expect_four_corners(const PointFile& file) {
  EXPECT_EQ(file.points.points_mm, kCorners);
  ASSERT_EQ(file.points.normals.size(), 4U);
  EXPECT_EQ(file.points.normals[1], (Point3{0, 0, 1}));
  // A quadrilateral is cut as a fan.
  EXPECT_EQ(file.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
}

TEST(Ply, ReadsTextWithAnyLineEnds) {
  const std::string rows = "0 0 0 7 0 0 1\n1.5 0 0 7 0 0 2\n+0 -2.5 0 7 0 0 1\n0 0 1.00000004749745131e-3 7 0 0 1\n";
  expect_four_corners(parsed(ply_header("ascii") + rows + "3 0 1 2\n4 0 1 2 3\n", PointKind::ply));
  expect_four_corners(
      parsed("\xEF\xBB\xBF" + ply_header("ascii", "\r\n") + rows + "3 0 1 2\r\n4 0 1 2 3", PointKind::ply));
}

TEST(Ply, ReadsBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian", big ? "\r\n" : "\n");
    for (const Point3& corner : kCorners) {
      for (const double value : corner) {
        test::append_float(bytes, static_cast<float>(value), big);
      }
      bytes.push_back('\7');
      for (const float value : {0.0F, 0.0F, 2.0F}) {
        test::append_float(bytes, value, big);
      }
    }
    for (const std::vector<std::uint32_t>& face : {std::vector<std::uint32_t>{0, 1, 2}, {0, 1, 2, 3}}) {
      bytes.push_back(static_cast<char>(face.size()));
      for (const std::uint32_t index : face) {
        test::append_u32(bytes, index, big);
      }
    }
    expect_four_corners(parsed(bytes, PointKind::ply));
  }
}

TEST(Ply, PassesOverElementsThatAreNotOfTheSurface) {
  const PointFile file = parsed(
      "ply\nformat ascii 1.0\nelement camera 1\nproperty list uchar float view\nproperty int id\nelement vertex 1\n"
      "property double z\nproperty list int int ring\nproperty double x\nproperty double y\nend_header\n"
      "2 0.5 0.5 9\n3 0 1\n2\n",
      PointKind::ply);
  EXPECT_EQ(file.points.points_mm, (std::vector<Point3>{{1, 2, 3}}));
  EXPECT_TRUE(file.points.normals.empty());
}

TEST(Stl, MakesOneVertexOfEqualCorners) {
  const std::vector<Point3> places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::string text =
      "solid two halves\r\n facet normal 0 0 1\r\n  outer loop\r\n   vertex 0 0 0\r\n   vertex 1 0 0\r\n"
      "   vertex 0 1e0 0\r\n  endloop\r\n endfacet\r\nfacet normal 0 0 1 outer loop vertex 1 0 -0 vertex 1 1 0\n"
      "vertex 0 1 0 endloop endfacet\nendsolid two halves\n";
  const std::string binary =
      test::binary_stl("solid but binary", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, -0.F, 1, 1, 0, 0, 1, 0});
  for (const std::string& bytes : {text, binary}) {
    const PointFile file = parsed(bytes, PointKind::stl);
    ASSERT_EQ(file.points.points_mm.size(), 4U);
    EXPECT_EQ(file.points.points_mm[3], places[3]);
    EXPECT_EQ(file.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}}));
  }
}

TEST(Stl, DropsTrianglesWithoutAreaAndSaysHowMany) {
  const PointFile file =
      parsed(test::binary_stl("x", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, NAN, 0, 0, 0, 1, 0}),
             PointKind::stl);
  EXPECT_EQ(file.triangles.size(), 1U);
  EXPECT_EQ(file.dropped_triangles, 2);
  EXPECT_EQ(file.dropped_points, 1);
  EXPECT_EQ(file.points.points_mm.size(), 3U);
}

std::string pcd_header(const std::string& data) {
  return "# .PCD v0.7\r\nVERSION 0.7\nFIELDS x y _ z normal_x normal_y normal_z\nSIZE 4 8 1 4 4 4 4\n"
         "TYPE F F U F F F F\nCOUNT 1 1 2 1 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA " +
         data + "\n";
}

void expect_two_of_three(const PointFile& file) {
  EXPECT_EQ(file.points.points_mm, (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(file.points.normals, (std::vector<Point3>{{0, 1, 0}, {0, 0, 0}}));
  EXPECT_EQ(file.dropped_points, 1);
  EXPECT_EQ(file.first_dropped, "point 1");
}

struct PcdPoint {
  float x;
  double y;
  float z;
  float normal[3];
};
const PcdPoint kPcdPoints[] = {{1, 2, 3, {0, 3, 0}}, {NAN, 0, 0, {1, 0, 0}}, {4, 5, 6, {NAN, 0, 1}}};

TEST(Pcd, ReadsTextAndDropsPointsThatAreNone) {
  expect_two_of_three(
      parsed(pcd_header("ascii") + "1 2 0 0 3 0 3 0\nnan 0 0 0 0 1 0 0\n4 5 0 0 6 nan 0 1\n", PointKind::pcd));
}

TEST(Pcd, ReadsBinaryPointAfterPoint) {
  std::string bytes = pcd_header("binary");
  for (const PcdPoint& point : kPcdPoints) {
    test::append_float(bytes, point.x);
    test::append_bits<double, std::uint64_t>(bytes, point.y, false);
    bytes.append(2, '\0');
    test::append_float(bytes, point.z);
    for (const float value : point.normal) {
      test::append_float(bytes, value);
    }
  }
  expect_two_of_three(parsed(bytes, PointKind::pcd));
}

TEST(Pcd, ReadsCompressedFieldAfterField) {
  std::string plain;
  for (const PcdPoint& point : kPcdPoints) {
    test::append_float(plain, point.x);
  }
  for (const PcdPoint& point : kPcdPoints) {
    test::append_bits<double, std::uint64_t>(plain, point.y, false);
  }
  plain.append(6, '\0');
  for (const PcdPoint& point : kPcdPoints) {
    test::append_float(plain, point.z);
  }
  for (int i = 0; i < 3; ++i) {
    for (const PcdPoint& point : kPcdPoints) {
      test::append_float(plain, point.normal[i]);
    }
  }
  std::string packed;  // literal runs alone
  for (std::size_t at = 0; at < plain.size(); at += 32) {
    const std::string run = plain.substr(at, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  std::string bytes = pcd_header("binary_compressed");
  test::append_u32(bytes, static_cast<std::uint32_t>(packed.size()));
  test::append_u32(bytes, static_cast<std::uint32_t>(plain.size()));
  expect_two_of_three(parsed(bytes + packed, PointKind::pcd));
}

TEST(PointText, TakesBlanksCommasHeadingsAndNormals) {
  EXPECT_EQ(parsed("# made by hand\r\n1 2 3\r\n\r\n4e0 +5 6.0 # last\r\n", PointKind::text).points.points_mm,
            (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}}));
  const PointFile file = parsed("\xEF\xBB\xBFx,y,z,nx,ny,nz\n1,2,3,0,0,5\n4;5;6;0;-1;0\n", PointKind::text);
  EXPECT_EQ(file.points.points_mm, (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(file.points.normals, (std::vector<Point3>{{0, 0, 1}, {0, -1, 0}}));
}

TEST(PointText, DropsPointsThatAreNoneAndSaysWhereTheFirstStands) {
  for (const char* const rows :
       {"\nnan nan nan\n1 2 3\n4 5 inf\n4 5 6\n", "# a scan\n1 nan 3\n1,2,3\n4,5,6\nnan,0,0\n"}) {
    const PointFile file = parsed(rows, PointKind::text);
    EXPECT_EQ(file.points.points_mm, (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(file.dropped_points, 2);
    EXPECT_EQ(file.first_dropped, "line 2");
  }
  const PointFile file = parsed("1 2 3 nan 0 1\n4 5 6 0 1 0\nnan 5 6 0 1 0\n", PointKind::text);
  EXPECT_EQ(file.points.points_mm, (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(file.points.normals, (std::vector<Point3>{{0, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(file.first_dropped, "line 3");
}

TEST(PointFiles, AreKnownByTheirSuffix) {
  const auto folder = std::filesystem::temp_directory_path() / ("gravure_points_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const std::string path = (folder / "Part.STL").string();
  std::ofstream(path, std::ios::binary) << test::binary_stl("x", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  EXPECT_EQ(read_point_file(path).value().triangles.size(), 1U);
  EXPECT_EQ(read_triangle_mesh(path).value().vertices_mm.size(), 3U);
  const std::string cloud = (folder / "scan.xyz").string();
  std::ofstream(cloud) << "1 2 3\n";
  EXPECT_NE(read_triangle_mesh(cloud).error().message.find("no triangles"), std::string::npos);
  EXPECT_EQ(read_point_file((folder / "scan.obj").string()).error().code, ErrorCode::bad_argument);
  EXPECT_FALSE(read_point_file((folder / "none.ply").string()));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace gravure
