#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "../tiff/temp_folder.hpp"
#include "gravure/core/exposure_map.hpp"
#include "gravure/pipeline/window_reader.hpp"
#include "gravure/twin/exposure_count.hpp"
#include "gravure/twin/unroll.hpp"
#include "twin_support.hpp"

/// Helical, flat and banded jobs, from images to what the emulated board exposes.
namespace gravure::test {
namespace {

/// What a job of another mode looks like; values that are 0 are not used.
struct Shape {
  Mode mode = Mode::helical;
  std::int64_t lines = 12;
  std::int64_t columns = 45;
  std::int64_t layers = 3;
  Rational feed = 7;
  std::int64_t field_pixels = 0;
  LinesAlong along = LinesAlong::rows;
  Fires fires = Fires::white;
  bool bidirectional = true;
  std::int64_t levels = 0;     ///< a depth map of so many
  bool only_forwards = false;  ///< the files must be read from their first row on
  RepeatSettings repeat;       ///< lines and columns are those of the whole picture
};

void prepare(SmallJob& small, const Shape& shape) {
  small.job = small_job(shape.lines);
  small.job.mode = shape.mode;
  small.job.rotary.encoder_lines = 100;  // even a revolution of one line stays within reach
  small.job.scanner.bidirectional = shape.bidirectional;
  small.job.image.lines_along = shape.along;
  small.job.image.fires = shape.fires;
  small.job.carriage = {shape.feed, shape.layers, 20, 4, 41'000'000, {}};
  small.job.stage = {shape.lines, 8, 20, 4, 2'000'000, {}};
  if (shape.field_pixels > 0) {
    small.job.scanner.field_mm = ratio(8 * shape.field_pixels + 7, 1000);
    small.job.scanner.bidirectional_offset_ticks = 0;  // pulses that are late lie beyond such a field
  }
  const std::int64_t tile_lines = shape.lines / shape.repeat.around;
  const std::int64_t tile_columns = shape.columns / shape.repeat.along;
  small.stack =
      shape.levels > 0
          ? depth_stack(small.images, SampleType::u8, shape.along, tile_lines, tile_columns, shape.levels, 7)
          : random_stack(small.images, SampleType::bit, shape.along, tile_lines, tile_columns, shape.layers, 7);
  small.stack.lines = shape.lines;
  small.stack.pixels = shape.columns;
  small.stack.tiles = tile_grid(shape.repeat, shape.along);
  small.stack.fires = shape.fires;
  small.stack.random_access = !shape.only_forwards;
  for (const LayerInput& input : small.stack.layers) {
    small.images.at(input.path).info.random_access = !shape.only_forwards;
  }
}

/// One stored layer for each revolution; its image as the mode has it.
void compile_shape(SmallJob& small, const Shape& shape, std::int64_t lines_per_chunk,
                   const CompileOptions& options = {}) {
  Result<Plan> plan = make_plan(small.job, shape.columns, shape.layers);
  ASSERT_TRUE(plan) << plan.error().message;
  ProgramHeader header;
  header.plan = std::move(plan).value();
  header.fires = shape.fires;
  header.lines_along = shape.along;
  const bool helical = shape.mode == Mode::helical;
  const std::vector<LayerInput> images = small.stack.layers;
  if (!helical) {
    small.stack.layers.clear();
  }
  for (std::int64_t r = 0; r < header.plan.job.revolutions; ++r) {
    const std::int64_t image = helical ? 0 : r % revolutions_per_band(header.plan);
    const LayerInput& input = images.at(static_cast<std::size_t>(image));
    header.layers.push_back({line_is_reverse(header.plan, r, 0), 0, shape.levels > 0 ? 0 : image, input.level});
    header.layer_of_revolution.push_back(static_cast<std::uint32_t>(r));
    if (!helical) {
      small.stack.layers.push_back(input);
    }
  }
  small.program = {};
  small.program.lines_per_chunk = lines_per_chunk;
  MemorySink sink(small.program);
  const Result<ProgramHeader> compiled = compile(header, small.stack, small.images, sink, options);
  ASSERT_TRUE(compiled) << compiled.error().message;
}

LayerLinesFactory lines_of(const SmallJob& small) {
  return [&small]() -> Result<std::unique_ptr<LayerLines>> {
    return make_layer_lines(small.program.header, small.stack, small.images, 1 << 20);
  };
}

/// The picture of an image layer: 1 is white.
std::vector<std::byte> picture(SmallJob& small, const Shape& shape, std::int64_t layer) {
  const bool rows = shape.along == LinesAlong::rows;
  const std::int64_t height = rows ? shape.lines : shape.columns;
  const std::int64_t width = rows ? shape.columns : shape.lines;
  const std::int64_t row_size = row_bytes(SampleType::bit, width);
  std::vector<std::byte> bytes(static_cast<std::size_t>(height * row_size));
  for (std::int64_t row = 0; row < height; ++row) {
    for (std::int64_t column = 0; column < width; ++column) {
      const bool fired = image_pixel(small.stack, small.images, layer, rows ? row : column, rows ? column : row);
      if (fired == (shape.fires == Fires::white)) {
        set_bit(bytes, row * row_size * 8 + column);
      }
    }
  }
  return bytes;
}

std::vector<std::byte> unrolled_layer(const SmallJob& small, std::int64_t layer, std::int64_t memory) {
  std::vector<std::byte> bytes;
  MemorySource source(small.program);
  const Result<void> result = unroll_layer(source, emulated(), layer,
                                           [&](std::span<const std::byte> rows, std::int64_t) -> Result<void> {
                                             bytes.insert(bytes.end(), rows.begin(), rows.end());
                                             return {};
                                           },
                                           {.memory_bytes = memory});
  EXPECT_TRUE(result) << result.error().message;
  return bytes;
}

/// Within limits, and every layer comes back as the picture it was.
void expect_round_trip(SmallJob& small, const Shape& shape) {
  expect_sound(verify_job(small, lines_of(small)));
  const std::int64_t layers = shape.levels > 0 ? shape.levels : shape.layers;
  ASSERT_EQ(image_layers(small.program.header), layers);
  for (std::int64_t layer = 0; layer < layers; ++layer) {
    std::vector<std::byte> expected = picture(small, shape, layer);
    for (const std::int64_t memory : {std::int64_t{1} << 28, (std::int64_t{6} << 20) + 20'000}) {
      ASSERT_EQ(unrolled_layer(small, layer, memory), expected) << "layer " << layer << ", " << memory << " bytes";
    }
  }
}

std::string text_of(const Shape& shape) {
  return std::string(mode_name(shape.mode)) + ", " + std::to_string(shape.lines) + " lines, " +
         std::to_string(shape.columns) + " columns, " + std::to_string(shape.layers) + " layers, feed " +
         to_string(shape.feed) + ", field " + std::to_string(shape.field_pixels) +
         (shape.along == LinesAlong::rows ? ", rows" : ", columns") + (shape.bidirectional ? ", both ways" : "") +
         ", tiles " + std::to_string(shape.repeat.around) + " x " + std::to_string(shape.repeat.along) +
         (shape.repeat.mirror_around ? ", mirrored around" : "") + (shape.repeat.mirror_along ? ", along" : "");
}

/// A shape of any mode.
Shape random_shape(Dice& dice, Mode mode) {
  Shape shape;
  shape.mode = mode;
  shape.lines = dice.between(1, 20);
  shape.columns = dice.between(1, 90);
  shape.layers = dice.between(1, 4);
  const std::int64_t den = dice.coin() ? 1 : dice.between(1, 9);
  shape.feed = ratio(dice.between(2, 12 * den), den);
  shape.field_pixels = mode == Mode::helical ? 0 : dice.between(mode == Mode::rotary ? 1 : 0, 60);
  shape.along = dice.coin() ? LinesAlong::rows : LinesAlong::columns;
  shape.fires = dice.coin() ? Fires::white : Fires::black;
  shape.bidirectional = dice.between(0, 3) != 0;
  if (dice.between(0, 3) == 0) {
    shape.levels = shape.layers;
  }
  shape.only_forwards = dice.between(0, 2) == 0;
  return shape;
}

TEST(Modes, ComeBackAsTheImagesTheyWereMadeFrom) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 120; ++trial) {
    const Shape shape = random_shape(dice, static_cast<Mode>(trial % 3));
    SCOPED_TRACE(text_of(shape));
    SmallJob small;
    prepare(small, shape);
    compile_shape(small, shape, dice.between(1, 8), {.threads = 2});
    if (HasFatalFailure()) {
      return;
    }
    expect_round_trip(small, shape);
    if (HasFailure()) {
      return;
    }
  }
}

/// Every line that the board fires, into a count.
class Counter final : public PinObserver {
 public:
  Counter(ExposureCount& count, std::int64_t lines_per_revolution) : count_(count), lines_(lines_per_revolution) {}
  void on_line(const ExecutedLine& line) override {
    const Result<void> added = count_.add(line.ordinal / lines_, line.ordinal % lines_, line.first_slot, line.fired);
    EXPECT_TRUE(added) << added.error().message;
  }

