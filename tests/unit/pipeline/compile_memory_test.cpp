#include "counted_memory.hpp"
#include "gravure/core/units.hpp"
#include "pipeline_support.hpp"

namespace gravure::test {
namespace {

struct Case {
  SampleType type;
  LinesAlong along;
  std::int64_t lines, pixels, levels;
};

std::int64_t peak_of(const Case& what, std::int64_t memory, int threads) {
  MemoryImages images;
  LayerStack stack = what.levels > 0
                         ? depth_stack(images, what.type, what.along, what.lines, what.pixels, what.levels, 1)
                         : random_stack(images, what.type, what.along, what.lines, what.pixels, 2, 1);
  for (const LayerInput& layer : stack.layers) {
    images.at(layer.path).packed_row = [](std::int64_t row, std::span<std::byte> out) {
      std::memset(out.data(), static_cast<int>(row & 0xFF), out.size());
    };
  }
  stack.threshold = 1;
  const ProgramHeader header = header_for(stack, true);
  MemoryProgram program;
  program.lines_per_chunk = std::max<std::int64_t>(1, (1 << 20) / header.line_bytes());
  program.order.reserve(100'000);
  MemorySink sink(program);
  sink.keep = false;
  const std::int64_t before = held_bytes;
  peak_bytes = before;
  const Result<ProgramHeader> result =
      compile(header, stack, images, sink, {.memory_bytes = memory, .threads = threads});
  EXPECT_TRUE(result) << result.error().message;
  EXPECT_EQ(sink.bytes_put, static_cast<std::int64_t>(stack.layers.size()) * stack.lines * header.line_bytes());
  return peak_bytes - before;
}

TEST(CompileMemory, StaysWithinTheBudgetWhateverTheSizeOfTheImages) {
  struct Row {
    Case what;
    std::int64_t memory;
    int threads;
  };
  // Each picture takes more than its budget.
  for (const Row& row : {Row{{SampleType::bit, LinesAlong::columns, 16'000, 12'000, 0}, 16 * kMiB, 1},
                         Row{{SampleType::u8, LinesAlong::columns, 6'000, 6'000, 0}, 26 * kMiB, 2},
                         Row{{SampleType::u8, LinesAlong::rows, 3'000, 12'000, 0}, 34 * kMiB, 2},
                         Row{{SampleType::u8, LinesAlong::rows, 2'000, 16'000, 9}, 28 * kMiB, 1}}) {
    const std::int64_t peak = peak_of(row.what, row.memory, row.threads);
    EXPECT_LE(peak, row.memory) << row.what.lines << " lines of " << row.what.pixels << ", " << row.threads
                                << " threads";
    EXPECT_GT(peak, row.memory / 20) << "the meter does not run";
  }
}

}  // namespace
}  // namespace gravure::test
