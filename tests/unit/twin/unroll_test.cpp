#include "gravure/twin/unroll.hpp"

#include "gravure/core/units.hpp"
#include "twin_support.hpp"

namespace gravure::test {
namespace {

struct Unrolled {
  Result<void> result;
  std::vector<std::byte> bytes;
  int calls = 0;
};

Unrolled unroll_to_memory(const SmallJob& small, std::int64_t revolution, const UnrollOptions& options = {},
                          const DeviceFactory& devices = emulated()) {
  Unrolled unrolled;
  MemorySource source(small.program);
  const std::int64_t row = row_bytes(SampleType::bit, unrolled_size(small.program.header).width);
  unrolled.result = unroll(
      source, devices, revolution,
      [&](std::span<const std::byte> rows, std::int64_t count) -> Result<void> {
        EXPECT_EQ(rows.size(), static_cast<std::size_t>(count * row));
        unrolled.bytes.insert(unrolled.bytes.end(), rows.begin(), rows.end());
        ++unrolled.calls;
        return {};
      },
      options);
  return unrolled;
}

/// The picture of a layer: 1 is white.
std::vector<std::byte> picture(SmallJob& small, std::int64_t layer) {
  const UnrolledSize size = unrolled_size(small.program.header);
  const std::int64_t row_size = row_bytes(SampleType::bit, size.width);
  const bool rows = small.stack.lines_along == LinesAlong::rows;
  std::vector<std::byte> bytes(static_cast<std::size_t>(size.height * row_size));
  for (std::int64_t row = 0; row < size.height; ++row) {
    for (std::int64_t column = 0; column < size.width; ++column) {
      const bool fired = image_pixel(small.stack, small.images, layer, rows ? row : column, rows ? column : row);
      if (fired == (small.stack.fires == Fires::white)) {
        set_bit(bytes, row * row_size * 8 + column);
      }
    }
  }
  return bytes;
}

/// What unrolling takes beside the band that is turned, and for one byte of every line.
std::int64_t fixed_bytes(const SmallJob& small) {
  return (6 << 20) + 6 * small.program.lines_per_chunk * small.program.header.line_bytes();
}
std::int64_t band_bytes(std::int64_t lines) {
  return 2 * (lines + 7);
}

TEST(Unroll, GivesThePictureOfEveryRevolutionInAnyMemory) {
  for (const LinesAlong along : {LinesAlong::rows, LinesAlong::columns}) {
    for (const std::int64_t lines : {12, 13}) {
      for (const Fires which : {Fires::white, Fires::black}) {
        SmallJob small;
        prepare(small, along, lines, 45, 3);
        small.job.image.fires = small.stack.fires = which;
        small.images.at("layer1").info.zero_is_white = true;
        compile_job(small, 7, LayerOrder::cycle);
        for (std::int64_t revolution = 0; revolution < 7; ++revolution) {
          const std::int64_t least = fixed_bytes(small) + band_bytes(lines);
          for (const std::int64_t memory : {least, least + 60, std::int64_t{1} << 28}) {
            SCOPED_TRACE(testing::Message()
                         << lines << " lines, revolution " << revolution << ", " << memory << " bytes");
            const Unrolled unrolled = unroll_to_memory(small, revolution, {.memory_bytes = memory});
            ASSERT_TRUE(unrolled.result) << unrolled.result.error().message;
            ASSERT_EQ(unrolled.bytes, picture(small, revolution % 3));
          }
        }
      }
    }
  }
}

TEST(Unroll, TurnsColumnsInBandsThatFitTheMemory) {
  SmallJob small;
  prepare(small, LinesAlong::columns, 13, 45, 1);
  compile_job(small, 1, LayerOrder::sequence);
  const std::int64_t fixed = fixed_bytes(small);
  EXPECT_EQ(unroll_to_memory(small, 0, {.memory_bytes = fixed + band_bytes(13)}).calls, 6) << "a byte of every line";
  EXPECT_EQ(unroll_to_memory(small, 0, {.memory_bytes = fixed + 2 * band_bytes(13)}).calls, 3);
  const Unrolled refused = unroll_to_memory(small, 0, {.memory_bytes = fixed + band_bytes(13) - 1});
  ASSERT_FALSE(refused.result);
  EXPECT_EQ(refused.result.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.result.error().message.find("needs at least 7 MiB"), std::string::npos);
  EXPECT_EQ(unroll_to_memory(small, 0).calls, 1);
}

TEST(Unroll, GivesTheSlicesOfADepthMap) {
  for (const Fires which : {Fires::white, Fires::black}) {
    SmallJob small;
    small.job = small_job(11);
    small.stack = depth_stack(small.images, SampleType::u8, LinesAlong::columns, 11, 30, 4, 5);
    small.job.image.fires = small.stack.fires = which;
    compile_job(small, 4, LayerOrder::sequence);
    for (std::int64_t revolution = 0; revolution < 4; ++revolution) {
      EXPECT_EQ(unroll_to_memory(small, revolution).bytes, picture(small, revolution));
    }
  }
}

TEST(Unroll, RefusesRevolutionsTheProgramDoesNotHave) {
  SmallJob small;
  sound_job(small);
  for (const std::int64_t revolution : {-1, 8}) {
    const Unrolled unrolled = unroll_to_memory(small, revolution);
    ASSERT_FALSE(unrolled.result);
    EXPECT_EQ(unrolled.result.error().code, ErrorCode::out_of_range);
    EXPECT_NE(unrolled.result.error().message.find("the program has 0 to 7"), std::string::npos);
  }
}

TEST(Unroll, StopsOnRequestAndHandsOnWhatTheSinkSays) {
  SmallJob small;
  sound_job(small);
  CancelToken cancel;
  cancel.cancel();
  EXPECT_EQ(unroll_to_memory(small, 0, {.cancel = &cancel}).result.error().code, ErrorCode::cancelled);
  MemorySource source(small.program);
  const Result<void> failed = unroll(source, emulated(), 0,
                                     [](std::span<const std::byte>, std::int64_t) -> Result<void> {
                                       return Error{ErrorCode::io, "no space"};
                                     },
                                     {});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "no space");
}

/// Shows nothing of what it does.
class SilentDevice final : public LineDevice {
 public:
  Result<void> configure(const DeviceSetup& setup) override { return device_.configure(setup); }
  Result<void> send(const LineFrame& frame) override { return device_.send(frame); }
  DeviceStatus status() const override { return device_.status(); }

