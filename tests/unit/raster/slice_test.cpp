#include "gravure/raster/slice.hpp"

#include <algorithm>

#include "gravure/core/exact.hpp"
#include "raster_support.hpp"

namespace gravure::raster {
namespace {

/// Pulses of a sample by the definition, in rationals: the depth as a share of the range, times levels, halves up.
std::int64_t count_by_definition(std::uint32_t sample, const SliceRange& range) {
  const Rational depth = Rational(Integer(sample) - range.vmin) / Rational(Integer(range.vmax) - range.vmin);
  const Rational clamped = std::clamp(depth, Rational(0), Rational(1));
  return static_cast<std::int64_t>(floor_of(clamped * range.levels + Rational(1, 2)));
}

bool fires(std::uint32_t sample, std::int64_t level, const SliceRange& range) {
  const std::uint32_t limit = slice_threshold(level, range.levels, range.vmin, range.vmax);
  return slice_where(range.vmin, range.vmax) == Where::at_least ? sample >= limit : sample <= limit;
}

TEST(SliceThreshold, FiresWhereTheCountIsGreaterForEverySmallRange) {
  for (std::uint32_t vmin = 0; vmin <= 12; ++vmin) {
    for (std::uint32_t vmax = 0; vmax <= 12; ++vmax) {
      for (std::int64_t levels = 1; vmin != vmax && levels <= 27; ++levels) {
        const SliceRange range{levels, vmin, vmax};
        for (std::uint32_t sample = 0; sample <= 14; ++sample) {
          const std::int64_t count = count_by_definition(sample, range);
          ASSERT_EQ(slice_count(sample, range), count) << sample << " in " << vmin << ".." << vmax << " of " << levels;
          for (std::int64_t level = 0; level < levels; ++level) {
            ASSERT_EQ(fires(sample, level, range), count > level)
                << "sample " << sample << " in " << vmin << ".." << vmax << ", layer " << level << " of " << levels;
          }
        }
      }
    }
  }
}

TEST(SliceThreshold, FiresWhereTheCountIsGreaterAtTheEdgeOfRandomLayers) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  constexpr std::int64_t kLevels[] = {
      1, 2, 3, 100, 255, 256, 65534, 65535, 65536, std::int64_t{1} << 40, std::int64_t{1} << 62};
  constexpr std::uint32_t kEnds[] = {0, 1, 2, 255, 256, 65534, 65535, 0x7FFFFFFF, 0xFFFFFFFE, 0xFFFFFFFF};
  for (int trial = 0; trial < 20000; ++trial) {
    const std::int64_t levels = kLevels[dice.up_to(10)];
    const std::uint32_t vmin = dice.coin() ? kEnds[dice.up_to(9)] : dice.word();
    const std::uint32_t vmax = dice.coin() ? kEnds[dice.up_to(9)] : dice.word();
    if (vmin == vmax) {
      continue;
    }
    const SliceRange range{levels, vmin, vmax};
    const auto wide =
        static_cast<std::int64_t>((std::uint64_t{dice.word()} << 31 ^ dice.word()) & ((std::uint64_t{1} << 62) - 1));
    const std::int64_t level = dice.up_to(9) == 0 ? levels - 1 : dice.up_to(9) == 0 ? 0 : wide % levels;
    const std::uint32_t limit = slice_threshold(level, levels, vmin, vmax);
    const std::uint32_t before = vmin < vmax ? limit - 1 : limit + 1;  // one sample less deep; vmin at the least
    ASSERT_GT(count_by_definition(limit, range), level) << vmin << ".." << vmax << ", " << level << " of " << levels;
    ASSERT_LE(count_by_definition(before, range), level) << vmin << ".." << vmax << ", " << level << " of " << levels;
    ASSERT_EQ(slice_count(limit, range), count_by_definition(limit, range));
  }
}

TEST(SliceThreshold, GivesEverySampleItsCountOfPulses) {
  for (const std::int64_t levels : {1, 7, 100, 255, 300}) {
    for (const auto& [vmin, vmax] : {std::pair{0u, 255u}, std::pair{255u, 0u}, std::pair{20u, 199u}}) {
      const SliceRange range{levels, vmin, vmax};
      for (std::uint32_t sample = 0; sample < 256; ++sample) {
        std::int64_t pulses = 0;
        for (std::int64_t level = 0; level < levels; ++level) {
          pulses += fires(sample, level, range) ? 1 : 0;
        }
        ASSERT_EQ(pulses, count_by_definition(sample, range)) << sample << " of " << vmin << ".." << vmax;
      }
    }
  }
}

class Slice : public KernelTest {
 protected:
  /// Cuts random maps into some of their layers and asks fires() for every bit.
  template <class Sample, class Kernel>
  void compare(Kernel kernel, std::int64_t most) {
    Dice dice;
    SCOPED_TRACE(dice.trace());
    for (int trial = 0; trial < 4000; ++trial) {
      const std::int64_t width = trial % 500 == 0 ? 4000 + dice.up_to(5000) : dice.size(600);
      const std::int64_t rows = dice.up_to(3);
      const auto end = [&] {
        return static_cast<std::uint32_t>(dice.coin() ? most * dice.up_to(1) : dice.up_to(most));
      };
      SliceRange range{1 + dice.up_to(dice.coin() ? 300 : 5), end(), end()};
      range.vmax = range.vmin == range.vmax ? static_cast<std::uint32_t>(most) - range.vmax / 2 : range.vmax;
      if (range.vmin == range.vmax) {
        continue;
      }
      std::vector<Sample> src(static_cast<std::size_t>(width * rows));
      const std::int64_t spread = dice.coin() ? most : dice.up_to(most);
      for (Sample& sample : src) {
        sample = static_cast<Sample>(dice.up_to(spread));
      }
      const std::int64_t first = dice.up_to(range.levels - 1);
      const auto count = static_cast<std::size_t>(dice.up_to(std::min<std::int64_t>(6, range.levels - first)));
      std::vector<Bytes> planes(count);
      for (Bytes& plane : planes) {
        plane = dice.bytes(rows * packed_bytes(width));
      }
      const std::vector<std::span<std::byte>> layers(planes.begin(), planes.end());
      kernel(layers, first, src, width, rows, range);
      for (std::size_t k = 0; k < count; ++k) {
        expect_plane(planes[k], src, width, rows, first + static_cast<std::int64_t>(k), range);
        ASSERT_FALSE(HasFailure()) << "width " << width << ", rows " << rows;
      }
    }
  }

