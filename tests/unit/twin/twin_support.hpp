#pragma once

#include <gtest/gtest.h>

#include <string>

#include "dice.hpp"
#include "small_job.hpp"

namespace gravure::test {

/// Prepares a job of random bits; the caller may still change `small.job` before compile_job().
inline void prepare(SmallJob& small, LinesAlong along, std::int64_t lines, std::int64_t pixels, std::int64_t layers) {
  small.job = small_job(lines);
  small.job.image.lines_along = along;
  small.stack = random_stack(small.images, SampleType::bit, along, lines, pixels, layers, 11);
}

/// An 8-layer job on odd lines per revolution, exact: nothing is wrong with it.
inline void sound_job(SmallJob& small) {
  prepare(small, LinesAlong::rows, 13, 45, 8);
  compile_job(small, 8, LayerOrder::sequence);
}

inline std::string all(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return text;
}

/// One violation says this.
inline void expect_violation(const VerifyReport& report, const std::string& part) {
  EXPECT_NE(all(report.violations).find(part), std::string::npos) << "wanted: " << part << "\nviolations:\n"
                                                                  << all(report.violations);
}

inline void expect_sound(const Result<VerifyReport>& report) {
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report.value().violations.empty()) << all(report.value().violations);
  EXPECT_EQ(report.value().wrong_pixels, 0);
}

inline void expect_same(const VerifyReport& a, const VerifyReport& b) {
  EXPECT_EQ(a.revolutions, b.revolutions);
  EXPECT_EQ(a.lines, b.lines);
  EXPECT_EQ(a.fired_pixels, b.fired_pixels);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.images_compared, b.images_compared);
  EXPECT_EQ(a.wrong_pixels, b.wrong_pixels);
  ASSERT_EQ(a.first_wrong_pixel.has_value(), b.first_wrong_pixel.has_value());
  if (a.first_wrong_pixel) {
    EXPECT_EQ(a.first_wrong_pixel->revolution, b.first_wrong_pixel->revolution);
    EXPECT_EQ(a.first_wrong_pixel->line, b.first_wrong_pixel->line);
    EXPECT_EQ(a.first_wrong_pixel->column, b.first_wrong_pixel->column);
  }
  EXPECT_EQ(a.seam.size(), b.seam.size());
  EXPECT_EQ(a.seam_end_um, b.seam_end_um);
  EXPECT_EQ(a.seam_end_measured_um, b.seam_end_measured_um);
  EXPECT_EQ(a.axis_error_max_um, b.axis_error_max_um);
  EXPECT_EQ(a.axis_worst_revolution, b.axis_worst_revolution);
  EXPECT_EQ(a.axis_worst_line, b.axis_worst_line);
  EXPECT_EQ(a.ticks, b.ticks);
  EXPECT_EQ(a.violations, b.violations);
}

}  // namespace gravure::test
