#include "gravure/twin/verify.hpp"

#include <atomic>

#include "gravure/core/units.hpp"
#include "gravure/sync/drift.hpp"
#include "twin_support.hpp"

namespace gravure::test {
namespace {

constexpr LinesAlong kBoth[] = {LinesAlong::rows, LinesAlong::columns};

std::int64_t pulses(SmallJob& small) {
  std::int64_t count = 0;
  for (const std::uint32_t layer : small.program.header.layer_of_revolution) {
    for (std::int64_t line = 0; line < small.stack.lines; ++line) {
      for (std::int64_t column = 0; column < small.stack.pixels; ++column) {
        count += image_pixel(small.stack, small.images, layer, line, column) ? 1 : 0;
      }
    }
  }
  return count;
}

TEST(Verify, FindsNothingWrongWithAnExactJob) {
  for (const LinesAlong along : kBoth) {
    for (const std::int64_t lines : {12, 13}) {
      for (const bool bidirectional : {true, false}) {
        for (const Fires which : {Fires::white, Fires::black}) {
          SCOPED_TRACE(testing::Message() << lines << " lines, bidirectional " << bidirectional);
          SmallJob small;
          prepare(small, along, lines, 45, 5);
          small.job.scanner.bidirectional = bidirectional;
          small.job.image.fires = small.stack.fires = which;
          compile_job(small, 5, LayerOrder::sequence);
          const Result<VerifyReport> report = verify_job(small, small.lines());
          expect_sound(report);
          EXPECT_EQ(report.value().lines, 5 * lines);
          EXPECT_EQ(report.value().pixels, 5 * lines * 45);
          EXPECT_EQ(report.value().fired_pixels, pulses(small));
          EXPECT_EQ(report.value().ticks, small.program.header.plan.job.ticks);
          EXPECT_TRUE(report.value().images_compared);
          EXPECT_EQ(report.value().seam_end_um, 0.0);
          EXPECT_EQ(report.value().seam_max_um, 0.0);
          EXPECT_LT(report.value().axis_error_max_um, report.value().ab_step_um);
        }
      }
    }
  }
}

/// On an odd number of lines the directions swap with every revolution, so a layer that is held is mirrored on every
/// second one.
TEST(Verify, ReadsAHeldLayerMirroredOnEverySecondRevolutionOfOddLines) {
  for (const LinesAlong along : kBoth) {
    SmallJob small;
    prepare(small, along, 13, 45, 2);
    compile_job(small, 7, LayerOrder::hold);
    expect_sound(verify_job(small, small.lines()));
    SmallJob cycled;
    prepare(cycled, along, 13, 45, 3);
    compile_job(cycled, 11, LayerOrder::cycle);
    expect_sound(verify_job(cycled, cycled.lines()));
    EXPECT_EQ(verify_job(cycled, cycled.lines()).value().fired_pixels, pulses(cycled));
  }
}

TEST(Verify, CutsTheLayersOfADepthMapItself) {
  for (const LinesAlong along : kBoth) {
    for (const Fires which : {Fires::white, Fires::black}) {
      SmallJob small;
      small.job = small_job(11);
      small.stack = depth_stack(small.images, SampleType::u16, along, 11, 30, 6, 5);
      small.job.image.fires = small.stack.fires = which;
      compile_job(small, 6, LayerOrder::sequence);
      const Result<VerifyReport> report = verify_job(small, small.lines());
      expect_sound(report);
      EXPECT_EQ(report.value().fired_pixels, pulses(small));
    }
  }
}

TEST(Verify, ReportsTheSameForAnyNumberOfThreads) {
  SmallJob small;
  prepare(small, LinesAlong::rows, 53, 45, 6);
  small.job.fpga.fractional = false;
  small.job.fpga.counter_bits = 20;
  compile_job(small, 30, LayerOrder::cycle);
  const auto damage = [](ChunkAddress address, std::span<std::byte> lines) {
    if (address.chunk % 3 == 1) {
      lines[static_cast<std::size_t>(address.layer)] ^= std::byte{0x10};
    }
  };
  const Result<VerifyReport> one = verify_job(small, small.lines(), {.threads = 1}, emulated(), damage);
  ASSERT_TRUE(one);
  EXPECT_GT(one.value().wrong_pixels, 0);
  for (const int threads : {2, 5}) {
    for (const std::int64_t memory : {std::int64_t{8} << 20, std::int64_t{20} << 20, std::int64_t{1} << 30}) {
      const Result<VerifyReport> other =
          verify_job(small, small.lines(), {.memory_bytes = memory, .threads = threads}, emulated(), damage);
      ASSERT_TRUE(other);
      expect_same(one.value(), other.value());
    }
  }
}

/// A job whose counter cannot meet the ratio: the drift is real.
void drifting_job(SmallJob& small, const Rational& limit_um) {
  prepare(small, LinesAlong::rows, 53, 45, 1);
  small.job.fpga.fractional = false;
  small.job.fpga.counter_bits = 24;
  small.job.fpga.max_prescaler = 3;
  small.job.limits.seam_um = limit_um;
  compile_job(small, 40, LayerOrder::hold);
}

TEST(Verify, TellsTheDriftOfThePlan) {
  SmallJob small;
  drifting_job(small, Rational(1000));
  const Plan& plan = small.program.header.plan;
  ASSERT_FALSE(plan.ab.exact) << "this job is to drift";
  const Result<VerifyReport> got = verify_job(small, small.lines());
  expect_sound(got);
  const VerifyReport& report = got.value();
  ASSERT_EQ(report.seam.size(), 40U);
  for (const SeamRow& row : report.seam) {
    const Integer lines = Integer(row.revolution + 1) * 53;
    EXPECT_EQ(row.drift_lines, drift_lines_after(plan, lines));
    EXPECT_EQ(row.drift_um, to_double(drift_um_after(plan, lines)));
    EXPECT_EQ(row.drift_um, to_double(seam_after_revolution(plan, row.revolution).accumulated_um));
  }
  EXPECT_EQ(report.seam_end_um, to_double(drift_um_after(plan, 40 * 53)));
  EXPECT_EQ(report.seam_max_um, std::abs(report.seam_end_um));
  EXPECT_EQ(report.seam_worst_revolution, 39);
  EXPECT_EQ(report.seam_worst_line, 52);
  EXPECT_EQ(report.seam_limit_um, 1000.0);
  // What the device tells of its axis after the last line is the same, less the step it is about to make.
  ASSERT_TRUE(report.seam_end_measured_um);
  EXPECT_LE(*report.seam_end_measured_um, report.seam_end_um + 1e-9);
  EXPECT_GT(*report.seam_end_measured_um, report.seam_end_um - 2 * report.ab_step_um);
}

TEST(Verify, SaysWhenTheSeamGoesBeyondTheLimit) {
  SmallJob within;
  drifting_job(within, Rational(1000));
  const Plan& plan = within.program.header.plan;
  const Rational end = abs(drift_um_after(plan, 40 * 53));
  ASSERT_GT(end, 0);
  SmallJob at;
  drifting_job(at, end);
  expect_sound(verify_job(at, at.lines()));  // exactly the limit does not exceed it
  SmallJob beyond;
  drifting_job(beyond, Rational(end * ratio(999'999, 1'000'000)));
  const Result<VerifyReport> report = verify_job(beyond, beyond.lines());
  ASSERT_TRUE(report);
  ASSERT_EQ(report.value().violations.size(), 1U) << all(report.value().violations);
  expect_violation(report.value(), "exceeds limits.seam_um");
}

TEST(Verify, SaysWhenTheImagesAreMissing) {
  SmallJob small;
  sound_job(small);
  const Result<VerifyReport> report = verify_job(small, {});
  ASSERT_TRUE(report);
  ASSERT_EQ(report.value().violations.size(), 1U);
  expect_violation(report.value(), "the images were not found");
  EXPECT_FALSE(report.value().images_compared);
}

TEST(Verify, StopsOnRequest) {
  SmallJob small;
  sound_job(small);
  for (const int threads : {1, 2, 5}) {
    CancelToken cancel;
    cancel.cancel();
    const Result<VerifyReport> report = verify_job(small, small.lines(), {.threads = threads, .cancel = &cancel});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::cancelled);
  }
}

TEST(Verify, StopsWithinABandWhileColumnsAreCollected) {
  constexpr std::int64_t kColumns = 32'768;  // columns of the picture: 256 of its rows are a band of 1 MiB
  constexpr std::int64_t kRows = 1'024;
  SmallJob small;
  small.job = small_job(kColumns);
  small.stack = random_stack(small.images, SampleType::bit, LinesAlong::columns, kColumns, kRows, 1, 1);
  CancelToken* brake = nullptr;
  small.images.at("layer0").packed_row = [&](std::int64_t row, std::span<std::byte> out) {
    std::fill(out.begin(), out.end(), static_cast<std::byte>(row));
    if (brake != nullptr) {
      brake->cancel();
    }
  };
  ASSERT_NO_FATAL_FAILURE(compile_job(small, 1, LayerOrder::cycle, 4'096));
  for (const int threads : {1, 2}) {
    CancelToken cancel;
    brake = &cancel;
    const std::int64_t before = small.images.rows_read();
    const Result<VerifyReport> report = verify_job(small, small.lines(), {.threads = threads, .cancel = &cancel});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::cancelled);
    EXPECT_EQ(report.error().message, "stopped before everything was verified");
    EXPECT_LE(small.images.rows_read() - before, threads * 256) << threads << " threads";
    EXPECT_GT(small.images.rows_read(), before);
  }
}

TEST(Verify, HandsOnWhatTheProgramSays) {
  for (const int threads : {1, 2, 5}) {
    SmallJob small;
    sound_job(small);
    small.program.chunks.erase({5, 2});
    const Result<VerifyReport> missing = verify_job(small, small.lines(), {.threads = threads});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::bad_file);
    EXPECT_EQ(missing.error().message, "layer 5, chunk 2 is missing");
  }
}

TEST(Verify, GoesOnWithoutAnImageThatIsDamaged) {
  for (const int threads : {1, 2, 5}) {
    SmallJob small;
    sound_job(small);
    small.images.at("layer3").damaged_row = 7;
    const auto damage = [](ChunkAddress address, std::span<std::byte> lines) {
      if (address.layer == 6) {
        lines[0] ^= std::byte{0x10};  // of every chunk
      }
    };
    const Result<VerifyReport> sound = verify_job(small, small.lines(), {.threads = threads});
    ASSERT_TRUE(sound) << sound.error().message;
    ASSERT_EQ(sound.value().violations.size(), 1U) << all(sound.value().violations);
    const std::int64_t lines = sound.value().uncompared_lines;
    EXPECT_GT(lines, 0);
    EXPECT_LE(lines, small.program.lines_per_chunk) << "the rest of the image is compared";
    EXPECT_EQ(sound.value().violations[0], "the image of layer 3 cannot be read, so " + std::to_string(lines) +
                                               " lines were not compared: layer3: row 7 is damaged");
    EXPECT_FALSE(sound.value().images_compared);
    EXPECT_EQ(sound.value().lines, 8 * 13) << "every line is run all the same";
    const Result<VerifyReport> wrong = verify_job(small, small.lines(), {.threads = threads}, emulated(), damage);
    ASSERT_TRUE(wrong) << wrong.error().message;
    expect_violation(wrong.value(), "landed pixels differ from the images, the first at revolution 6, line 0");
    expect_violation(wrong.value(), "the image of layer 3 cannot be read");
  }
}

TEST(Verify, GoesOnWithoutImagesThatAreNotThere) {
  SmallJob small;
  sound_job(small);
  for (const std::size_t layer : {std::size_t{2}, std::size_t{5}}) {
    small.stack.layers[layer].path = "gone" + std::to_string(layer);
  }
  const Result<VerifyReport> report = verify_job(small, small.lines(), {.threads = 2});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().uncompared_lines, 2 * 13);
  ASSERT_EQ(report.value().violations.size(), 2U) << all(report.value().violations);
  expect_violation(report.value(), "the image of layer 2 cannot be read, so 13 lines were not compared: gone2: page 0");
  expect_violation(report.value(), "the image of layer 5 cannot be read, so 13 lines were not compared: gone5: page 0");
}

TEST(Verify, SaysOnceThatADepthMapIsNotThere) {
  SmallJob small;
  small.job = small_job(11);
  small.stack = depth_stack(small.images, SampleType::u16, LinesAlong::rows, 11, 30, 6, 5);
  compile_job(small, 12, LayerOrder::cycle);
  for (LayerInput& layer : small.stack.layers) {
    layer.path = "gone";
  }
  const Result<VerifyReport> report = verify_job(small, small.lines());
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report.value().uncompared_lines, 12 * 11);
  ASSERT_EQ(report.value().violations.size(), 1U) << all(report.value().violations);
  expect_violation(report.value(), "the image of layers 0 to 5 cannot be read, so 132 lines were not compared: gone");
}

TEST(Verify, RefusesABudgetThatHoldsNoWorkerAndNamesTheNeed) {
  SmallJob small;
  sound_job(small);
  small.images.at("layer4").info.decoder_bytes = std::int64_t{50} << 20;
  const Result<VerifyReport> refused = verify_job(small, small.lines(), {.memory_bytes = std::int64_t{55} << 20});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.error().message.find("at least 57 MiB, 50 of them to read its images"), std::string::npos)
      << refused.error().message;
  expect_sound(verify_job(small, small.lines(), {.memory_bytes = std::int64_t{57} << 20, .threads = 3}));
}

TEST(Verify, RunsOutOfMemoryWithAnError) {
  class Greedy final : public LayerLines {
   public:
    Result<bool> read_lines(std::int64_t, std::int64_t, std::int64_t, std::span<std::byte>) override {
      throw std::bad_alloc();
    }
  };
  for (const int threads : {1, 4}) {
    SmallJob small;
    sound_job(small);
    const LayerLinesFactory greedy = []() -> Result<std::unique_ptr<LayerLines>> {
      return std::unique_ptr<LayerLines>(std::make_unique<Greedy>());
    };
    const Result<VerifyReport> report = verify_job(small, greedy, {.threads = threads});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::io);
    EXPECT_EQ(report.error().message.rfind("out of memory", 0), 0U);
  }
}

