#include "gravure/texture/mesh_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dice.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

using gravure::test::Dice;

struct Mesh {
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A square sheet of cells, every cell two triangles with corners of their own, as STL files have them.
template <class Height>
Mesh sheet(int cells, double side_mm, const Height& height, bool turned = false) {
  Mesh mesh;
  const auto corner = [&](int i, int j) {
    const double x = side_mm * (static_cast<double>(i) / cells - 0.5);
    const double y = side_mm * (static_cast<double>(j) / cells - 0.5);
    mesh.vertices.emplace_back(x, y, height(x, y));
  };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      for (const auto& [a, b, c] : {std::array{0, 1, 3}, std::array{0, 3, 2}}) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const int k : {a, b, c}) {
          corner(i + k % 2, j + k / 2);
        }
        mesh.triangles.push_back(turned ? std::array{first, first + 2, first + 1}
                                        : std::array{first, first + 1, first + 2});
      }
    }
  }
  return mesh;
}

std::unique_ptr<Surface> surface_of(const Mesh& mesh) {
  auto surface = mesh_surface(mesh.vertices, mesh.triangles);
  EXPECT_TRUE(surface) << surface.error().message;
  return std::move(surface).value();
}

Error error_at(const Surface& surface, const Vector2& at) {
  std::vector<SurfacePoint> out(1);
  const Result<void> projected = surface.project(std::vector<Vector2>{at}, out);
  return projected ? Error{ErrorCode::bad_argument, "none"} : projected.error();
}

TEST(MeshSurface, IsExactForPlanesWhicheverWayWound) {
  for (const bool turned : {false, true}) {
    const auto surface = surface_of(sheet(
        5, 10, [](double x, double y) { return 1 + 0.4 * x - 0.3 * y; }, turned));
    SCOPED_TRACE(Dice::note());
    Dice dice;
    for (int trial = 0; trial < 500; ++trial) {
      const Vector2 at(0.005 * static_cast<double>(dice.between(-1000, 1000)),
                       0.01 * static_cast<double>(dice.between(-500, 500)));
      const auto points = test::on(*surface, {at});
      ASSERT_EQ(points.size(), 1U) << at;
      EXPECT_LT((points[0].position_mm - Vector3(at.x(), at.y(), 1 + 0.4 * at.x() - 0.3 * at.y())).norm(), 1e-12);
      EXPECT_LT((points[0].normal - Vector3(-0.4, 0.3, 1).normalized()).norm(), 1e-12);
    }
  }
}

/// Triangles leave the surface by side^2 / (8 R), interpolated normals by its square's order.
TEST(MeshSurface, FollowsASphereByPointsAndNormals) {
  const double radius_mm = 30;
  const auto surface =
      surface_of(sheet(80, 20, [&](double x, double y) { return std::sqrt(radius_mm * radius_mm - x * x - y * y); }));
  for (int i = 0; i < 400; ++i) {
    const Vector2 at(8 * std::sin(0.7 * i), 8 * std::cos(1.3 * i));
    const SurfacePoint point = test::on(*surface, {at})[0];
    const Vector3 truth(at.x(), at.y(), std::sqrt(radius_mm * radius_mm - at.squaredNorm()));
    EXPECT_LT((point.position_mm - truth).norm(), 0.5 * 0.25 * 0.25 / radius_mm);
    EXPECT_LT((point.normal - truth.normalized()).norm(), 2e-4);
  }
}

TEST(MeshSurface, HasContinuousNormalsAcrossEdges) {
  const auto surface = surface_of(sheet(6, 6, [](double x, double y) { return 0.2 * x * x - 0.3 * y * x; }));
  for (int edge = -2; edge <= 2; ++edge) {
    const auto points = test::on(*surface, {{edge - 1e-9, 0.3}, {edge + 1e-9, 0.3}});
    EXPECT_LT((points[0].normal - points[1].normal).norm(), 1e-7);
  }
}

TEST(MeshSurface, ReadsTheTopOfABody) {
  Mesh body = sheet(3, 4, [](double x, double) { return 2 + 0.1 * x; });
  const Mesh under = sheet(
      3, 4, [](double, double) { return -1; }, true);
  const auto first = static_cast<std::uint32_t>(body.vertices.size());
  body.vertices.insert(body.vertices.end(), under.vertices.begin(), under.vertices.end());
  for (const auto& [a, b, c] : under.triangles) {
    body.triangles.push_back({first + a, first + b, first + c});
  }
  EXPECT_NEAR(test::on(*surface_of(body), {{0.7, 1.1}})[0].position_mm.z(), 2.07, 1e-12);
}

