#include "gravure/report/layer_pictures.hpp"

#include "gravure/core/units.hpp"
#include "gravure/report/report_data.hpp"
#include "report_support.hpp"

namespace gravure::report {
namespace {

using gravure::test::emulated;
using gravure::test::image_pixel;
using test::opener;
using test::prepare;
using test::SmallJob;

TEST(LayerPictures, ShowWhatTheImagesFireInEveryOrientationAndPolarity) {
  for (const LinesAlong along : {LinesAlong::rows, LinesAlong::columns}) {
    for (const Fires fires : {Fires::white, Fires::black}) {
      SmallJob small;
      prepare(small, along, fires, 7);  // layer 0 on revolutions 0, 3 and 6, the others on two
      LayerPicturesOptions options;
      options.threads = 3;
      options.most_seam_lines = 5;
      options.most_seam_columns = 20;
      const Result<LayerPictures> made = layer_pictures(opener(small), emulated(), options);
      ASSERT_TRUE(made) << made.error().message;
      const LayerPictures& pictures = made.value();
      const bool rows = along == LinesAlong::rows;
      ASSERT_EQ(pictures.cells.width, rows ? 45 : 26);
      ASSERT_EQ(pictures.layers.size(), 3U);
      EXPECT_EQ(pictures.exposures, 7);
      std::int64_t pulses = 0;
      for (std::int64_t layer = 0; layer < 3; ++layer) {
        const LayerPicture& picture = pictures.layers[static_cast<std::size_t>(layer)];
        EXPECT_EQ(picture.revolutions, layer == 0 ? 3 : 2);
        std::int64_t fired = 0;
        for (std::int64_t line = 0; line < 26; ++line) {
          for (std::int64_t column = 0; column < 45; ++column) {
            const bool wanted = image_pixel(small.stack, small.images, layer, line, column);
            const std::int64_t cell = rows ? line * 45 + column : column * 26 + line;
            ASSERT_EQ(picture.shares[static_cast<std::size_t>(cell)], wanted ? std::byte{255} : std::byte{0});
            fired += wanted ? 1 : 0;
          }
        }
        EXPECT_EQ(picture.fired_pixels, fired);
        pulses += fired * picture.revolutions;
        // Lines 21 .. 25, then 0 .. 4, of columns 12 .. 31.
        for (std::int64_t k = 0; k < 10; ++k) {
          for (std::int64_t c = 0; c < 20; ++c) {
            const bool wanted = image_pixel(small.stack, small.images, layer, (k + 21) % 26, 12 + c);
            const std::int64_t at = rows ? k * 20 + c : c * 10 + k;
            ASSERT_EQ(picture.seam[static_cast<std::size_t>(at)], wanted ? std::byte{255} : std::byte{0}) << k << c;
          }
        }
      }
      std::int64_t sum = 0;
      std::int64_t of_columns = 0;
      for (const std::int64_t some : pictures.pulses) {
        sum += some;
      }
      for (const std::int64_t some : pictures.column_pulses) {
        of_columns += some;
      }
      EXPECT_EQ(sum, pulses);
      EXPECT_EQ(of_columns, pulses);
      EXPECT_EQ(pictures.column_pulses.size(), 45U);
    }
  }
}

TEST(LayerPictures, KeepCountsExactWhereCellsHoldManyPixels) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::black, 3);
  LayerPicturesOptions options;
  options.most_cells = 20;
  const Result<LayerPictures> made = layer_pictures(opener(small), emulated(), options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_LE(made.value().cells.area(), 20);
  std::int64_t fired = 0;
  std::int64_t pulses = 0;
  for (const LayerPicture& layer : made.value().layers) {
    fired += layer.fired_pixels;
    EXPECT_EQ(layer.fired_pixels, small.program.header.layers[static_cast<std::size_t>(layer.layer)].fired_pixels);
  }
  for (const std::int64_t some : made.value().pulses) {
    pulses += some;
  }
  EXPECT_EQ(pulses, fired);
}

TEST(LayerPictures, ShowFewerLayersEvenlyAndStillAddAll) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3);
  LayerPicturesOptions options;
  options.most_shown_layers = 2;
  const Result<LayerPictures> made = layer_pictures(opener(small), emulated(), options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made.value().layers[0].shares.empty());
  EXPECT_TRUE(made.value().layers[1].shares.empty());
  EXPECT_FALSE(made.value().layers[2].shares.empty());
  EXPECT_GT(made.value().layers[1].fired_pixels, 0);
}

