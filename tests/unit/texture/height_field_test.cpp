#include "gravure/texture/height_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dice.hpp"
#include "memory_images.hpp"
#include "published_surface.hpp"

namespace gravure::texture {
namespace {

using gravure::test::Dice;

template <class Height>
HeightGrid grid_of(std::int64_t columns, std::int64_t rows, double pitch_x_mm, double pitch_y_mm,
                   const Height& height) {
  HeightGrid grid{columns, rows, pitch_x_mm, pitch_y_mm, {}};
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t column = 0; column < columns; ++column) {
      grid.heights_mm.push_back(
          height((static_cast<double>(column) - static_cast<double>(columns - 1) / 2) * pitch_x_mm,
                 (static_cast<double>(rows - 1) / 2 - static_cast<double>(row)) * pitch_y_mm));
    }
  }
  return grid;
}

TEST(HeightField, PassesThroughEveryHeight) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (const auto& [columns, rows] : {std::pair(2, 2), std::pair(2, 7), std::pair(9, 5), std::pair(31, 40)}) {
    const HeightGrid grid = grid_of(columns, rows, 0.5, 0.25, [&dice](double, double) {
      return 0.01 * static_cast<double>(dice.between(-500, 500));
    });
    const auto surface = height_field_surface(grid).value();
    for (std::int64_t i = 0; i < columns * rows; ++i) {
      const Vector2 at((static_cast<double>(i % columns) - (columns - 1) / 2.0) * 0.5,
                       ((rows - 1) / 2.0 - static_cast<double>(i / columns)) * 0.25);
      EXPECT_NEAR(test::on(*surface, {at})[0].position_mm.z(), grid.heights_mm[static_cast<std::size_t>(i)], 1e-12);
    }
  }
}

TEST(HeightField, IsExactForPlanesEverywhere) {
  const auto surface =
      height_field_surface(grid_of(7, 4, 1.5, 2, [](double x, double y) { return 3 + 0.2 * x - 0.7 * y; }));
  for (const Vector2& at : {Vector2(-4.5, -3), Vector2(4.5, 3), Vector2(0.123, -2.9), Vector2(-4.49, 1)}) {
    const SurfacePoint point = test::on(*surface.value(), {at})[0];
    EXPECT_NEAR(point.position_mm.z(), 3 + 0.2 * at.x() - 0.7 * at.y(), 1e-13);
    EXPECT_LT((point.normal - Vector3(-0.2, 0.7, 1).normalized()).norm(), 1e-13);
  }
}

/// Errors of the spline fall with the fourth power of the pitch (slopes: third), away from the rim.
TEST(HeightField, ComesCloseToTheSurfaceItWasSampledFrom) {
  const auto stated = test::published_surface();
  const auto field = height_field_surface(grid_of(201, 201, 0.25, 0.25, [&stated](double x, double y) {
    return test::on(*stated, {Vector2(x, y)})[0].position_mm.z();
  }));
  for (int i = 0; i < 500; ++i) {
    const Vector2 at(-20 + 0.0801 * i, 20 * std::sin(0.37 * i));
    const SurfacePoint truth = test::on(*stated, {at})[0];
    const SurfacePoint found = test::on(*field.value(), {at})[0];
    EXPECT_NEAR(found.position_mm.z(), truth.position_mm.z(), 1e-7);
    EXPECT_LT((found.normal - truth.normal).norm(), 1e-6);
  }
}

TEST(HeightField, HasContinuousNormalsFromCellToCell) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  const auto surface = height_field_surface(grid_of(12, 12, 1, 1, [&dice](double, double) {
                         return 0.001 * static_cast<double>(dice.between(-900, 900));
                       })).value();
  for (int cell = -4; cell <= 4; ++cell) {
    for (const double side : {-3.3, 0.1, 2.7}) {
      const double edge = cell + 0.5;
      const auto points =
          test::on(*surface, {{edge - 1e-9, side}, {edge + 1e-9, side}, {side, edge - 1e-9}, {side, edge + 1e-9}});
      EXPECT_LT((points[0].normal - points[1].normal).norm(), 1e-7);
      EXPECT_LT((points[2].normal - points[3].normal).norm(), 1e-7);
    }
  }
}