TEST(MeshSurface, SaysWhereItFolds) {
  Mesh mesh = sheet(3, 4, [](double, double) { return 0; });
  const Mesh above = sheet(2, 1, [](double, double) { return 3; });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), above.vertices.begin(), above.vertices.end());
  for (const auto& [a, b, c] : above.triangles) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
  const auto surface = surface_of(mesh);
  EXPECT_EQ(test::on(*surface, {{1, 1}}).size(), 1U);
  const Error error = error_at(*surface, {0.2, 0.1});
  EXPECT_EQ(error.code, ErrorCode::out_of_range);
  EXPECT_NE(error.message.find("folds at x = 0.2 mm, y = 0.1 mm: sheets at z = 0 mm and z = 3 mm"), std::string::npos)
      << error.message;
}

TEST(MeshSurface, SaysWhereTheProjectionMisses) {
  Mesh mesh = sheet(4, 4, [](double, double) { return 0; });
  mesh.triangles.erase(mesh.triangles.begin() + 10);  // a hole
  const auto surface = surface_of(mesh);
  const Error outside = error_at(*surface, {2.5, 0});
  EXPECT_EQ(outside.code, ErrorCode::out_of_range);
  EXPECT_NE(outside.message.find("misses at x = 2.5 mm"), std::string::npos);
  EXPECT_NE(outside.message.find("from -2 to 2 mm in x"), std::string::npos);
  EXPECT_EQ(error_at(*surface, {NAN, 0}).code, ErrorCode::out_of_range);
  EXPECT_EQ(error_at(*surface, {-0.3, -0.8}).code, ErrorCode::out_of_range) << "the hole";
}

TEST(MeshSurface, RefusesMeshesThatAreNone) {
  const std::vector<Vector3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  EXPECT_EQ(mesh_surface(corners, Triangles{}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(mesh_surface(corners, Triangles{{0, 1, 4}}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(mesh_surface(corners, Triangles{{0, 1, 3}}).error().code, ErrorCode::bad_argument) << "upright";
  EXPECT_EQ(mesh_surface(corners, Triangles{{0, 1, 1}}).error().code, ErrorCode::bad_argument) << "no area";
  EXPECT_EQ(mesh_surface(std::vector<Vector3>{{NAN, 0, 0}}, Triangles{}).error().code, ErrorCode::bad_argument);
}

TEST(MeshSurface, FindsTheSameAsALookAtEveryTriangle) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  Mesh mesh;  // slivers and large ones over a plane: the plane is found wherever any of them lies
  for (std::uint32_t i = 0; i < 300; i += 3) {
    const auto far = static_cast<int>(i % 5 == 0 ? 1000 : 60);
    const Vector2 at(0.01 * static_cast<double>(dice.between(-1000, 1000)),
                     0.01 * static_cast<double>(dice.between(-1000, 1000)));
    for (int k = 0; k < 3; ++k) {
      const Vector2 corner = at + 0.01 * Vector2(static_cast<double>(dice.between(-far, far)),
                                                 static_cast<double>(dice.between(-far, far)));
      mesh.vertices.emplace_back(corner.x(), corner.y(), 0.5 * corner.x());
    }
    const auto& v = mesh.vertices;
    const bool up =
        (v[i + 1] - v[i]).head<2>().x() * (v[i + 2] - v[i]).y() > (v[i + 1] - v[i]).y() * (v[i + 2] - v[i]).x();
    mesh.triangles.push_back(up ? std::array{i, i + 1, i + 2} : std::array{i, i + 2, i + 1});
  }
  const auto surface = surface_of(mesh);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector2 at(0.0101 * static_cast<double>(dice.between(-1200, 1200)),
                     0.0103 * static_cast<double>(dice.between(-1200, 1200)));
    bool covered = false;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto left_of = [&](std::uint32_t p, std::uint32_t q) {
        const Vector2 edge = (mesh.vertices[q] - mesh.vertices[p]).head<2>();
        const Vector2 to = at - mesh.vertices[p].head<2>();
        return edge.x() * to.y() - edge.y() * to.x() >= 0;
      };
      covered = covered || (left_of(a, b) && left_of(b, c) && left_of(c, a));
    }
    EXPECT_EQ(test::on(*surface, {at}).size(), covered ? 1U : 0U) << at;
  }
}

TEST(LimitSlope, RefusesHeightsBeyondEveryMachine) {
  const auto surface = limit_slope(expression_surface("1000*x").value(), 1.5703);
  EXPECT_EQ(test::on(*surface, {{10, 0}}).size(), 1U);
  EXPECT_NE(error_at(*surface, {-10.001, 0}).message.find("z = -10001 mm at x = -10.001 mm, y = 0 mm"),
            std::string::npos);
}

TEST(LimitSlope, NamesPointAndSlope) {
  const auto surface = limit_slope(expression_surface("x^2").value(), 60 * std::numbers::pi / 180);
  EXPECT_EQ(test::on(*surface, {{0.8, 3}}).size(), 1U);  // 58 degrees
  const Error error = error_at(*surface, {1, 3});
  EXPECT_EQ(error.code, ErrorCode::out_of_range);
  EXPECT_NE(error.message.find("slope of 63.4349 deg at x = 1 mm, y = 3 mm, at most 60 deg"), std::string::npos)
      << error.message;
}

}  // namespace
}  // namespace gravure::texture
