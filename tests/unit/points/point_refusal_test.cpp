#include <gtest/gtest.h>

#include "gravure/formats/points.hpp"
#include "point_bytes.hpp"

namespace gravure {
namespace {

struct Case {
  const char* name;
  PointKind kind;
  std::string bytes;
  std::string says;
};

std::string vertex(const std::string& count, const std::string& rest) {
  return "ply\nformat ascii 1.0\nelement vertex " + count +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
         "property list uchar int vertex_index\nend_header\n" +
         rest;
}

std::string pcd(const std::string& counts, const std::string& data) {
  return "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + counts + "DATA " + data;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> kCases{
      {"ply_first_line", PointKind::ply, "plyx\n", "line 1"},
      {"ply_no_end", PointKind::ply, "ply\nformat ascii 1.0\n", "before end_header"},
      {"ply_no_format", PointKind::ply, "ply\nend_header\n", "format ascii 1.0"},
      {"ply_format", PointKind::ply, "ply\nformat utf 1.0\n", "\"utf\": must be ascii"},
      {"ply_version", PointKind::ply, "ply\nformat ascii 2.0\n", "must be 1.0"},
      {"ply_key", PointKind::ply, "ply\nformat ascii 1.0\nelements\n", "line 3: \"elements\""},
      {"ply_property_first", PointKind::ply, "ply\nformat ascii 1.0\nproperty float x\n", "before any element"},
      {"ply_type", PointKind::ply, "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", "\"half\""},
      {"ply_list_length", PointKind::ply, "ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\n",
       "must be an integer type"},
      {"ply_huge", PointKind::ply, vertex("18446744073709551615", "1 2 3\n"), "does not fit"},
      {"ply_count", PointKind::ply, vertex("-1", "1 2 3\n"), "must be a name and a count"},
      {"ply_cut", PointKind::ply, vertex("1", "1 2         \n"), "line 11: the file ends: must be \"z\""},
      {"ply_word", PointKind::ply, vertex("1", "1 2 zero\n3 0 0 0\n"), "line 10: \"zero\" is no number"},
      {"ply_index", PointKind::ply, vertex("1", "1 2 3\n3 0 0 1\n"), "there are 1"},
      {"ply_index_half", PointKind::ply, vertex("1", "1 2 3\n3 0 0.5 0\n"), "vertex 0.5"},
      {"ply_list_negative", PointKind::ply, vertex("1", "1 2 3\n-3 0 0 0\n"), "a list of length -3"},
      {"ply_no_z", PointKind::ply,
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nend_header\n1 2\n", "x, y and z"},
      {"ply_two_vertices", PointKind::ply,
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\nelement vertex 1\n"
       "property int x\nproperty int y\nproperty int z\nend_header\n1 2 3 4 5 6\n",
       "more than one"},
      {"ply_binary_cut", PointKind::ply,
       "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty double "
       "z\nend_header\n" +
           std::string(20, '\0'),
       "does not fit into the 20 bytes"},
      {"ply_far", PointKind::ply, vertex("1", "1e10 2 3\n0        \n"), "within 1e9 mm"},
      {"ply_none", PointKind::ply, vertex("1", "nan 2 3\n0        \n"), "all 1 have"},
      {"stl_short", PointKind::stl, "binary?", "7 bytes: no STL"},
      {"stl_cut", PointKind::stl, test::binary_stl("x", {0, 0, 0, 1, 0, 0, 0, 1, 0}).substr(0, 130),
       "would have 134 bytes and has 130"},
      {"stl_empty", PointKind::stl, "solid\nendsolid\n", "no triangles: an STL must have one or more"},
      {"stl_flat", PointKind::stl, test::binary_stl("x", {0, 0, 0, 1, 0, 0, 1, 0, 0}),
       "no triangles: all 1 have no area or no finite corners"},
      {"stl_word", PointKind::stl, "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n",
       "line 4: \"zero\": must be a number"},
      {"stl_end", PointKind::stl, "solid x\nfacet normal 0 0 1\nouter\n", "the file ends here: must be loop"},
      {"stl_open", PointKind::stl, "solid x\n", "must be facet or endsolid"},
      {"pcd_key", PointKind::pcd, "FIELD x y z\n", "\"FIELD\""},
      {"pcd_no_data", PointKind::pcd, "FIELDS x y z\n", "before a line DATA"},
      {"pcd_data", PointKind::pcd, pcd("POINTS 1\n", "zip\n"), "\"zip\""},
      {"pcd_no_points", PointKind::pcd, pcd("", "ascii\n1 2 3\n"), "no line POINTS"},
      {"pcd_points", PointKind::pcd, pcd("POINTS -1\n", "ascii\n1 2 3\n"), "\"-1\""},
      {"pcd_product", PointKind::pcd, pcd("WIDTH 2\nHEIGHT 2\nPOINTS 3\n", "ascii\n1 2 3\n"), "2 x 2"},
      {"pcd_huge", PointKind::pcd, pcd("WIDTH 2147483647\nHEIGHT 2147483647\n", "ascii\n1 2 3\n"), "fewer than"},
      {"pcd_cut", PointKind::pcd, pcd("POINTS 2\n", "binary\n12345678901234567890"), "is the file cut"},
      {"pcd_type", PointKind::pcd, "FIELDS x\nSIZE 2\nTYPE F\nPOINTS 0\nDATA ascii\n", "of SIZE 2"},
      {"pcd_word", PointKind::pcd, pcd("POINTS 1\n", "ascii\n1 2 z\n"), "line 7: \"z\" is no number"},
      {"pcd_fields", PointKind::pcd, "FIELDS x y q\nPOINTS 1\nDATA ascii\n1 2 3\n", "x, y and z"},
      {"pcd_packed", PointKind::pcd, pcd("POINTS 1\n", "binary_compressed\n1234"), "two sizes"},
      {"pcd_packed_size", PointKind::pcd, pcd("POINTS 1\n", "binary_compressed\n" + std::string(16, '\1')),
       "must be 12"},
      {"text_word", PointKind::text, "1 2 3\n4 5 six\n", "line 2: \"4 5 six\""},
      {"text_columns", PointKind::text, "1 2 3 4\n", "three or six"},
      {"text_normals", PointKind::text, "1 2 3 0 0 1\n1 2 3\n", "line 2"},
      {"text_none", PointKind::text, "# nothing\n", "no points"},
      {"text_far", PointKind::text, "1e308 2 3\n", "point 0: coordinate 1e+308 mm: must be within 1e9 mm"},
      {"text_nan", PointKind::text, "nan nan nan\n", "all 1 have"},
      {"text_huge", PointKind::text, "1 2 1e999\n", "line 1"},
  };
  return kCases;
}

TEST(PointRefusals, NamePlaceAndValue) {
  for (const Case& refused : cases()) {
    const auto file = parse_points(refused.bytes, refused.kind, "it");
    ASSERT_FALSE(file) << refused.name;
    EXPECT_EQ(file.error().code, ErrorCode::bad_file) << refused.name;
    EXPECT_EQ(file.error().message.substr(0, 3), "it:") << refused.name;
    EXPECT_NE(file.error().message.find(refused.says), std::string::npos)
        << refused.name << ": " << file.error().message;
  }
}

}  // namespace
}  // namespace gravure