TEST(HeightField, EndsAtItsOutermostSamples) {
  const auto surface = height_field_surface(grid_of(3, 5, 1, 1, [](double, double) { return 0; })).value();
  std::vector<SurfacePoint> out(1);
  EXPECT_TRUE(surface->project(std::vector<Vector2>{{-1, 2}}, out));
  for (const Vector2& at : {Vector2(1.001, 0), Vector2(0, -2.001), Vector2(NAN, 0)}) {
    const Result<void> projected = surface->project(std::vector<Vector2>{at}, out);
    ASSERT_FALSE(projected);
    EXPECT_EQ(projected.error().code, ErrorCode::out_of_range);
    EXPECT_NE(projected.error().message.find("from -1 to 1 mm in x and from -2 to 2 mm in y"), std::string::npos);
  }
}

TEST(HeightField, RefusesGridsThatSpanNothing) {
  EXPECT_EQ(height_field_surface({1, 2, 1, 1, {0, 0}}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(height_field_surface({2, 2, 1, 1, {0, 0, 0}}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(height_field_surface({2, 2, 0, 1, {0, 0, 0, 0}}).error().code, ErrorCode::bad_argument);
  EXPECT_EQ(height_field_surface({2, 2, 1, NAN, {0, 0, 0, 0}}).error().code, ErrorCode::bad_argument);
}

std::unique_ptr<ImageSource> picture(gravure::test::MemoryImages& images, SampleType samples, double value) {
  gravure::test::MemoryImages::Image image;
  image.info.path = "map";
  image.info.width = 3;
  image.info.height = 2;
  image.info.samples = samples;
  image.samples = [value](std::int64_t row, std::int64_t column) { return row == 1 && column == 2 ? value : 0; };
  images.add(image);
  return images.open("map", 0).value();
}

TEST(HeightGrid, ScalesSixteenBitsAndFloats) {
  gravure::test::MemoryImages images;
  const HeightScale scale{.pitch_x_mm = 0.1, .pitch_y_mm = 0.2, .low_mm = -1, .high_mm = 4};
  const auto words = read_height_grid(*picture(images, SampleType::u16, 65535), scale);
  ASSERT_TRUE(words) << words.error().message;
  EXPECT_EQ(words.value().columns, 3);
  EXPECT_EQ(words.value().rows, 2);
  EXPECT_EQ(words.value().heights_mm, (std::vector<double>{-1, -1, -1, -1, -1, 4}));
  const auto floats = read_height_grid(*picture(images, SampleType::f32, 0.5), scale);
  EXPECT_EQ(floats.value().heights_mm, (std::vector<double>{-1, -1, -1, -1, -1, 1.5}));
}

TEST(HeightGrid, RefusesWhatIsNoSurface) {
  gravure::test::MemoryImages images;
  const HeightScale scale{.pitch_x_mm = 0.1, .pitch_y_mm = 0.1};
  EXPECT_EQ(read_height_grid(*picture(images, SampleType::u8, 1), scale).error().code, ErrorCode::bad_file);
  EXPECT_EQ(read_height_grid(*picture(images, SampleType::bit, 1), scale).error().code, ErrorCode::bad_file);
  const auto nan = read_height_grid(*picture(images, SampleType::f32, NAN), scale);
  ASSERT_FALSE(nan);
  EXPECT_NE(nan.error().message.find("row 1, column 2"), std::string::npos);
  const HeightScale flat{.pitch_x_mm = 0.1, .pitch_y_mm = 0.1, .low_mm = 1, .high_mm = 1};
  EXPECT_EQ(read_height_grid(*picture(images, SampleType::u16, 1), flat).error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::texture
