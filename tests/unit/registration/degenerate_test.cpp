#include <gtest/gtest.h>

#include <numbers>

#include "registration_test_support.hpp"

namespace gravure::registration {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

enum class Shape { plane, cylinder, sphere, revolution, extrusion };

BladeSurface::Sample on_shape(Shape shape, Dice& dice) {
  const double u = BladeSurface::unit(dice);
  const double v = 2 * BladeSurface::unit(dice) - 1;
  const double c = std::cos(2 * std::numbers::pi * u);
  const double s = std::sin(2 * std::numbers::pi * u);
  const double ring = std::sqrt(1 - v * v);
  const double slope = 1 / std::sqrt(1.25);
  switch (shape) {
    case Shape::plane:
      return {{40 * u - 20, 15 * v, 5}, {0, 0, 1}};
    case Shape::cylinder:
      return {{10 * c + 3, 10 * s + 4, 30 * v}, {c, s, 0}};
    case Shape::sphere:
      return {{12 * ring * c, 12 * ring * s, 12 * v}, {ring * c, ring * s, v}};
    case Shape::revolution:  // a cone
      return {{(10 - 10 * v) * c, (10 - 10 * v) * s, 20 * v}, {slope * c, slope * s, 0.5 * slope}};
    case Shape::extrusion:  // an elbow of two planes
      return v < 0 ? BladeSurface::Sample{{20 * u, 0, 60 * v + 30}, {0, 1, 0}}
                   : BladeSurface::Sample{{0, 15 * u, 60 * v - 30}, {1, 0, 0}};
  }
  return {};
}

PointSet points_of(Shape shape, std::size_t count, Dice& dice) {
  PointSet set;
  for (std::size_t i = 0; i < count; ++i) {
    const auto sample = on_shape(shape, dice);
    set.points_mm.push_back(sample.point);
    set.normals.push_back(sample.normal);
  }
  return set;
}

Registration registered(Shape shape, bool with_scale, bool estimated = false) {
  Dice dice(static_cast<std::uint64_t>(shape));
  PointSet cad = points_of(shape, 8000, dice);
  if (estimated) {
    cad.normals.clear();
  }
  const PointSet scan =
      without_normals(moved(points_of(shape, 2500, dice), pose(0.02, {1, 1, 0.3}, {0.1, 0.1, 0.05}), 0.005, dice));
  RegistrationOptions options;
  options.with_scale = with_scale;
  auto result = register_scan({cad, {}}, scan, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(result).value() : Registration{};
}

struct Case {
  Shape shape;
  std::size_t weak;
  const char* name;
  const char* direction;
};

/// Its scan lies so far along the cylinder that, as the start has it, half of it would hang beyond the end of the CAD.
TEST(Degenerate, DoesNotKeepAStartThatIsOffTheCad) {
  GRAVURE_TRACE_DICE();
  Dice dice(9);
  const PointSet cad = points_of(Shape::cylinder, 8000, dice);
  const PointSet scan = without_normals(moved(points_of(Shape::cylinder, 2500, dice), Similarity{}, 0.005, dice));
  RegistrationOptions options;
  options.start.translation_mm = {0, 0, 30};
  const auto result = register_scan({cad, {}}, scan, options);
  ASSERT_TRUE(result) << result.error().message;
  const Registration& found = result.value();
  EXPECT_TRUE(found.degenerate);
  EXPECT_FALSE(found.kept_as_started);
  EXPECT_GT(static_cast<double>(found.inliers), 0.9 * 2500);
}

TEST(Degenerate, NamesTheShapeAndItsFreeDirections) {
  GRAVURE_TRACE_DICE();
  for (const bool estimated : {false, true}) {
    for (const Case& is : {Case{Shape::plane, 3, "plane", "turn about (0.000, 0.000, 1.000)"},
                           {Shape::cylinder, 2, "cylinder", "turn about (0.000, 0.000, 1.000) through (3.0"},
                           {Shape::sphere, 3, "sphere", "turn about"},
                           {Shape::revolution, 1, "surface of revolution", "turn about (0.000, 0.000, 1.000)"},
                           {Shape::extrusion, 1, "extrusion", "shift along (0.000, 0.000, 1.000)"}}) {
      const Registration found = registered(is.shape, false, estimated);
      EXPECT_TRUE(found.degenerate) << is.name;
      EXPECT_EQ(found.shape, is.name) << estimated;
      EXPECT_EQ(found.weak_directions.size(), is.weak) << is.name;
      bool named = false;
      std::string all;
      for (const WeakDirection& weak : found.weak_directions) {
        named = named || (!estimated && weak.name.starts_with(is.direction)) || estimated;
        all += weak.name + "; ";
      }
      EXPECT_TRUE(named) << is.name << ": " << all;
      EXPECT_GT(found.condition_number, 1e3);
    }
  }
}

/// Turn of the CAD, and shift of its middle.
struct Way {
  Eigen::Vector3d turn;
  Eigen::Vector3d shift;
};

Way way_of(const Registration& found, const PointSet& cad) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Point3& point : cad.points_mm) {
    middle += vec(point) / static_cast<double>(cad.points_mm.size());
  }
  const Eigen::AngleAxisd turn(found.cad_to_scan.rotation);
  return {turn.angle() * turn.axis(), found.cad_to_scan.point(middle) - middle};
}