 private:
  ExposureCount& count_;
  std::int64_t lines_;
};

/// Runs all of a program, `times` times.
void fire(const SmallJob& small, ExposureCount& count, int times) {
  MemorySource source(small.program);
  const Plan& plan = small.program.header.plan;
  Counter counter(count, plan.rotary.lines_per_revolution);
  const std::unique_ptr<LineDevice> device = emulated()(counter);
  ProgramChunk chunk;
  for (int time = 0; time < times; ++time) {
    for (std::int64_t r = 0; r < plan.job.revolutions; ++r) {
      ASSERT_TRUE(device->configure(device_setup(plan, r, 0)));
      const std::int64_t layer = small.program.header.layer_of_revolution[static_cast<std::size_t>(r)];
      for (std::int64_t k = 0; k * source.lines_per_chunk() < plan.rotary.lines_per_revolution; ++k) {
        ASSERT_TRUE(chunk.load(source, {layer, k}));
        ASSERT_TRUE(chunk.send(small.program.header, r, *device));
      }
    }
  }
}

/// Fired `times` times wherever the picture has the colour that fires, some rows at a time.
void expect_counts(SmallJob& small, const Shape& shape, std::int64_t image, Result<ExposureCount> made, int times) {
  ASSERT_TRUE(made) << made.error().message;
  ExposureCount& count = made.value();
  const std::vector<std::byte> expected = picture(small, shape, image);
  const auto [width, height] = count.size();
  const std::int64_t row_size = row_bytes(SampleType::bit, width);
  const std::int64_t part = (height + 1) / 2;
  for (std::int64_t first = 0; first < height; first += part) {
    const std::int64_t end = std::min(first + part, height);
    count.start(first, end);
    fire(small, count, times);
    ASSERT_EQ(count.rows().size(), static_cast<std::size_t>((end - first) * width));
    for (std::int64_t row = first; row < end; ++row) {
      for (std::int64_t column = 0; column < width; ++column) {
        const auto byte = expected[static_cast<std::size_t>(row * row_size + column / 8)];
        const bool white = (byte & static_cast<std::byte>(0x80U >> static_cast<unsigned>(column % 8))) != std::byte{0};
        const int fired = white == (shape.fires == Fires::white) ? times : 0;
        ASSERT_EQ(std::to_integer<int>(count.rows()[static_cast<std::size_t>((row - first) * width + column)]), fired)
            << "row " << row << ", column " << column;
      }
    }
  }
}

TEST(ExposureCount, CountsEveryPixelOfEveryPictureAsOftenAsItFired) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 60; ++trial) {
    const Shape shape = random_shape(dice, static_cast<Mode>(trial % 3));
    SCOPED_TRACE(text_of(shape));
    SmallJob small;
    prepare(small, shape);
    compile_shape(small, shape, dice.between(1, 8));
    if (HasFatalFailure()) {
      return;
    }
    const ProgramHeader& header = small.program.header;
    const bool helical = shape.mode == Mode::helical;
    const std::int64_t pictures = helical ? shape.layers : revolutions_per_band(header.plan);
    const std::int64_t chosen = dice.between(0, pictures - 1);
    expect_counts(
        small, shape, chosen,
        helical ? ExposureCount::make(header, std::nullopt, chosen) : ExposureCount::make(header, chosen, std::nullopt),
        static_cast<int>(dice.between(1, 2)));
    if (HasFailure()) {
      return;
    }
  }
}