/// What the readers of a program hold together is in the budget once, whoever else works.
TEST(Verify, CountsOnceWhatTheReadersOfTheProgramShare) {
  SmallJob small;
  sound_job(small);
  const auto readers_of = [&small](const VerifyOptions& options, Result<VerifyReport>& report) {
    std::atomic<int> readers = 0;
    const auto programs = [&]() -> Result<std::unique_ptr<LineSource>> {
      ++readers;
      return std::unique_ptr<LineSource>(std::make_unique<MemorySource>(small.program));
    };
    report = verify(programs, emulated(), {}, options);
    return readers.load();
  };
  Result<VerifyReport> report = Error{ErrorCode::bad_argument, "not run"};
  // A worker takes a little more than 6 MiB; verify() itself has a reader, too.
  EXPECT_EQ(readers_of({.memory_bytes = 20 * kMiB, .threads = 4}, report), 1 + 3);
  EXPECT_TRUE(report);
  EXPECT_EQ(readers_of({.memory_bytes = 30 * kMiB, .table_bytes = 10 * kMiB, .threads = 4}, report), 1 + 3);
  EXPECT_TRUE(report);
  EXPECT_EQ(readers_of({.memory_bytes = 20 * kMiB, .threads = 40, .budget = BudgetOptions{}}, report), 2 * (1 + 3))
      << "where pulses land is simulated within the budget, too";
  EXPECT_TRUE(report);
  EXPECT_EQ(readers_of({.memory_bytes = 20 * kMiB, .table_bytes = 14 * kMiB, .threads = 4}, report), 1);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(
      report.error().message,
      "memory budget of 20 MiB: verifying this program needs at least 21 MiB, 0 of them to read its images and 14 "
      "for the tables of its chunks: raise --memory");
}

}  // namespace
}  // namespace gravure::test
