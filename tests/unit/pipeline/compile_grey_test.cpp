#include <cmath>
#include <limits>

#include "pipeline_support.hpp"

namespace gravure::test {
namespace {

constexpr LinesAlong kBoth[] = {LinesAlong::rows, LinesAlong::columns};

TEST(CompileThreshold, EqualsTheReferenceAtEveryKindOfLimit) {
  SCOPED_TRACE(Dice::note());
  std::uint64_t seed = Dice::seed();
  struct Row {
    SampleType type;
    std::int64_t threshold;
  };
  for (const Row& row :
       {Row{SampleType::u8, 0}, Row{SampleType::u8, 1}, Row{SampleType::u8, 128}, Row{SampleType::u8, 255},
        Row{SampleType::u16, 0}, Row{SampleType::u16, 32768}, Row{SampleType::u16, 65535}, Row{SampleType::f32, 0},
        Row{SampleType::f32, 1}, Row{SampleType::f32, -1}}) {
    for (const LinesAlong along : kBoth) {
      for (const Fires which : {Fires::white, Fires::black}) {
        SCOPED_TRACE(testing::Message() << "threshold " << row.threshold << ", type " << static_cast<int>(row.type));
        MemoryImages images;
        LayerStack stack = random_stack(images, row.type, along, 13, 71, 2, ++seed);
        stack.threshold = row.threshold;
        stack.fires = which;
        const ProgramHeader header = header_for(stack, true);
        expect_naive(compile_stack(header, stack, images, 5), header, stack, images);
      }
    }
  }
}

TEST(CompileThreshold, CutsFloatsExactlyWhereTheLimitIsNoFloat) {
  // 2^24 + 1 has no float: 2^24 lies below it, 2^24 + 2 above.
  MemoryImages images;
  LayerStack stack = random_stack(images, SampleType::f32, LinesAlong::rows, 1, 3, 1, 1);
  images.at("layer0").samples = [](std::int64_t, std::int64_t column) {
    return column == 0 ? 16777215.0 : column == 1 ? 16777216.0 : 16777218.0;
  };
  stack.threshold = 16'777'217;
  const ProgramHeader header = header_for(stack, false);
  const Compiled compiled = compile_stack(header, stack, images, 1);
  expect_naive(compiled, header, stack, images);
  EXPECT_EQ(compiled.program.line(0, 0), std::vector<std::byte>{std::byte{0x20}});
}

void expect_refused(LayerStack stack, const MemoryImages& images, ErrorCode code, const std::string& part) {
  const Compiled compiled = compile_stack(header_for(stack, true), stack, images, 4);
  ASSERT_FALSE(compiled.result);
  EXPECT_EQ(compiled.result.error().code, code);
  EXPECT_NE(compiled.result.error().message.find(part), std::string::npos) << compiled.result.error().message;
  EXPECT_EQ(compiled.program.finished, 0);
}

TEST(CompileThreshold, RefusesLimitsThatNoSampleHas) {
  MemoryImages images;
  LayerStack stack = random_stack(images, SampleType::u8, LinesAlong::rows, 4, 4, 1, 1);
  for (const std::int64_t threshold : {-1, 256, 1 << 20}) {
    stack.threshold = threshold;
    expect_refused(stack, images, ErrorCode::out_of_range,
                   "image.threshold = " + std::to_string(threshold) + ": samples go from 0 to 255");
  }
}

TEST(CompileDepth, EqualsTheExactCountsForEveryTypeDirectionAndRange) {
  SCOPED_TRACE(Dice::note());
  std::uint64_t seed = Dice::seed();
  struct Row {
    SampleType type;
    std::int64_t levels;
    std::optional<Rational> least, most;
  };
  const Row rows[] = {
      {SampleType::u8, 1, {}, {}},
      {SampleType::u8, 7, {}, {}},
      {SampleType::u8, 255, {}, {}},
      {SampleType::u8, 10, Rational(20), Rational(200)},
      {SampleType::u8, 6, Rational(200), Rational(20)},
      {SampleType::u16, 3, {}, {}},
      {SampleType::u16, 100, Rational(1), Rational(65534)},
      {SampleType::f32, 3, {}, {}},
      {SampleType::f32, 49, {}, {}},
      {SampleType::f32, 10, ratio(-1, 3), ratio(4, 3)},
      {SampleType::f32, 6, ratio(9, 10), ratio(1, 10)},
  };
  for (const Row& row : rows) {
    for (const LinesAlong along : kBoth) {
      for (const Fires which : {Fires::white, Fires::black}) {
        SCOPED_TRACE(testing::Message() << row.levels << " levels, type " << static_cast<int>(row.type) << ", "
                                        << (which == Fires::white ? "white" : "black"));
        MemoryImages images;
        LayerStack stack = depth_stack(images, row.type, along, 5, 19, row.levels, ++seed);
        stack.fires = which;
        stack.depth_min = row.least;
        stack.depth_max = row.most;
        const ProgramHeader header = header_for(stack, true);
        expect_naive(compile_stack(header, stack, images, 2), header, stack, images);
      }
    }
  }
}

TEST(CompileDepth, PutsEveryFloatNextToABorderOnItsSide) {
  // The borders (2 r + 1) / (2 levels) are mostly no floats: the ones on either side must fall on either side.
  constexpr std::int64_t kLevels = 60;
  for (const Fires which : {Fires::white, Fires::black}) {
    MemoryImages images;
    LayerStack stack = depth_stack(images, SampleType::f32, LinesAlong::rows, 3, kLevels, kLevels, 1);
    images.at("layer0").samples = [](std::int64_t row, std::int64_t column) {
      const auto near = static_cast<float>(static_cast<double>(2 * column + 1) / (2.0 * kLevels));
      return static_cast<double>(row == 0 ? std::nextafter(near, -1.0F) : row == 1 ? near : std::nextafter(near, 2.0F));
    };
    stack.fires = which;
    const ProgramHeader header = header_for(stack, false);
    expect_naive(compile_stack(header, stack, images, 3), header, stack, images);
  }
}

TEST(CompileDepth, TakesEndsBeyondAnyFloat) {
  for (const Fires which : {Fires::white, Fires::black}) {
    MemoryImages images;
    LayerStack stack = depth_stack(images, SampleType::f32, LinesAlong::rows, 1, 4, 2, 1);
    images.at("layer0").samples = [](std::int64_t, std::int64_t column) {
      constexpr double kMost = std::numeric_limits<float>::max();
      return column == 0 ? -kMost : column == 1 ? 0.0 : column == 2 ? 1.0 : kMost;
    };
    stack.fires = which;
    const Rational far(boost::multiprecision::pow(Integer(10), 50U));
    for (const bool swapped : {false, true}) {
      stack.depth_min = swapped ? far : Rational(-far);
      stack.depth_max = swapped ? Rational(-far) : far;
      const ProgramHeader header = header_for(stack, false);
      expect_naive(compile_stack(header, stack, images, 1), header, stack, images);
    }
  }
}

TEST(CompileDepth, ReadsTheMapOnce) {
  for (const int threads : {1, 2, 5}) {
    MemoryImages images;
    const LayerStack stack = depth_stack(images, SampleType::u16, LinesAlong::rows, 40, 30, 25, 1);
    const ProgramHeader header = header_for(stack, true);
    expect_naive(compile_stack(header, stack, images, 4, {.threads = threads}), header, stack, images);
    EXPECT_EQ(images.rows_read(), 40) << "all levels are cut from one reading";
  }
}

TEST(CompileDepth, DoesNotDependOnThreadsOrMemory) {
  for (const LinesAlong along : kBoth) {
    MemoryImages images;
    const LayerStack stack = depth_stack(images, SampleType::f32, along, 40, 70, 9, 1);
    const ProgramHeader header = header_for(stack, true);
    const Compiled reference = compile_stack(header, stack, images, 4, {.threads = 1});
    const std::int64_t least = least_compile_memory(stack, 4);
    for (const int threads : {1, 2, 5}) {
      for (const std::int64_t memory : {least, 3 * least}) {
        const Compiled other = compile_stack(header, stack, images, 4, {.memory_bytes = memory, .threads = threads});
        ASSERT_TRUE(other.result);
        EXPECT_EQ(other.program.order, reference.program.order);
        for (const auto& [address, chunk] : reference.program.chunks) {
          ASSERT_EQ(other.program.chunks.at(address).bytes, chunk.bytes);
        }
      }
    }
  }
}

TEST(CompileDepth, RefusesEndsThatAreEqualOrNoSamples) {
  MemoryImages images;
  LayerStack stack = depth_stack(images, SampleType::u8, LinesAlong::rows, 4, 4, 3, 1);
  stack.depth_min = 255;
  expect_refused(stack, images, ErrorCode::bad_argument, "image.depth_min = image.depth_max = 255");
  stack.depth_min = ratio(1, 2);
  expect_refused(stack, images, ErrorCode::out_of_range, "0.5 must be an integer from 0 to 255");
  stack.depth_min = -1;
  expect_refused(stack, images, ErrorCode::out_of_range, "-1 must be an integer from 0 to 255");
  stack.depth_min = 0;
  stack.depth_max = 256;
  expect_refused(stack, images, ErrorCode::out_of_range, "256 must be an integer from 0 to 255");
}

}  // namespace
}  // namespace gravure::test