TEST(ExposureCount, RefusesWhatTheProgramDoesNotHave) {
  SmallJob small;
  sound_job(small);
  const ProgramHeader& header = small.program.header;
  EXPECT_EQ(ExposureCount::make(header, 8, std::nullopt).error().code, ErrorCode::out_of_range);
  EXPECT_EQ(ExposureCount::make(header, std::nullopt, 0).error().code, ErrorCode::bad_argument);
  Result<ExposureCount> made = ExposureCount::make(header, std::nullopt, std::nullopt);
  ASSERT_TRUE(made);
  ExposureCount& count = made.value();
  count.start(0, count.size().height);
  const std::vector<std::byte> bits(static_cast<std::size_t>(header.line_bytes()), std::byte{0x80});
  const std::int64_t forward = header.plan.line.forward_first_slot;
  const std::int64_t reverse = header.plan.line.reverse_first_slot;
  for (int time = 0; time < 255; ++time) {
    ASSERT_TRUE(count.add(0, 0, forward, bits));
  }
  EXPECT_EQ(count.add(0, 0, forward, bits).error().code, ErrorCode::out_of_range);
  EXPECT_TRUE(count.add(0, 1, reverse, bits));
  EXPECT_TRUE(count.add(0, 1, reverse - 1, bits)) << "and part of a slot later";
  for (const Result<void>& refused :
       {count.add(8, 0, forward, bits), count.add(0, 13, forward, bits), count.add(0, 0, forward + 1, bits),
        count.add(0, 0, forward - 1, bits), count.add(0, 0, forward, std::span(bits).first(2))}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_file);
  }
}