/// What the points hold of a turn by 20 mrad and a shift of 0.1 mm comes back; of what they do not hold, nothing.
TEST(Degenerate, KeepsTheFreeDirectionsAsTheyWere) {
  GRAVURE_TRACE_DICE();
  struct Free {
    Shape shape;
    Eigen::Vector3d turns;  ///< 1 where they are free
    Eigen::Vector3d shifts;
  };
  const Similarity truth = pose(0.02, {1, 1, 0.3}, {0.1, 0.1, 0.05});
  for (const bool estimated : {false, true}) {
    for (const Free& is : {Free{Shape::plane, {0, 0, 1}, {1, 1, 0}},
                           {Shape::cylinder, {0, 0, 1}, {0, 0, 1}},
                           {Shape::sphere, {1, 1, 1}, {0, 0, 0}},
                           {Shape::revolution, {0, 0, 1}, {0, 0, 0}},
                           {Shape::extrusion, {0, 0, 0}, {0, 0, 1}}}) {
      Dice dice(7);
      PointSet cad = points_of(is.shape, 8000, dice);
      const PointSet scan = without_normals(moved(points_of(is.shape, 2500, dice), truth, 0.005, dice));
      if (estimated) {
        cad.normals.clear();
      }
      const Registration found = register_scan({cad, {}}, scan, {}).value();
      EXPECT_TRUE(found.kept_as_started);
      EXPECT_LT(found.rms_mm, estimated ? 0.05 : 0.006);
      const Way way = way_of(found, cad);
      const int shape = static_cast<int>(is.shape);
      EXPECT_LT(way.turn.cwiseProduct(is.turns).norm(), 1e-3) << "shape " << shape << ", estimated " << estimated;
      EXPECT_LT(way.shift.cwiseProduct(is.shifts).norm(), 0.01) << "shape " << shape << ", estimated " << estimated;
      const Eigen::AngleAxisd turned(truth.rotation);
      const Eigen::Vector3d held = Eigen::Vector3d::Ones() - is.turns;
      EXPECT_LT((way.turn - turned.angle() * turned.axis()).cwiseProduct(held).norm(), 1.5e-3)
          << "shape " << shape << ", estimated " << estimated;
    }
  }
}

/// A start turned by 0.5 rad: the turn stays, but for what the middle of the samples, beside the centre, is brought
/// back by it.
TEST(Degenerate, KeepsTheTurnOfTheStartGiven) {
  GRAVURE_TRACE_DICE();
  Dice dice(8);
  const PointSet cad = points_of(Shape::sphere, 8000, dice);
  const PointSet scan = points_of(Shape::sphere, 2500, dice);
  RegistrationOptions options;
  options.start = pose(0.5, {1, -2, 0.5}, {0.2, 0, -0.1});
  const Registration found = register_scan({cad, {}}, without_normals(scan), options).value();
  EXPECT_LT((found.cad_to_scan.rotation - options.start.rotation).norm(), 1e-3);
  EXPECT_LT(found.cad_to_scan.translation_mm.norm(), 0.01);
}

TEST(Degenerate, RefusesScaleThatThePointsDoNotHold) {
  GRAVURE_TRACE_DICE();
  const Registration plane = registered(Shape::plane, true);
  EXPECT_TRUE(plane.scale_refused);
  EXPECT_EQ(plane.cad_to_scan.scale, 1);
  const Registration cone = registered(Shape::revolution, true);  // larger is the same as further along
  EXPECT_TRUE(cone.scale_refused);
  const Registration sphere = registered(Shape::sphere, true);
  EXPECT_FALSE(sphere.scale_refused);
  EXPECT_NEAR(sphere.cad_to_scan.scale, 1, 2e-4);
}

}  // namespace
}  // namespace gravure::registration
