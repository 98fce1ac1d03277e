#include "gravure/report/layer_pictures.hpp"

#include <atomic>
#include <chrono>
#include <new>

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
  EXPECT_EQ(refused.error().message,
            "memory budget of 8 MiB: drawing this program in 26 x 45 cells needs at least 11 MiB, 1 of them for the "
            "cells and 4 for the tables of its chunks: raise --memory");
}

/// Opens programs, says how many were opened, and fails as it is told to.
struct Opened {
  explicit Opened(const SmallJob& small) : open(opener(small)) {}
  Result<LayerPictures> pictures(const LayerPicturesOptions& options) {
    readers = 0;
    return layer_pictures(
        [this]() -> Result<std::unique_ptr<LineSource>> {
          if (readers++ > 0 && greedy) {
            throw std::bad_alloc();
          }
          return open();
        },
        emulated(), options);
  }
  std::function<Result<std::unique_ptr<LineSource>>()> open;
  std::atomic<int> readers = 0;
  bool greedy = false;
};

TEST(LayerPictures, CountTheirCellsInTheBudget) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3, 1000, 1000);
  Opened opened(small);
  LayerPicturesOptions options;
  options.most_cells = options.most_shown_cells = 3'000'000;
  options.most_shown_layers = 0;  // a million cells: 8 MB of pulses
  options.threads = 4;
  options.remedy = "raise --memory, or lower --width, which is 1000";
  options.memory_bytes = 15 * kMiB;
  const Result<LayerPictures> made = opened.pictures(options);
  EXPECT_TRUE(made) << made.error().message;
  EXPECT_EQ(opened.readers, 1 + 1) << "one worker; there is one reader to plan with";
  options.memory_bytes = 8 * kMiB;
  const Result<LayerPictures> refused = opened.pictures(options);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(refused.error().message,
            "memory budget of 8 MiB: drawing this program in 1000 x 1000 cells needs at least 15 MiB, 8 of them for "
            "the cells and 0 for the tables of its chunks: raise --memory, or lower --width, which is 1000");
  options.most_shown_layers = 3;  // 3 bytes a cell more
  options.memory_bytes = 15 * kMiB;
  EXPECT_EQ(opened.pictures(options).error().code, ErrorCode::out_of_range);
  options.memory_bytes = 30 * kMiB;
  EXPECT_TRUE(opened.pictures(options));
  EXPECT_EQ(opened.readers, 1 + 3);
  options.later_bytes = [](const Extent& cells, const Extent&, std::int64_t shown_layers) {
    return shown_layers * 12 * cells.area();  // made of the pictures when the workers are gone
  };
  EXPECT_EQ(opened.pictures(options).error().code, ErrorCode::out_of_range);
}

TEST(LayerPictures, RunOutOfMemoryWithAnError) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3);
  Opened opened(small);
  opened.greedy = true;
  for (const int threads : {1, 3}) {
    LayerPicturesOptions options;
    options.threads = threads;
    const Result<LayerPictures> failed = opened.pictures(options);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, ErrorCode::io);
    EXPECT_EQ(failed.error().message, "out of memory: lower --memory or --threads");
  }
}

/// Where each of them goes through all, it is minutes.
TEST(LayerPictures, Of65536LevelsAreNumberedAtOnce) {
  constexpr std::uint32_t kLevels = 65'536;
  ProgramHeader header;
  header.plan.job.revolutions = kLevels;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    StoredLayer layer;
    layer.level = level;
    header.layers.push_back(layer);
    header.layer_of_revolution.push_back(level);
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(exposures_of_images(header), std::vector<std::int64_t>(kLevels, 1));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
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