 private:
  template <class Sample>
  static void expect_plane(const Bytes& plane, const std::vector<Sample>& src, std::int64_t width, std::int64_t rows,
                           std::int64_t level, const SliceRange& range) {
    Bytes expected(plane.size());
    const std::uint32_t limit = slice_threshold(level, range.levels, range.vmin, range.vmax);
    const bool up = range.vmin < range.vmax;
    for (std::int64_t row = 0; row < rows; ++row) {
      for (std::int64_t x = 0; x < width; ++x) {
        const Sample sample = src[static_cast<std::size_t>(row * width + x)];
        set_bit(expected, 8 * row * packed_bytes(width) + x, up ? sample >= limit : sample <= limit);
      }
    }
    ASSERT_EQ(plane, expected) << "layer " << level << " of " << range.levels << ", " << range.vmin << ".."
                               << range.vmax;
  }
};
INSTANTIATE_TEST_SUITE_P(Raster, Slice, kEveryIsa, kIsaName);

TEST_P(Slice, OfWordsMakesEveryLayerOfItsThreshold) {
  compare<std::uint16_t>(kernels().slice_u16, 0xFFFF);
}

TEST_P(Slice, OfBytesMakesEveryLayerOfItsThreshold) {
  compare<std::uint8_t>(kernels().slice_u8, 0xFF);
}

TEST_P(Slice, OfWordsEqualsPortableOnWideMaps) {
  Dice dice;
  SCOPED_TRACE(dice.trace());
  for (int trial = 0; trial < 40; ++trial) {
    const std::int64_t width = dice.up_to(20000);
    const SliceRange range{100, 0, static_cast<std::uint32_t>(1 + dice.up_to(65534))};
    std::vector<std::uint16_t> src(static_cast<std::size_t>(2 * width));
    for (std::uint16_t& sample : src) {
      sample = static_cast<std::uint16_t>(dice.word());
    }
    std::vector<Bytes> planes(100, Bytes(static_cast<std::size_t>(2 * packed_bytes(width))));
    std::vector<Bytes> expected = planes;
    kernels().slice_u16(std::vector<std::span<std::byte>>(planes.begin(), planes.end()), 0, src, width, 2, range);
    portable().slice_u16(std::vector<std::span<std::byte>>(expected.begin(), expected.end()), 0, src, width, 2, range);
    ASSERT_EQ(planes, expected) << "width " << width;
  }
}

TEST(Slice, TakesTheBestKernelsOfThisProcessor) {
  const std::vector<std::uint16_t> words{0, 1, 2, 3};
  const std::vector<std::uint8_t> bytes{0, 1, 2, 3};
  std::vector<Bytes> planes(2, Bytes(1));
  const std::vector<std::span<std::byte>> layers(planes.begin(), planes.end());
  slice_rows_u16(layers, 0, words, 4, 1, {.levels = 3, .vmin = 0, .vmax = 3});
  EXPECT_EQ(planes, (std::vector<Bytes>{{std::byte{0b0111'0000}}, {std::byte{0b0011'0000}}}));
  slice_rows_u8(layers, 1, bytes, 4, 1, {.levels = 3, .vmin = 3, .vmax = 0});
  EXPECT_EQ(planes, (std::vector<Bytes>{{std::byte{0b1100'0000}}, {std::byte{0b1000'0000}}}));
}

}  // namespace
}  // namespace gravure::raster
