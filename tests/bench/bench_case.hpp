// What the benchmarks of compiling share: a picture, the plan and stack that make a job of it, a sink that keeps
// nothing.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "gravure/pipeline/compile.hpp"
#include "gravure/sync/make_plan.hpp"

namespace gravure::bench {

/// What is compiled: a bilevel layer along rows or columns, a grey one with a threshold, or a map in slices.
struct Picture {
  std::string name;
  std::string path;
  std::int64_t width = 3500;
  std::int64_t height = 27489;
  LinesAlong along = LinesAlong::rows;
  SampleType samples = SampleType::bit;
  std::int64_t levels = 0;   ///< slices of a map; 0: a layer
  std::int64_t repeats = 1;  ///< layers that all show this picture, each decoded for itself

  std::int64_t lines() const { return along == LinesAlong::rows ? height : width; }
  std::int64_t pixels() const { return along == LinesAlong::rows ? width : height; }
  std::int64_t layers() const { return levels > 0 ? levels : repeats; }
  std::int64_t line_bytes() const { return (pixels() + 7) / 8; }
};

/// Stops at the first thing that goes wrong: a benchmark of a failure would mislead.
template <class T>
T must(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::exit(1);
  }
  return std::move(result).value();
}
inline void must(const Result<void>& result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::exit(1);
  }
}

/// Takes chunks as large as those of a program file and throws them away: compiling without writing.
class NullSink final : public LineSink {
 public:
  explicit NullSink(std::int64_t line_bytes) : line_bytes_(line_bytes) {}
  std::int64_t lines_per_chunk() const noexcept override { return (std::int64_t{1} << 18) / line_bytes_; }
  Result<StoredChunk> encode(ChunkAddress address, std::span<const std::byte> lines) const override {
    benchmark::DoNotOptimize(lines.data());
    return StoredChunk{address, {}, 0, 0, 0};
  }
  Result<void> put(const StoredChunk&) override { return {}; }
  Result<void> finish(const ProgramHeader&) override { return {}; }

 private:
  std::int64_t line_bytes_;
};

inline Job job_of(const Picture& picture) {
  Job made;
  made.laser = {82'000'000, 41, 16'400'000};
  made.fpga = {2, 32, false, 4'294'967'295U};
  made.scanner.pixel_pitch_um = 8;
  made.scanner.slots_per_microvector = 20;
  made.scanner.turn_slots = 1800;
  made.scanner.bidirectional = true;
  made.rotary.circumference_mm = Rational(8 * picture.lines(), 1000);
  made.rotary.lines_per_revolution = picture.lines();
  made.rotary.encoder_lines = 11840;
  made.rotary.interpolation_bits = 13;
  made.rotary.max_ab_hz = 40'000'000;
  made.image.fires = Fires::white;
  made.limits.seam_um = Rational(1, 2);
  return made;
}

struct Case {
  ProgramHeader header;
  LayerStack stack;
};

inline Case case_of(const Picture& picture) {
  Case made;
  made.header.plan = must(make_plan(job_of(picture), picture.pixels(), picture.layers()));
  made.header.sources.push_back({picture.path, 0, picture.width, picture.height, std::string(64, '0')});
  for (std::int64_t layer = 0; layer < picture.layers(); ++layer) {
    made.header.layers.emplace_back();
    made.header.layers.back().level = picture.levels > 0 ? layer : 0;
    made.header.layers.back().starts_reverse = line_is_reverse(made.header.plan, layer, 0);
    made.header.layer_of_revolution.push_back(static_cast<std::uint32_t>(layer));
    made.stack.layers.push_back({picture.path, 0, made.header.layers.back().level});
  }
  made.stack.lines = picture.lines();
  made.stack.pixels = picture.pixels();
  made.stack.lines_along = picture.along;
  made.stack.samples = picture.samples;
  made.stack.levels = picture.levels;
  if (picture.samples == SampleType::u8 && picture.levels == 0) {
    made.stack.threshold = 128;
  }
  return made;
}

}  // namespace gravure::bench
