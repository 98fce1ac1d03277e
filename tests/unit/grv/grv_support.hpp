#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/sync/make_plan.hpp"

namespace gravure::grv_test {

using Compression = GrvOptions::Compression;
using Bytes = std::vector<std::byte>;

inline std::uint32_t test_seed() {
  const char* text = std::getenv("GRAVURE_TEST_SEED");
  return text == nullptr ? 1U : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

/// A folder of its own for each test, gone afterwards.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "gravure_grv_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      found.push_back(entry.path().filename().string());
    }
    return found;
  }

 private:
  std::filesystem::path path_;
};

inline Bytes load(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

inline void save(const std::string& path, const Bytes& bytes) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// A plan that any size from one pixel and one line on can have.
inline Plan small_plan(std::int64_t pixels, std::int64_t lines, std::int64_t revolutions, bool bidirectional = true) {
  Job job;
  job.title = "program file test";
  job.laser = {.seed_hz = 82'000'000, .pulse_divider = 41, .max_pulse_on_demand_hz = 16'400'000};
  job.fpga.clock_multiplier = 2;
  job.scanner.pixel_pitch_um = 8;
  job.scanner.slots_per_microvector = 20;
  job.scanner.turn_slots = 100;
  job.scanner.bidirectional = bidirectional;
  job.rotary.circumference_mm = Rational(220);
  job.rotary.lines_per_revolution = lines;
  job.rotary.encoder_lines = 100;
  job.rotary.max_ab_hz = 40'000'000;
  job.limits.seam_um = Rational(1, 2);
  auto plan = make_plan(job, pixels, revolutions);
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
  return plan ? std::move(plan).value() : Plan{};
}

enum class Picture : std::uint8_t { blank, noise, dither, stripes };

/// The lines of one layer as the pipeline would give them: unused low bits 0.
inline Bytes draw(Picture picture, std::int64_t pixels, std::int64_t lines, std::uint32_t seed) {
  const std::int64_t line_bytes = (pixels + 7) / 8;
  Bytes bits(static_cast<std::size_t>(line_bytes * lines), std::byte{0});
  std::mt19937 random(seed);
  for (std::int64_t line = 0; line < lines; ++line) {
    for (std::int64_t x = 0; x < pixels; ++x) {
      const bool fires = picture == Picture::noise     ? (random() & 1U) != 0
                         : picture == Picture::dither  ? random() % 256 < static_cast<std::uint32_t>(x % 256)
                         : picture == Picture::stripes ? ((x / 16 + line / 16) & 1) != 0
                                                       : false;
      if (fires) {
        bits[static_cast<std::size_t>(line * line_bytes + x / 8)] |= std::byte{0x80} >> (x % 8);
      }
    }
  }
  return bits;
}

inline std::int64_t count_set(const Bytes& bits) {
  std::int64_t count = 0;
  for (std::byte byte : bits) {
    for (; byte != std::byte{0}; byte <<= 1) {
      count += (byte & std::byte{0x80}) != std::byte{0} ? 1 : 0;
    }
  }
  return count;
}

/// A whole program in memory.
struct Program {
  ProgramHeader header;
  std::vector<Bytes> layers;
};

inline Program make_program(std::int64_t pixels, std::int64_t lines, const std::vector<Picture>& pictures,
                            bool bidirectional = true) {
  Program program;
  ProgramHeader& header = program.header;
  const auto layers = static_cast<std::int64_t>(pictures.size());
  header.plan = small_plan(pixels, lines, 2 * layers + 1, bidirectional);
  header.job_text = "[job]\ntitle = \"program file test\"  # \xc3\xa4\n";
  header.job_path = "somewhere/job.toml";
  header.fires = Fires::black;
  header.lines_along = LinesAlong::columns;
  for (std::int64_t layer = 0; layer < layers; ++layer) {
    program.layers.push_back(draw(pictures[static_cast<std::size_t>(layer)], pixels, lines,
                                  test_seed() + static_cast<std::uint32_t>(layer)));
    header.sources.push_back({"layers/" + std::string(static_cast<std::size_t>(layer), 'a') + ".tif", layer, pixels,
                              lines, std::string(64, static_cast<char>('0' + layer))});
    header.layers.push_back({bidirectional && layer % 2 == 1, count_set(program.layers.back()), layer, layer * 7});
  }
  for (std::int64_t r = 0; r < header.plan.job.revolutions; ++r) {
    header.layer_of_revolution.push_back(static_cast<std::uint32_t>(r % layers));
  }
  return program;
}

inline Result<std::unique_ptr<LineSink>> start(const std::string& path, const Program& program,
                                               const GrvOptions& options) {
  return create_grv(path, static_cast<std::int64_t>(program.layers.size()),
                    program.header.plan.rotary.lines_per_revolution, program.header.line_bytes(), options);
}

/// The lines of one chunk of a program.
inline std::span<const std::byte> lines_of(const Program& program, ChunkAddress address, std::int64_t per_chunk) {
  const auto bytes = static_cast<std::size_t>(per_chunk * program.header.line_bytes());
  const Bytes& layer = program.layers[static_cast<std::size_t>(address.layer)];
  const std::size_t first = static_cast<std::size_t>(address.chunk) * bytes;
  return std::span(layer).subspan(first, std::min(bytes, layer.size() - first));
}

inline std::vector<ChunkAddress> addresses(const Program& program, std::int64_t per_chunk) {
  const std::int64_t chunks = (program.header.plan.rotary.lines_per_revolution + per_chunk - 1) / per_chunk;
  std::vector<ChunkAddress> all;
  for (std::int64_t layer = 0; layer < static_cast<std::int64_t>(program.layers.size()); ++layer) {
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
      all.push_back({layer, chunk});
    }
  }
  return all;
}

inline Result<void> put_all(LineSink& sink, const Program& program) {
  for (const ChunkAddress address : addresses(program, sink.lines_per_chunk())) {
    GRAVURE_TRY(const StoredChunk chunk, sink.encode(address, lines_of(program, address, sink.lines_per_chunk())));
    GRAVURE_CHECK(sink.put(chunk));
  }
  return {};
}

inline Result<void> write_program(const std::string& path, const Program& program, const GrvOptions& options) {
  GRAVURE_TRY(const auto sink, start(path, program, options));
  GRAVURE_CHECK(put_all(*sink, program));
  return sink->finish(program.header);
}

/// All bits of an open program, layer after layer, or the first error.
inline Result<std::vector<Bytes>> read_bits(LineSource& source) {
  const ProgramHeader& header = source.header();
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  std::vector<Bytes> layers;
  for (std::int64_t layer = 0; layer < static_cast<std::int64_t>(header.layers.size()); ++layer) {
    Bytes bits(static_cast<std::size_t>(lines * header.line_bytes()));
    for (std::int64_t first = 0; first < lines; first += source.lines_per_chunk()) {
      const std::int64_t count = std::min(source.lines_per_chunk(), lines - first);
      GRAVURE_TRY(const StoredChunk chunk, source.fetch({layer, first / source.lines_per_chunk()}));
      GRAVURE_CHECK(
          source.decode(chunk, std::span(bits).subspan(static_cast<std::size_t>(first * header.line_bytes()),
                                                       static_cast<std::size_t>(count * header.line_bytes()))));
    }
    layers.push_back(std::move(bits));
  }
  return layers;
}

inline void expect_ok(const Result<void>& result) {
  EXPECT_TRUE(result) << (result ? "" : result.error().message);
}

}  // namespace gravure::grv_test
