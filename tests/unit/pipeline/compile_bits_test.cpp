#include <algorithm>

#include "gravure/core/units.hpp"
#include "pipeline_support.hpp"

namespace gravure::test {
namespace {

/// Widths around whole bytes and words, and the published line; odd and even lines per revolution.
struct Shape {
  std::int64_t pixels, lines;
};
constexpr Shape kShapes[] = {{1, 5}, {7, 4}, {8, 5}, {9, 6}, {63, 9}, {64, 8}, {65, 7}, {3500, 11}};

class CompileBits : public testing::TestWithParam<LinesAlong> {};

TEST_P(CompileBits, EqualsTheReferenceForEveryShapeDirectionAndPolarity) {
  std::uint64_t seed = Dice::seed();
  SCOPED_TRACE(Dice::note());
  for (const Shape& shape : kShapes) {
    for (int variant = 0; variant < 16; ++variant) {
      SCOPED_TRACE(testing::Message() << shape.pixels << " x " << shape.lines << ", variant " << variant);
      MemoryImages images;
      LayerStack stack = random_stack(images, SampleType::bit, GetParam(), shape.lines, shape.pixels, 3, ++seed);
      stack.fires = (variant & 1) != 0 ? Fires::black : Fires::white;
      for (const LayerInput& layer : stack.layers) {
        images.at(layer.path).info.zero_is_white = (variant & 2) != 0;
      }
      const ProgramHeader header = header_for(stack, (variant & 4) != 0, (variant & 8) != 0);
      expect_naive(compile_stack(header, stack, images, 1 + variant % 4), header, stack, images);
    }
  }
}

TEST_P(CompileBits, KeepsOnePolarityForEachImage) {
  MemoryImages images;
  const LayerStack stack = random_stack(images, SampleType::bit, GetParam(), 9, 17, 2, 5);
  images.at("layer1").info.zero_is_white = true;
  const ProgramHeader header = header_for(stack, true);
  expect_naive(compile_stack(header, stack, images, 4), header, stack, images);
}

TEST_P(CompileBits, GivesTheSameBytesForAnyThreadsAndMemory) {
  MemoryImages images;
  const LayerStack stack = random_stack(images, SampleType::bit, GetParam(), 301, 2001, 4, 7);
  const ProgramHeader header = header_for(stack, true);
  const Compiled reference = compile_stack(header, stack, images, 16, {.threads = 1});
  ASSERT_TRUE(reference.result);
  const std::int64_t least = least_compile_memory(stack, 16);
  for (const int threads : {1, 2, 5}) {
    for (const std::int64_t memory : {least, least + 4096, 2 * least, 5 * least + 1, 256 * kMiB}) {
      SCOPED_TRACE(testing::Message() << threads << " threads, " << memory << " bytes");
      const Compiled other = compile_stack(header, stack, images, 16, {.memory_bytes = memory, .threads = threads});
      ASSERT_TRUE(other.result);
      EXPECT_EQ(other.program.order, reference.program.order) << "the file's order must not depend on the workers";
      for (const auto& [address, chunk] : reference.program.chunks) {
        ASSERT_EQ(other.program.chunks.at(address).bytes, chunk.bytes);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Along, CompileBits, testing::Values(LinesAlong::rows, LinesAlong::columns),
                         [](const auto& along) { return along.param == LinesAlong::rows ? "Rows" : "Columns"; });

TEST(Compile, WritesLayerByLayerAndADepthMapChunkByChunk) {
  MemoryImages images;
  const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 5, 8, 2, 1);
  using Order = std::vector<std::pair<std::int64_t, std::int64_t>>;
  EXPECT_EQ(compile_stack(header_for(stack, true), stack, images, 2).program.order,
            (Order{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}}));
  const LayerStack depth = depth_stack(images, SampleType::u8, LinesAlong::rows, 5, 8, 2, 1);
  EXPECT_EQ(compile_stack(header_for(depth, true), depth, images, 2).program.order,
            (Order{{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0, 2}, {1, 2}}));
}

TEST(Compile, ReadsAFileThatOnlyRunsUpwardsOnce) {
  for (const int threads : {1, 5}) {
    for (const std::int64_t lines_per_chunk : {1, 3, 4, 100}) {
      MemoryImages images;
      LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 50, 20, 3, 3);
      stack.random_access = false;
      stack.decoder_bytes = 0;  // else each is opened once more to ask
      for (const LayerInput& layer : stack.layers) {
        images.at(layer.path).info.random_access = false;
      }
      const ProgramHeader header = header_for(stack, true);
      expect_naive(compile_stack(header, stack, images, lines_per_chunk, {.threads = threads}), header, stack, images);
      EXPECT_EQ(images.opened(), 3) << threads << " threads, " << lines_per_chunk << " lines a chunk";
      EXPECT_EQ(images.rows_read(), 3 * 50);
    }
  }
}

TEST(Compile, DecodesFewStripsTwiceWithManyWorkers) {
  constexpr std::int64_t kLayers = 10;
  constexpr std::int64_t kLines = 4600;
  for (const int threads : {1, 2, 3}) {
    for (const std::int64_t rows : {std::int64_t{64}, std::int64_t{1000}, kLines}) {
      SCOPED_TRACE(testing::Message() << threads << " threads, strips of " << rows << " rows");
      MemoryImages images;
      const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, kLines, 20, kLayers, 3);
      for (const LayerInput& layer : stack.layers) {
        images.at(layer.path).info.rows_per_block = rows;
      }
      const ProgramHeader header = header_for(stack, true);
      ASSERT_TRUE(compile_stack(header, stack, images, 100, {.threads = threads}).result);
      const std::int64_t strips = kLayers * ((kLines + rows - 1) / rows);
      EXPECT_GE(images.blocks_decoded(), strips);
      EXPECT_LE(images.blocks_decoded(), threads == 1 || rows == kLines ? strips : strips + strips / 8 + kLayers);
    }
  }
}

TEST(Compile, StartsAFileThatOnlyRunsUpwardsAgainForTheNextPanel) {
  MemoryImages images;
  LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::columns, 500, 3000, 2, 3);
  stack.random_access = false;
  for (const LayerInput& layer : stack.layers) {
    images.at(layer.path).info.random_access = false;
  }
  const ProgramHeader header = header_for(stack, true);
  const std::int64_t least = least_compile_memory(stack, 8);
  expect_naive(compile_stack(header, stack, images, 8, {.memory_bytes = least, .threads = 1}), header, stack, images);
  EXPECT_GT(images.rows_read(), 2 * 3000) << "this budget is to need several panels";
}

