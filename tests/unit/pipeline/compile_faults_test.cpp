#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>

#include "gravure/core/units.hpp"
#include "pipeline_support.hpp"

namespace gravure::test {
namespace {

constexpr int kThreadCounts[] = {1, 2, 5};

struct Faults {
  std::optional<std::int64_t> put = std::nullopt;
  std::optional<std::int64_t> encode = std::nullopt;
  CancelToken* cancel = nullptr;
  Progress* progress = nullptr;
};

/// Compiles with the fault; the error must come back, and nothing be finished.
Error failing(const LayerStack& stack, const MemoryImages& images, int threads, const Faults& faults) {
  MemoryProgram program;
  program.lines_per_chunk = 3;
  MemorySink sink(program);
  sink.fail_at_put = faults.put;
  sink.fail_at_encode = faults.encode;
  const Result<ProgramHeader> result =
      compile(header_for(stack, true), stack, images, sink,
              {.threads = threads, .cancel = faults.cancel, .progress = faults.progress});
  EXPECT_FALSE(result);
  EXPECT_EQ(program.finished, 0) << "nothing may be finished after a fault";
  return result ? Error{ErrorCode::bad_argument, "it succeeded"} : result.error();
}

TEST(CompileFault, OfTheReaderTravels) {
  for (const int threads : kThreadCounts) {
    for (const LinesAlong along : {LinesAlong::rows, LinesAlong::columns}) {
      MemoryImages images;
      const LayerStack stack = random_stack(images, SampleType::bit, along, 60, 40, 4, 1);
      images.at("layer2").damaged_row = 31;
      const Error error = failing(stack, images, threads, {});
      EXPECT_EQ(error.code, ErrorCode::bad_file);
      EXPECT_EQ(error.message, "layer2: row 31 is damaged");
    }
  }
}

TEST(CompileFault, OfTheSinkTravels) {
  for (const int threads : kThreadCounts) {
    MemoryImages images;
    const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 60, 40, 4, 1);
    for (const std::int64_t at : {0, 37, 79}) {  // the first, the middle, the last chunk
      const Error put = failing(stack, images, threads, {.put = at});
      EXPECT_EQ(put.code, ErrorCode::io);
      EXPECT_EQ(put.message, "the disk is full here");
      EXPECT_EQ(failing(stack, images, threads, {.encode = at}).message, "the packer fails here");
    }
  }
}

/// A small stack compiled into `program`, its header completed by `complete`.
Result<ProgramHeader> compile_and(MemoryProgram& program,
                                  const std::function<Result<void>(ProgramHeader& header)>& complete) {
  MemoryImages images;
  const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 60, 40, 4, 1);
  program.lines_per_chunk = 3;
  MemorySink sink(program);
  CompileOptions options;
  options.complete_header = complete;
  return compile(header_for(stack, true), stack, images, sink, options);
}

TEST(CompileFault, OfCompletingTheHeaderTravels) {
  MemoryProgram program;
  const Result<ProgramHeader> failed = compile_and(program, [](ProgramHeader& /*header*/) -> Result<void> {
    return Error{ErrorCode::io, "the hash is not to be had"};
  });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().message, "the hash is not to be had");
  EXPECT_EQ(program.finished, 0);
}

TEST(Compile, CompletesTheHeaderWhenEveryChunkIsPut) {
  MemoryProgram program;
  const Result<ProgramHeader> made = compile_and(program, [&](ProgramHeader& header) -> Result<void> {
    EXPECT_EQ(program.finished, 0);
    EXPECT_GT(header.layers.back().fired_pixels, 0) << "chunks are counted by then";
    header.job_text = "found late";
    return {};
  });
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made.value().job_text, "found late");
  EXPECT_EQ(program.header.job_text, "found late");
}

TEST(CompileFault, OfAnImageThatIsGoneOrChangedNamesIt) {
  for (const int threads : kThreadCounts) {
    MemoryImages images;
    LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 60, 40, 3, 1);
    images.at("layer1").info.height = 59;
    EXPECT_EQ(failing(stack, images, threads, {}).code, ErrorCode::bad_file);
    EXPECT_NE(failing(stack, images, threads, {}).message.find("layer1: page 0: is "), std::string::npos);
    stack.layers[1].path = "gone";
    EXPECT_NE(failing(stack, images, threads, {}).message.find("gone"), std::string::npos);
  }
}

