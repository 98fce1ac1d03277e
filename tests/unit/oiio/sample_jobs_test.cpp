#include <gtest/gtest.h>

#include <filesystem>

#include "gravure/formats/image_files.hpp"
#include "gravure/formats/image_stack.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/sync/make_plan.hpp"
#include "honeycomb.hpp"
#include "lattice.hpp"
#include "sample_sets.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

Job sample_job(const std::string& file) {
  auto job = read_job(std::string(GRAVURE_SAMPLES) + "/" + file);
  EXPECT_TRUE(job) << job.error().message;
  return job ? job.value() : Job();
}

/// The committed job with its pictures made beside it, from header to plan.
void expect_sample_fits(const std::string& set_name, const std::string& job_file, std::int64_t layers) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "layers");
  for (const auto& set : samples::sample_sets()) {
    if (set.name == set_name) {
      const auto made = set.make(folder / "layers");
      ASSERT_TRUE(made) << made.error().message;
    }
  }
  Job job = sample_job(set_name + "/" + job_file);
  job.path = folder / job_file;
  const ImageFiles files;
  const auto stack = scan_stack(job, files);
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_EQ(stack.value().layers, layers);
  EXPECT_TRUE(stack.value().warnings.empty());
  const auto revolutions = resolve_revolutions(job, layers);
  ASSERT_TRUE(revolutions) << revolutions.error().message;
  const ScanSize size = scan_size(job.image, stack.value().width(), stack.value().height());
  const auto plan = make_plan(job, size.pixels_per_line, revolutions.value());
  ASSERT_TRUE(plan) << plan.error().message;
  const auto warnings = check_stack(plan.value(), job, stack.value());
  ASSERT_TRUE(warnings) << warnings.error().message;
  EXPECT_TRUE(warnings.value().empty()) << warnings.value().front();
}

TEST(SampleJobs, SmallFitsItsPicturesUprightAndOnTheirSide) {
  expect_sample_fits("small", "job.toml", 6);
  expect_sample_fits("small", "columns.toml", 6);
}

TEST(SampleJobs, SmallFitsItsPicturesInEveryMode) {
  expect_sample_fits("small", "helical.toml", 6);
  expect_sample_fits("small", "flat.toml", 6);
  expect_sample_fits("small", "bands.toml", 6);
}

TEST(SampleJobs, PanelHasTwoBandsOfItsPictures) {
  expect_sample_fits("panel", "job.toml", 4);
  const auto plan = make_plan(sample_job("panel/job.toml"), 5000, 4);
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_TRUE(plan.value().bands);
  EXPECT_EQ(plan.value().bands->count, 2);
}

/// Its pictures take seconds to write.
TEST(SampleJobs, HelicalRollerIsWiderThanTheFieldAndNeedsOnePass) {
  const Job job = sample_job("helical_roller/job.toml");
  const auto plan = make_plan(job, 15'000, 8);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_TRUE(plan.value().warnings.empty());
  EXPECT_GT(Rational(15'000) * job.scanner.pixel_pitch_um, *job.scanner.field_mm * 1000);
  EXPECT_EQ(plan.value().line.pixels, 512);
  EXPECT_EQ(plan.value().job.revolutions, 243);
}

TEST(SampleJobs, SmallTakesItsLayersInNaturalOrder) {
  const TempFolder folder;
  for (const auto& set : samples::sample_sets()) {
    if (set.name == "small") {
      ASSERT_TRUE(set.make(folder.path()));
    }
  }
  const auto files = expand_patterns(folder.path(), {"layer_*.tif"});
  ASSERT_TRUE(files) << files.error().message;
  EXPECT_EQ(files.value().front(), folder / "layer_8.tif");
  EXPECT_EQ(files.value().back(), folder / "layer_13.tif");
}

TEST(SampleJobs, StentFitsItsMask) {
  expect_sample_fits("stent", "job.toml", 1);
}

/// The map itself takes seconds to write; its size is known before.
TEST(SampleJobs, RollerFitsItsHoneycomb) {
  const Job job = sample_job("roller/job.toml");
  const auto plan = make_plan(job, samples::Honeycomb::kWidth, *job.image.revolutions);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan.value().rotary.lines_per_revolution, samples::Honeycomb::kHeight);
  EXPECT_EQ(plan.value().line.slots, 5300);
}

/// [B], second set-up: k = 16, pitch 6 um, increment near 2^21, at most 80 kHz.
TEST(SampleJobs, StentRunsJustBelowTheCapOfItsDrive) {
  const Job job = sample_job("stent/job.toml");
  const auto plan = make_plan(job, samples::DiamondLattice::kWidth, *job.image.revolutions);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan.value().rotary.lines_per_revolution, samples::DiamondLattice::kHeight);
  EXPECT_EQ(plan.value().line.slots, 5600);
  EXPECT_EQ(plan.value().ab.increment, 981'088'033U);
  EXPECT_EQ(plan.value().ab.prescaler, 482U);
  EXPECT_LE(plan.value().ab.output_hz, 80'000);
  Job faster = job;
  faster.rotary.interpolation_bits = 4;
  EXPECT_FALSE(make_plan(faster, samples::DiamondLattice::kWidth, *job.image.revolutions));
}

TEST(SampleHoneycomb, ClosesRoundTheCircumference) {
  const samples::Honeycomb honeycomb;
  std::vector<std::uint16_t> first(static_cast<std::size_t>(samples::Honeycomb::kWidth));
  std::vector<std::uint16_t> last(first.size());
  std::vector<std::uint16_t> other(first.size());
  const auto largest_step = [](const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b) {
    int largest = 0;
    for (std::size_t x = 0; x < a.size(); ++x) {
      largest = std::max(largest, std::abs(int{a[x]} - int{b[x]}));
    }
    return largest;
  };
  honeycomb.row(0, first);
  honeycomb.row(samples::Honeycomb::kHeight - 1, last);
  // Over the seam the relief steps no more than between any other two lines: a flank is 60 um long, a line 8 um.
  EXPECT_LE(largest_step(first, last), 65535 * 8 / 60 + 1);
  honeycomb.row(60, other);
  EXPECT_GT(largest_step(first, other), 30000) << "the lines are not all alike";
}

TEST(SampleHoneycomb, InvertsItsRightHalf) {
  const samples::Honeycomb honeycomb;
  std::vector<std::uint16_t> row(static_cast<std::size_t>(samples::Honeycomb::kWidth));
  double left = 0;
  double right = 0;
  for (std::int64_t y = 0; y < samples::Honeycomb::kLinesPerCell; ++y) {
    honeycomb.row(y, row);
    for (std::size_t x = 0; x < row.size(); ++x) {
      (x < row.size() / 2 ? left : right) += row[x];
    }
  }
  EXPECT_GT(left, 1.2 * right);
}

TEST(SampleLattice, GoesRoundAndAlongInWholeDiamonds) {
  std::vector<std::uint16_t> a(static_cast<std::size_t>(samples::DiamondLattice::kWidth));
  std::vector<std::uint16_t> b(a.size());
  for (std::int64_t y = 0; y + samples::DiamondLattice::kCellLines < samples::DiamondLattice::kHeight; y += 13) {
    samples::DiamondLattice::row(y, a);
    samples::DiamondLattice::row(y + samples::DiamondLattice::kCellLines, b);
    ASSERT_EQ(a, b) << y;
  }
}

}  // namespace
}  // namespace gravure::test