TEST(Modes, ComeBackAsThePicturesThatTilesMake) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 90; ++trial) {
    Shape shape = random_shape(dice, static_cast<Mode>(trial % 3));
    shape.repeat.around = dice.between(1, 5);
    shape.repeat.along = dice.between(1, 5);
    shape.repeat.mirror_around = dice.coin();
    shape.repeat.mirror_along = dice.coin();
    shape.lines = dice.between(1, 7) * shape.repeat.around;
    shape.columns = dice.between(1, 20) * shape.repeat.along;
    SCOPED_TRACE(text_of(shape));
    SmallJob small;
    prepare(small, shape);
    compile_shape(small, shape, dice.between(1, 8), {.threads = 2});
    if (HasFatalFailure()) {
      return;
    }
    expect_round_trip(small, shape);
    if (HasFailure()) {
      return;
    }
  }
}

TEST(Modes, HelicalProgramIsTheSameWhateverTheMemoryAndReadsNoMoreThanItMust) {
  Shape shape;
  shape.lines = 64;
  shape.columns = 40'000;
  shape.layers = 4;
  shape.feed = ratio(2001, 10);
  SmallJob roomy;
  prepare(roomy, shape);
  const std::int64_t before = roomy.images.rows_read();
  compile_shape(roomy, shape, 32, {.memory_bytes = std::int64_t{64} << 20, .threads = 1});
  ASSERT_FALSE(HasFailure());
  EXPECT_EQ(roomy.images.rows_read() - before, shape.layers * shape.lines) << "each image row once";

  SmallJob tight;
  prepare(tight, shape);
  const std::int64_t least = [&] {
    ProgramHeader header = roomy.program.header;
    MemoryProgram program;
    program.lines_per_chunk = 32;
    MemorySink sink(program);
    const Result<ProgramHeader> refused =
        compile(header, tight.stack, tight.images, sink, {.memory_bytes = std::int64_t{1} << 20, .threads = 1});
    EXPECT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
    const std::size_t at = refused.error().message.find("at least ");
    return std::stoll(refused.error().message.substr(at + 9)) << 20;
  }();
  const std::int64_t start = tight.images.rows_read();
  compile_shape(tight, shape, 32, {.memory_bytes = least, .threads = 1});
  ASSERT_FALSE(HasFailure());
  EXPECT_GE(tight.images.rows_read() - start, 2 * shape.layers * shape.lines) << "several panels";
  ASSERT_EQ(tight.program.chunks.size(), roomy.program.chunks.size());
  EXPECT_EQ(tight.program.order, roomy.program.order);
  for (const auto& [address, chunk] : roomy.program.chunks) {
    ASSERT_EQ(tight.program.chunks.at(address).bytes, chunk.bytes) << address.first << ", " << address.second;
  }
}