TEST(CompileFault, CancelledBeforeItStartsNothingIsWritten) {
  for (const int threads : kThreadCounts) {
    MemoryImages images;
    const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 60, 40, 4, 1);
    CancelToken cancel;
    cancel.cancel();
    EXPECT_EQ(failing(stack, images, threads, {.cancel = &cancel}).code, ErrorCode::cancelled);
    EXPECT_EQ(images.rows_read(), 0);
  }
}

/// Pulls the brake after some lines.
class CancelAt final : public Progress {
 public:
  CancelAt(CancelToken& token, std::int64_t lines) : token_(token), lines_(lines) {}
  void update(std::int64_t done, std::int64_t) override {
    if (done >= lines_) {
      token_.cancel();
    }
  }

 private:
  CancelToken& token_;
  std::int64_t lines_;
};

TEST(CompileFault, CancelledInTheMiddleItStopsSoon) {
  for (const int threads : kThreadCounts) {
    MemoryImages images;
    const LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 600, 40, 4, 1);
    CancelToken cancel;
    CancelAt brake(cancel, 100);
    EXPECT_EQ(failing(stack, images, threads, {.cancel = &cancel, .progress = &brake}).code, ErrorCode::cancelled);
    EXPECT_LT(images.rows_read(), 100 + 3 * (2 * threads + 1)) << "at most the chunk in hand is still read";
  }
}

/// One picture of 16,384 columns and 8,192 rows, 16 bands of 1 MiB, whose columns are the lines.
struct Tall {
  static constexpr std::int64_t kColumns = 16'384;
  static constexpr std::int64_t kRows = 8'192;
  static constexpr std::int64_t kBandRows = 512;
  static constexpr std::int64_t kLinesPerChunk = 64;
  Tall() : stack(random_stack(images, SampleType::bit, LinesAlong::columns, kColumns, kRows, 1, 1)) {
    stack.decoder_bytes = 0;
  }
  /// What every worker needs, and a share of the whole picture, which is held twice, for each.
  std::int64_t memory(int threads, std::int64_t share) const {
    return threads * (least_compile_memory(stack, kLinesPerChunk) + 2 * kColumns * kRows / 8 * 4 / 3 / share);
  }

  MemoryImages images;
  LayerStack stack;
};

TEST(CompileFault, CancelledWhileColumnsAreCollectedItStopsWithinABand) {
  struct Way {
    const char* name;
    std::int64_t share;
    bool folder;
  };
  for (const Way& way : {Way{"one panel", 1, true}, Way{"a temporary file", 8, true}, Way{"no such file", 8, false}}) {
    for (const int threads : kThreadCounts) {
      SCOPED_TRACE(testing::Message() << way.name << ", " << threads << " threads");
      std::optional<NoTemporaryFolder> nowhere;
      if (!way.folder) {
        nowhere.emplace();
      }
      Tall tall;
      CancelToken cancel;
      tall.images.at("layer0").packed_row = [&](std::int64_t /*row*/, std::span<std::byte> out) {
        cancel.cancel();
        std::fill(out.begin(), out.end(), std::byte{0x5A});
      };
      const Compiled compiled =
          compile_stack(header_for(tall.stack, true), tall.stack, tall.images, Tall::kLinesPerChunk,
                        {.memory_bytes = tall.memory(threads, way.share), .threads = threads, .cancel = &cancel});
      ASSERT_FALSE(compiled.result);
      EXPECT_EQ(compiled.result.error().code, ErrorCode::cancelled);
      EXPECT_NE(compiled.result.error().message.find("nothing was written"), std::string::npos);
      EXPECT_LE(tall.images.rows_read(), threads * Tall::kBandRows) << "at most the band in hand of every worker";
    }
  }
}