TEST(LayerPictures, ShowOneLayerAloneWhereAskedTo) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 7);
  LayerPicturesOptions options;
  options.only_layer = 2;
  const Result<LayerPictures> made = layer_pictures(opener(small), emulated(), options);
  ASSERT_TRUE(made) << made.error().message;
  std::int64_t pulses = 0;
  for (const std::int64_t some : made.value().pulses) {
    pulses += some;
  }
  EXPECT_EQ(pulses, small.program.header.layers[2].fired_pixels);
  EXPECT_FALSE(made.value().layers[2].shares.empty());
  options.only_layer = 3;
  EXPECT_EQ(layer_pictures(opener(small), emulated(), options).error().code, ErrorCode::out_of_range);
}

TEST(LayerPictures, WorkWithAsManyWorkersAsTheBudgetHoldsAndNameAllOfItWhereItHoldsNone) {
  SmallJob small;
  prepare(small, LinesAlong::columns, Fires::white, 7);
  LayerPicturesOptions options;
  options.threads = 4;
  options.table_bytes = 4 * kMiB;
  options.memory_bytes = 11 * kMiB;  // for one
  const Result<LayerPictures> made = layer_pictures(opener(small), emulated(), options);
  EXPECT_TRUE(made) << made.error().message;
  options.memory_bytes = 8 * kMiB;
  const Result<LayerPictures> refused = layer_pictures(opener(small), emulated(), options);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("budget of 8 MiB: turning this picture needs at least 11 MiB"),
            std::string::npos)
      << refused.error().message;
}

TEST(LayerPictures, StopWhenCancelled) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3);
  CancelToken cancel;
  cancel.cancel();
  LayerPicturesOptions options;
  options.cancel = &cancel;
  EXPECT_EQ(layer_pictures(opener(small), emulated(), options).error().code, ErrorCode::cancelled);
}

TEST(Relief, IsThePulsesOfACellOrTheVolumeTheyRemoveOverItsArea) {
  SmallJob small;
  prepare(small, LinesAlong::columns, Fires::white, 7);
  const Result<LayerPictures> made = layer_pictures(opener(small), emulated(), {});
  ASSERT_TRUE(made) << made.error().message;
  const Plan& plan = small.program.header.plan;
  const Relief pulses = relief_of(made.value(), plan, std::nullopt);
  EXPECT_FALSE(pulses.in_um);
  EXPECT_LE(pulses.deepest, 7);
  const PulseRemoval removal{10, 2, 1, 0.05};
  const Relief depth = relief_of(made.value(), plan, removal);
  EXPECT_TRUE(depth.in_um);
  const double per_pulse =
      removal.volume_um3(0) / (to_double(plan.line.pixel_pitch_um) * to_double(plan.rotary.line_pitch_um));
  for (std::size_t cell = 0; cell < depth.cells.size(); ++cell) {
    ASSERT_NEAR(depth.cells[cell], pulses.cells[cell] * per_pulse, 1e-12);
  }
  EXPECT_NEAR(depth.mean, pulses.mean * per_pulse, 1e-12);
}

TEST(SeamSeries, KeepsFirstAndLastAndTheBoundOfThePublication) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3);
  Plan plan = small.program.header.plan;
  plan.ab.increment = 1000;
  VerifyReport verified;
  verified.seam_limit_um = 0.5;
  for (std::int64_t r = 0; r < 5000; ++r) {
    verified.seam.push_back({r, 0, static_cast<double>(r + 1) * 1e-3});
  }
  const SeamSeries series = seam_series(verified, plan, 100);
  ASSERT_EQ(series.points.size(), 100U);
  EXPECT_EQ(series.points.front().revolution, 0);
  EXPECT_EQ(series.points.back().revolution, 4999);
  EXPECT_EQ(series.points.back().drift_um, 5.0);
  EXPECT_EQ(series.limit_um, 0.5);
  EXPECT_NEAR(series.bound_um_per_revolution, to_double(plan.rotary.circumference_um) / 2000, 1e-12);
}

}  // namespace
}  // namespace gravure::report