TEST(Modes, HelicalImagesThatTakeTurnsWriteNoColumnsToTemporaryFiles) {
  const TempFolder folder;
  const auto long_ago = std::filesystem::last_write_time(folder.path()) - std::chrono::hours(1);
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  for (const std::int64_t layers : {1, 2}) {
    Shape shape;
    shape.lines = 1'024;
    shape.columns = 10'000;
    shape.layers = layers;
    shape.feed = 2'000;
    shape.along = LinesAlong::columns;
    SmallJob small;
    prepare(small, shape);
    for (const LayerInput& input : small.stack.layers) {
      small.images.at(input.path).packed_row = [](std::int64_t row, std::span<std::byte> out) {
        std::memset(out.data(), static_cast<int>(row & 0xFF), out.size());
      };
    }
    std::filesystem::last_write_time(folder.path(), long_ago);
    ASSERT_EQ(::setenv("TMPDIR", folder.path().c_str(), 1), 0);
    compile_shape(small, shape, 128, {.memory_bytes = std::int64_t{8} << 20, .threads = 1});
    EXPECT_EQ(before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1), 0);
    ASSERT_FALSE(HasFailure());
    EXPECT_EQ(std::filesystem::last_write_time(folder.path()) == long_ago, layers == 2) << layers << " layers";
  }
}

TEST(Modes, StayDarkInRunInAndRunOut) {
  Shape shape;
  shape.fires = Fires::black;
  SmallJob small;
  prepare(small, shape);
  for (std::int64_t layer = 0; layer < shape.layers; ++layer) {  // every pixel fires
    small.images.at("layer" + std::to_string(layer)).samples = [](std::int64_t, std::int64_t) { return 0.0; };
  }
  compile_shape(small, shape, 5);
  ASSERT_FALSE(HasFailure());
  std::int64_t fired = 0;
  for (const StoredLayer& layer : small.program.header.layers) {
    fired += layer.fired_pixels;
  }
  EXPECT_EQ(fired, shape.lines * shape.columns * shape.layers);
}

TEST(Modes, CarriageDriftIsJudged) {
  Shape shape;
  SmallJob small;
  prepare(small, shape);
  small.job.fpga.fractional = false;
  small.job.fpga.max_prescaler = 1;
  small.job.fpga.counter_bits = 24;
  small.job.rotary.encoder_lines = 1024;  // with these the workpiece closes exactly; the carriage does not
  small.job.laser.pulse_divider = 64;
  small.job.limits.seam_um = ratio(1, 1'000'000);
  compile_shape(small, shape, 5);
  ASSERT_FALSE(HasFailure());
  const Plan& plan = small.program.header.plan;
  ASSERT_FALSE(plan.carriage->ab.exact);
  const Result<VerifyReport> report = verify_job(small, lines_of(small));
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_TRUE(report.value().carriage);
  EXPECT_DOUBLE_EQ(report.value().carriage->seam_end_um,
                   to_double(Rational(plan.carriage->ab.drift_um_per_revolution * plan.job.revolutions)));
  ASSERT_TRUE(report.value().carriage->seam_end_measured_um);
  EXPECT_NEAR(*report.value().carriage->seam_end_measured_um, report.value().carriage->seam_end_um,
              2 * report.value().carriage->ab_step_um);
  expect_violation(report.value(), "the carriage is ");
}

TEST(Modes, WrongCarriageRegistersAreSeen) {
  Shape shape;
  SmallJob small;
  prepare(small, shape);
  compile_shape(small, shape, 5);
  ASSERT_FALSE(HasFailure());
  small.program.header.plan.carriage->ab.increment += 1;
  const Result<VerifyReport> report = verify_job(small, lines_of(small));
  ASSERT_TRUE(report) << report.error().message;
  expect_violation(report.value(), "carriage: the A-B registers");
}