TEST(CompileFault, WhileColumnsAreCollectedStopsTheOtherWorkersWithinABand) {
  Tall tall;
  ImageInfo second = tall.images.at("layer0").info;
  second.path = "layer1";
  tall.stack.layers.push_back({second.path, 0, 0});
  tall.images.at("layer0").damaged_row = 0;
  // The other picture takes 1.6 s, long enough for the failure to be told.
  tall.images.add({second, {}, {}, [](std::int64_t row, std::span<std::byte> out) {
                     if (row % Tall::kBandRows == 0) {
                       std::this_thread::sleep_for(std::chrono::milliseconds(100));
                     }
                     std::fill(out.begin(), out.end(), std::byte{0x5A});
                   }});
  const Compiled compiled = compile_stack(header_for(tall.stack, true), tall.stack, tall.images, Tall::kLinesPerChunk,
                                          {.memory_bytes = tall.memory(2, 1), .threads = 2});
  ASSERT_FALSE(compiled.result);
  EXPECT_EQ(compiled.result.error().message, "layer0: row 0 is damaged");
  EXPECT_LT(tall.images.rows_read(), Tall::kRows) << "the other picture is not read to its end";
}

TEST(CompileFault, OfADiskThatIsReadIsNoWantOfRoomForColumns) {
  for (const int threads : kThreadCounts) {
    Tall tall;
    tall.images.at("layer0").damaged_row = 0;
    tall.images.at("layer0").damage = ErrorCode::io;
    const Compiled compiled = compile_stack(header_for(tall.stack, true), tall.stack, tall.images, Tall::kLinesPerChunk,
                                            {.memory_bytes = tall.memory(threads, 8), .threads = threads});
    ASSERT_FALSE(compiled.result);
    EXPECT_EQ(compiled.result.error().code, ErrorCode::io);
    EXPECT_EQ(compiled.result.error().message, "layer0: row 0 is damaged");
  }
}

TEST(CompileFault, ABudgetTooSmallNamesTheNeed) {
  for (const LinesAlong along : {LinesAlong::rows, LinesAlong::columns}) {
    MemoryImages images;
    LayerStack stack = random_stack(images, SampleType::u16, along, 1000, 100'000, 1, 1);
    stack.decoder_bytes = 1 << 20;
    const std::int64_t least = least_compile_memory(stack, 64);
    const Compiled compiled =
        compile_stack(header_for(stack, true), stack, images, 64, {.memory_bytes = least - 1, .threads = 2});
    ASSERT_FALSE(compiled.result);
    EXPECT_EQ(compiled.result.error().code, ErrorCode::out_of_range);
    const std::string need = std::to_string((least + (1 << 20) - 1) >> 20) + " MiB";
    EXPECT_NE(compiled.result.error().message.find("at least " + need), std::string::npos)
        << compiled.result.error().message;
    EXPECT_EQ(images.opened(), 0) << "refused before anything is read";
  }
}

TEST(CompileFault, WhatTheReadersHoldCountsInTheBudget) {
  for (const bool told : {false, true}) {
    MemoryImages images;
    LayerStack stack = random_stack(images, SampleType::bit, LinesAlong::rows, 40, 80, 2, 1);
    const std::int64_t bare = least_compile_memory(stack, 8);
    images.at("layer1").info.decoder_bytes = 90 * kMiB;
    if (told) {
      stack.decoder_bytes = 90 * kMiB;
      EXPECT_EQ(least_compile_memory(stack, 8), bare + 90 * kMiB);
    }
    const auto run = [&](std::int64_t memory) {
      return compile_stack(header_for(stack, true), stack, images, 8, {.memory_bytes = memory, .threads = 4});
    };
    const Compiled refused = run(bare + 90 * kMiB - 1);
    ASSERT_FALSE(refused.result) << told;
    EXPECT_EQ(refused.result.error().code, ErrorCode::out_of_range);
    EXPECT_NE(refused.result.error().message.find("90 MiB of them to decode the largest strip or row of tiles"),
              std::string::npos)
        << refused.result.error().message;
    expect_naive(run(bare + 90 * kMiB), header_for(stack, true), stack, images);
  }
}

}  // namespace
}  // namespace gravure::test