 private:
  emulator::EmulatedDevice device_;
};

TEST(Unroll, RefusesADeviceThatShowsNoLines) {
  SmallJob small;
  sound_job(small);
  const Unrolled unrolled = unroll_to_memory(
      small, 2, {}, [](PinObserver&) -> std::unique_ptr<LineDevice> { return std::make_unique<SilentDevice>(); });
  ASSERT_FALSE(unrolled.result);
  EXPECT_EQ(unrolled.result.error().code, ErrorCode::device);
  EXPECT_TRUE(unrolled.bytes.empty());
}

TEST(Unroll, CountsWhatTheReadersOfTheProgramShare) {
  SmallJob small;
  prepare(small, LinesAlong::columns, 13, 45, 1);
  compile_job(small, 1, LayerOrder::sequence);
  EXPECT_TRUE(unroll_to_memory(small, 0, {.memory_bytes = 8 * kMiB}).result);
  EXPECT_TRUE(unroll_to_memory(small, 0, {.memory_bytes = 12 * kMiB, .table_bytes = 4 * kMiB}).result);
  const Result<void> refused = unroll_to_memory(small, 0, {.memory_bytes = 8 * kMiB, .table_bytes = 4 * kMiB}).result;
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("needs at least 11 MiB"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace gravure::test