/// A device whose second channel misses an edge.
class LameCarriage final : public LineDevice {
 public:
  explicit LameCarriage(PinObserver& pins) : watcher_(pins), device_(&watcher_) {}
  Result<void> configure(const DeviceSetup& setup) override { return device_.configure(setup); }
  Result<void> send(const LineFrame& frame) override { return device_.send(frame); }
  DeviceStatus status() const override { return device_.status(); }

 private:
  struct Watcher final : PinObserver {
    explicit Watcher(PinObserver& next) : next_(next) {}
    void on_line(const ExecutedLine& line) override {
      ExecutedLine lame = line;
      lame.carriage_at_start.edges -= line.ordinal == 17 ? 1 : 0;
      next_.on_line(lame);
    }
    PinObserver& next_;
  };
  Watcher watcher_;
  emulator::EmulatedDevice device_;
};

TEST(Modes, LostCarriageEdgeIsNamedWithItsLine) {
  Shape shape;
  SmallJob small;
  prepare(small, shape);
  compile_shape(small, shape, 5);
  ASSERT_FALSE(HasFailure());
  const Result<VerifyReport> report =
      verify_job(small, lines_of(small), {},
                 [](PinObserver& pins) -> std::unique_ptr<LineDevice> { return std::make_unique<LameCarriage>(pins); });
  ASSERT_TRUE(report) << report.error().message;
  expect_violation(report.value(),
                   "the carriage stands wrong at 1 line start(s) or ends, the first at revolution 1, line 5");
}

TEST(Modes, TurnedBitsAreFoundInEveryMode) {
  for (const Mode mode : {Mode::rotary, Mode::helical, Mode::flat}) {
    Shape shape;
    shape.mode = mode;
    shape.field_pixels = mode == Mode::helical ? 0 : 20;
    SmallJob small;
    prepare(small, shape);
    compile_shape(small, shape, 5);
    ASSERT_FALSE(HasFailure());
    const Result<VerifyReport> report =
        verify_job(small, lines_of(small), {}, emulated(), [](ChunkAddress address, std::span<std::byte> lines) {
          if (address.layer == 2 && address.chunk == 1) {
            lines[0] ^= std::byte{0x40};
          }
        });
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report.value().wrong_pixels, 1) << mode_name(mode);
    EXPECT_EQ(report.value().first_wrong_pixel->revolution, 2);
    EXPECT_EQ(report.value().first_wrong_pixel->line, 5);
  }
}

TEST(Modes, StageDriftDoesNotAddUpOverPasses) {
  Shape shape;
  shape.mode = Mode::flat;
  shape.layers = 9;
  SmallJob small;
  prepare(small, shape);
  small.job.fpga.fractional = false;
  small.job.fpga.max_prescaler = 1;
  small.job.fpga.counter_bits = 20;
  small.job.limits.seam_um = 100;
  compile_shape(small, shape, 5);
  ASSERT_FALSE(HasFailure());
  const AbPlan& ab = small.program.header.plan.ab;
  ASSERT_FALSE(ab.exact);
  const Result<VerifyReport> report = verify_job(small, lines_of(small));
  expect_sound(report);
  EXPECT_DOUBLE_EQ(report.value().seam_end_um, to_double(ab.drift_um_per_revolution));
}

TEST(Unroll, OfHelicalProgramsNeedsALayer) {
  Shape shape;
  SmallJob small;
  prepare(small, shape);
  compile_shape(small, shape, 5);
  ASSERT_FALSE(HasFailure());
  MemorySource source(small.program);
  const RowSink sink = [](std::span<const std::byte>, std::int64_t) -> Result<void> { return {}; };
  const Result<void> revolution = unroll(source, emulated(), 0, sink, {});
  ASSERT_FALSE(revolution);
  EXPECT_EQ(revolution.error().code, ErrorCode::bad_argument);
  EXPECT_NE(revolution.error().message.find("--layer, 0 to 2"), std::string::npos);
  const Result<void> layer = unroll_layer(source, emulated(), 3, sink, {});
  ASSERT_FALSE(layer);
  EXPECT_EQ(layer.error().code, ErrorCode::out_of_range);
}

}  // namespace
}  // namespace gravure::test
