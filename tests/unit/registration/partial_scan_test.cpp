#include <gtest/gtest.h>

#include <numbers>

#include "registration_test_support.hpp"

namespace gravure::registration {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

/// The blade from `from_mm` to its tip, without its platform, 10 um of noise.
PointSet tip(double from_mm, const Similarity& by, Dice& dice) {
  PointSet set;
  for (int i = 0; i < 4000; ++i) {
    const double angle = 2 * std::numbers::pi * BladeSurface::unit(dice);
    const double z = from_mm + (BladeSurface::kSpanMm - from_mm) * BladeSurface::unit(dice);
    set.points_mm.push_back(BladeSurface::on_blade(angle, z).point);
  }
  return moved(set, by, 0.01, dice);
}

/// A tapered, twisted blade lies on itself when it screws along its span, and a larger one does so a little further on:
/// with that direction left where it was, any scale found would be 0.7 % off and the pose 5 mm.
TEST(PartialScan, OfATipHoldsNoScaleAndSaysWhatIsFree) {
  GRAVURE_TRACE_DICE();
  Dice dice(31);
  CadModel cad;
  cad.samples = BladeSurface::points(20'000, dice);
  for (const double from_mm : {30.0, 60.0, 100.0, 130.0}) {
    for (const double scale : {1.0, 1.01}) {
      const PointSet scan = tip(from_mm, pose(0.0105, {1, 2, -1.5}, {0.3, -0.35, 0.2}, scale), dice);
      RegistrationOptions options;
      options.with_scale = true;
      const Registration found = register_scan(cad, scan, options).value();
      EXPECT_TRUE(found.scale_refused) << from_mm << ", " << scale;
      EXPECT_EQ(found.cad_to_scan.scale, 1) << from_mm << ", " << scale;
      EXPECT_TRUE(found.degenerate) << from_mm << ", " << scale;
      ASSERT_FALSE(found.weak_directions.empty());
      EXPECT_TRUE(found.weak_directions[0].name.starts_with("screw of")) << found.weak_directions[0].name;
    }
  }
}

/// Parts of the blade with or without some platform, cut at random: what is wrong by more than ten times the noise is
/// always flagged.
TEST(PartialScan, IsNeverSilentlyWrong) {
  GRAVURE_TRACE_DICE();
  Dice dice(32);
  CadModel cad;
  cad.samples = BladeSurface::points(20'000, dice);
  const auto unit = [&dice] { return BladeSurface::unit(dice); };
  for (int trial = 0; trial < 12; ++trial) {
    RegistrationOptions options;
    options.with_scale = trial % 3 != 0;
    const double scale = options.with_scale ? 0.98 + 0.04 * unit() : 1;
    const double far = trial % 2 == 0 ? 1 : 6;
    const Similarity truth = pose(0.0105 * far, {1, 2, -1.5}, {0.3 * far, -0.35 * far, 0.2 * far}, scale);
    const double low = 140 * unit();
    const double high = low + 10 + (140 - low) * unit();
    const double first = unit();
    const double share = 0.3 + 0.7 * unit();
    const double platform = trial % 4 < 2 ? 0 : 0.15 * unit();
    PointSet part;
    for (int i = 0; i < 4000; ++i) {
      const double u = unit();
      part.points_mm.push_back(
          unit() < platform
              ? Point3{-40 + 80 * u, 7 + 20 * unit(), 0}
              : BladeSurface::on_blade(2 * std::numbers::pi * (first + share * u), low + (high - low) * unit()).point);
    }
    const PointSet scan = moved(part, truth, 0.01, dice);
    const auto made = register_scan(cad, scan, options);
    if (!made) {
      continue;  // refused
    }
    const Registration& found = made.value();
    const bool flagged = !found.converged || found.degenerate || found.scale_refused || found.ambiguous;
    EXPECT_TRUE(flagged || rms_between(found.cad_to_scan, truth, part.points_mm) < 0.1) << "trial " << trial;
  }
}

}  // namespace
}  // namespace gravure::registration