TEST(Compile, ReadsTheSameFileTwiceWhenTwoLayersShowIt) {
  MemoryImages images;
  LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 12, 20, 1, 3);
  stack.random_access = false;
  images.at("layer0").info.random_access = false;
  stack.layers.push_back(stack.layers[0]);
  const ProgramHeader header = header_for(stack, true);
  expect_naive(compile_stack(header, stack, images, 5, {.threads = 1}), header, stack, images);
}

/// 4,000 lines of 640 pixels in chunks of 24, along columns; one worker has room for panels of a third of the picture,
/// never a multiple of a chunk.
struct ThreePanels {
  static constexpr std::int64_t kPanels = 3;
  ThreePanels() : stack(random_stack(images, SampleType::bit, LinesAlong::columns, 4000, 640, 1, 3)) {}
  std::int64_t memory() const { return least_compile_memory(stack, 24) + 300'000; }
  Compiled compiled() const {
    return compile_stack(header_for(stack, true), stack, images, 24, {.memory_bytes = memory(), .threads = 1});
  }
  MemoryImages images;
  LayerStack stack;
};

TEST(Compile, DecodesAPictureOnceWhereColumnsTakeAFewPanels) {
  ThreePanels three;
  expect_naive(three.compiled(), header_for(three.stack, true), three.stack, three.images);
  EXPECT_EQ(three.images.rows_read(), 640) << "a temporary file holds what was decoded";
}

TEST(Compile, DecodesAPictureOnceForEachPanelOfColumnsWhereNoTemporaryFileCanBeHad) {
  const NoTemporaryFolder nowhere;
  ThreePanels three;
  expect_naive(three.compiled(), header_for(three.stack, true), three.stack, three.images);
  EXPECT_EQ(three.images.rows_read(), ThreePanels::kPanels * 640);
}

TEST(Compile, DecodesAPictureOnceInAllWhereColumnsTakeManyPanels) {
  SCOPED_TRACE(Dice::note());
  for (const std::int64_t pixels : {640, 641, 711}) {
    for (const int threads : {1, 3}) {
      MemoryImages images;
      LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::columns, 4000, pixels, 2, Dice::seed());
      stack.random_access = false;
      stack.decoder_bytes = 0;
      for (const LayerInput& layer : stack.layers) {
        images.at(layer.path).info.random_access = false;
      }
      const ProgramHeader header = header_for(stack, true);
      const std::int64_t least = least_compile_memory(stack, 24);  // 2 MiB of it is taken once, not by each worker
      const std::int64_t memory = least + (threads - 1) * (least - 2 * kMiB) + threads * 100'000;
      expect_naive(compile_stack(header, stack, images, 24, {.memory_bytes = memory, .threads = threads}), header,
                   stack, images);
      EXPECT_LE(images.rows_read(), 2 * threads * pixels) << "a temporary file holds what was decoded";
    }
  }
}

TEST(Compile, DecodesAgainWhereNoTemporaryFileCanBeHad) {
  MemoryImages images;
  const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::columns, 4000, 640, 1, 3);
  const ProgramHeader header = header_for(stack, true);
  const std::int64_t memory = least_compile_memory(stack, 24) + 100'000;
  const NoTemporaryFolder nowhere;
  expect_naive(compile_stack(header, stack, images, 24, {.memory_bytes = memory, .threads = 2}), header, stack, images);
  EXPECT_GE(images.rows_read(), 4 * 640);
}

class CountedProgress final : public Progress {
 public:
  void update(std::int64_t done, std::int64_t total) override {
    falls = falls || done <= last;
    last = done;
    expected = total;
  }
  bool falls = false;
  std::int64_t last = 0;
  std::int64_t expected = 0;
};

TEST(Compile, TellsItsProgressInLinesUpToAll) {
  MemoryImages images;
  const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 53, 20, 3, 3);
  CountedProgress progress;
  ASSERT_TRUE(compile_stack(header_for(stack, true), stack, images, 4, {.threads = 5, .progress = &progress}).result);
  EXPECT_FALSE(progress.falls);
  EXPECT_EQ(progress.last, 3 * 53);
  EXPECT_EQ(progress.expected, 3 * 53);
}

}  // namespace
}  // namespace gravure::test
