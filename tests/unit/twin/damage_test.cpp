#include <algorithm>

#include "twin_support.hpp"

/// Every way a program can be wrong that the file's own checksums would not show: each must be caught by running it.
namespace gravure::test {
namespace {

constexpr std::int64_t kBytes = 6;  // of a line of 45 pixels

VerifyReport damaged_report(const SmallJob& small, const MemorySource::Damage& damage) {
  const Result<VerifyReport> report = verify_job(small, small.lines(), {.threads = 2}, emulated(), damage);
  EXPECT_TRUE(report) << report.error().message;
  return report ? report.value() : VerifyReport{};
}

VerifyReport changed_report(const SmallJob& small) {
  return damaged_report(small, {});
}

TEST(Damage, OfOneBitIsFoundWhereverItIs) {
  SmallJob small;
  sound_job(small);
  for (std::int64_t line = 0; line < 13; ++line) {
    for (std::int64_t bit = 0; bit < 45; ++bit) {
      const VerifyReport report = damaged_report(small, [&](ChunkAddress address, std::span<std::byte> lines) {
        if (address.layer == 5 && address.chunk == line / 4) {
          lines[static_cast<std::size_t>(line % 4 * kBytes + bit / 8)] ^= static_cast<std::byte>(0x80U >> (bit % 8));
        }
      });
      ASSERT_EQ(report.wrong_pixels, 1);
      ASSERT_TRUE(report.first_wrong_pixel);
      ASSERT_EQ(report.first_wrong_pixel->revolution, 5);
      ASSERT_EQ(report.first_wrong_pixel->line, line);
      const bool reverse = (5 * 13 + line) % 2 != 0;
      ASSERT_EQ(report.first_wrong_pixel->column, reverse ? 44 - bit : bit);
      ASSERT_EQ(report.violations.size(), 1U);
    }
  }
  const VerifyReport report = damaged_report(small, [](ChunkAddress address, std::span<std::byte> lines) {
    lines[0] ^= address.layer == 5 && address.chunk == 2 ? std::byte{0x80} : std::byte{0};
  });
  expect_violation(report, "1 landed pixels differ from the images, the first at revolution 5, line 8, column 44");
}

TEST(Damage, OfUnusedBitsIsRefusedByTheDevice) {
  SmallJob small;
  sound_job(small);
  const VerifyReport report = damaged_report(small, [](ChunkAddress address, std::span<std::byte> lines) {
    if (address.layer == 4 && address.chunk == 1) {
      lines[static_cast<std::size_t>(2 * kBytes - 1)] |= std::byte{1};
    }
  });
  expect_violation(report, "the device refused revolution 4, line 5");
  expect_violation(report, "its 3 low bits lie past the window");
}

TEST(Damage, OfAMissingLineIsFound) {
  SmallJob small;
  sound_job(small);
  // The source gives the lines after the missing one a place earlier, and nothing in the last place.
  const VerifyReport report = damaged_report(small, [](ChunkAddress address, std::span<std::byte> lines) {
    if (address.layer == 2 && address.chunk == 1) {
      std::copy(lines.begin() + 2 * kBytes, lines.end(), lines.begin() + kBytes);
      std::fill(lines.end() - kBytes, lines.end(), std::byte{0});
    }
  });
  expect_violation(report, "landed pixels differ from the images, the first at revolution 2, line 5");
}

TEST(Damage, OfAShorterChunkIsAnError) {
  SmallJob small;
  sound_job(small);
  small.program.chunks.at({2, 1}).bytes.resize(3 * kBytes);
  const Result<VerifyReport> report = verify_job(small, small.lines());
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::bad_file);
}

TEST(Damage, OfSwappedLinesIsFound) {
  SmallJob small;
  sound_job(small);
  for (const std::int64_t apart : {1, 2}) {  // lines of either direction
    const VerifyReport report = damaged_report(small, [&](ChunkAddress address, std::span<std::byte> lines) {
      if (address.layer == 7 && address.chunk == 0) {
        std::swap_ranges(lines.begin(), lines.begin() + kBytes, lines.begin() + apart * kBytes);
      }
    });
    expect_violation(report, "landed pixels differ from the images, the first at revolution 7, line 0");
  }
}

TEST(Damage, OfTheStoredDirectionIsFound) {
  SmallJob small;
  sound_job(small);
  small.program.header.layers[3].starts_reverse = !small.program.header.layers[3].starts_reverse;
  expect_violation(changed_report(small), "landed pixels differ from the images, the first at revolution 3, line 0");
}

TEST(Damage, OfTheImagesIsFound) {
  SmallJob small;
  sound_job(small);
  MemoryImages::Image& image = small.images.at("layer6");
  image.samples = [before = image.samples](std::int64_t row, std::int64_t column) {
    return row == 9 && column == 31 ? 1.0 - before(row, column) : before(row, column);
  };
  expect_violation(changed_report(small),
                   "1 landed pixels differ from the images, the first at revolution 6, line 9, column 31");
  image.info.zero_is_white = true;
  EXPECT_GT(changed_report(small).wrong_pixels, 500) << "the polarity of an image counts";
  image.info.height = 14;
  expect_violation(changed_report(small),
                   "the image of layer 6 cannot be read, so 13 lines were not compared: "
                   "layer6: page 0: is 45 x 14 pixels of 1 bit, the job has 45 x 13 of 1");
}

TEST(Damage, OfTheIncrementIsFound) {
  for (const std::int64_t change : {-1, 1, 1000}) {
    SmallJob small;
    sound_job(small);
    small.program.header.plan.ab.increment += static_cast<std::uint64_t>(change);
    const VerifyReport report = changed_report(small);
    expect_violation(report, "they are not those of this geometry");
    EXPECT_NE(report.seam_end_um, 0.0) << "the seam is that of the registers, not of the plan's word";
  }
}

TEST(Damage, OfTheIncrementMovesTheAxisAwayFromThePlan) {
  SmallJob small;
  sound_job(small);
  small.program.header.plan.ab.increment += small.program.header.plan.ab.increment / 100;
  const VerifyReport report = changed_report(small);
  expect_violation(report, "at the end of the last line the device's axis is");
  expect_violation(report, "exceeds limits.seam_um");
  expect_violation(report, "the axis is half a line or more away");
}

TEST(Damage, OfTheFractionIsFound) {
  SmallJob small;
  sound_job(small);
  AbPlan& ab = small.program.header.plan.ab;
  ASSERT_GT(ab.fraction_den, 1U) << "this job is to need its fraction";
  const AbPlan good = ab;
  ab.fraction_num = ab.fraction_num > 0 ? ab.fraction_num - 1 : 1;
  expect_violation(changed_report(small), "they are not those of this geometry");
  ab = good;
  ab.fraction_den += 1;
  expect_violation(changed_report(small), "they are not those of this geometry");
  ab = good;
  ab.fraction_num = ab.fraction_den;
  expect_violation(changed_report(small), "the device refused revolution 0, line 0");
  ab.fraction_den = 0;
  EXPECT_FALSE(verify_job(small, small.lines())) << "a division by zero is no report";
}

TEST(Damage, OfThePrescalerIsFound) {
  SmallJob small;
  sound_job(small);
  AbPlan& ab = small.program.header.plan.ab;
  ab.prescaler += 1;
  const VerifyReport report = changed_report(small);
  expect_violation(report, "they are not those of this geometry");
  expect_violation(report, "the axis is half a line or more away");
  ab.prescaler = 0;
  EXPECT_FALSE(verify_job(small, small.lines()));
}

TEST(Damage, OfTheWindowIsFound) {
  for (const std::int64_t change : {-1, 1}) {
    SmallJob small;
    sound_job(small);
    LinePlan& line = small.program.header.plan.line;
    line.forward_first_slot += change;
    expect_violation(changed_report(small), "the marking windows start at slots");
    line.forward_first_slot -= change;
    line.reverse_first_slot += change;
    expect_violation(changed_report(small), "the marking windows start at slots");
  }
}

TEST(Damage, OfAWindowOutsideTheLineIsRefusedByTheDevice) {
  SmallJob small;
  sound_job(small);
  small.program.header.plan.line.reverse_first_slot = small.program.header.plan.line.slots;
  const VerifyReport report = changed_report(small);
  expect_violation(report, "the device refused revolution 0, line 1");
  expect_violation(report, "lines were never executed");
}

}  // namespace
}  // namespace gravure::test
