#include <benchmark/benchmark.h>

#include <cstring>
#include <ctime>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "gravure/raster/kernels.hpp"

/// Each kernel of each instruction set in Gpx/s (slicing: pixels x layers), and memcpy and pure reading of the bytes it
/// reads, measured in turn in the same loop: `of_memcpy` and `of_read` are the figures to compare between machines, 1
/// being as fast. Times are CPU times of the thread.
namespace gravure::raster {
namespace {

constexpr std::int64_t kLayerWidth = 3500;
constexpr std::int64_t kLayerRows = 27489;

using Bytes = std::vector<std::byte>;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Runs of ones and zeros of `mean_run` bits on average: honeycomb cells have about 32, dither about 2.
Bytes picture(std::int64_t bytes, unsigned mean_run) {
  std::mt19937 rng(1);
  Bytes out(static_cast<std::size_t>(bytes));
  bool one = false;
  for (std::byte& byte : out) {
    unsigned value = 0;
    for (int bit = 0; bit < 8; ++bit) {
      one = rng() % mean_run == 0 ? !one : one;
      value = value << 1 | (one ? 1u : 0u);
    }
    byte = static_cast<std::byte>(value);
  }
  return out;
}

template <class Sample>
std::vector<Sample> depth_map(std::int64_t count) {
  std::mt19937 rng(1);
  std::vector<Sample> out(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<Sample>(rng());
  }
  return out;
}

/// What reading alone takes: a sum over the words (a rest below 512 bytes is left out) in registers as wide as there
/// are, eight sums at a time, so that memory sets the pace and not the additions.
#if defined(__x86_64__)
[[gnu::target_clones("default", "avx2", "avx512f")]]
#endif
std::uint64_t
sum_of(const void* from, std::int64_t bytes) {
  using Words = std::uint64_t __attribute__((vector_size(64)));
  constexpr std::int64_t kChains = 8;
  const auto* at = static_cast<const unsigned char*>(from);
  Words sums[kChains] = {};
  for (std::int64_t i = 0; i + kChains * 64 <= bytes; i += kChains * 64) {
    for (std::int64_t chain = 0; chain < kChains; ++chain) {
      Words words;
      std::memcpy(&words, at + i + chain * 64, sizeof words);
      sums[chain] += words;
    }
  }
  std::uint64_t sum = 0;
  for (const Words& words : sums) {
    for (int i = 0; i < 8; ++i) {
      sum += words[i];
    }
  }
  return sum;
}

/// Times `kernel`, a copy of `bytes` at `from` and reading them in turn.
template <class Kernel>
void compare(benchmark::State& state, double pixels, const void* from, std::int64_t bytes, Kernel kernel) {
  Bytes copy(static_cast<std::size_t>(bytes));
  std::memcpy(copy.data(), from, copy.size());
  kernel();
  double kernel_s = 0;
  double memcpy_s = 0;
  double read_s = 0;
  for ([[maybe_unused]] auto _ : state) {
    const double start = cpu_seconds();
    kernel();
    const double middle = cpu_seconds();
    std::memcpy(copy.data(), from, copy.size());
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
    const double copied = cpu_seconds();
    benchmark::DoNotOptimize(sum_of(from, bytes));
    const double end = cpu_seconds();
    state.SetIterationTime(middle - start);
    kernel_s += middle - start;
    memcpy_s += copied - middle;
    read_s += end - copied;
  }
  const double total = pixels * static_cast<double>(state.iterations()) * 1e-9;
  state.counters["Gpx_s"] = total / kernel_s;
  state.counters["memcpy_Gpx_s"] = total / memcpy_s;
  state.counters["of_memcpy"] = memcpy_s / kernel_s;
  state.counters["of_read"] = read_s / kernel_s;
  state.counters["read_GB_s"] = static_cast<double>(bytes) * static_cast<double>(state.iterations()) * 1e-9 / read_s;
}

double product(std::int64_t a, std::int64_t b) {
  return static_cast<double>(a) * static_cast<double>(b);
}

void place(benchmark::State& state, const Kernels& kernels, std::int64_t width, std::int64_t rows, RowOptions options) {
  const Bytes src = picture(rows * packed_bytes(width), 32);
  Bytes dst(src.size());
  compare(state, product(width, rows), src.data(), static_cast<std::int64_t>(src.size()),
          [&] { kernels.place_rows(dst, src, width, rows, options); });
}

/// 3500 pixels, each line shifted to its place between 250 + 250 dark ones, odd lines mirrored.
void pad(benchmark::State& state, const Kernels& kernels, std::int64_t) {
  const std::int64_t in = packed_bytes(kLayerWidth);
  const std::int64_t out = packed_bytes(kLayerWidth + 500);
  const Bytes src = picture(kLayerRows * in, 32);
  Bytes dst(static_cast<std::size_t>(kLayerRows * out));
  compare(state, product(kLayerWidth, kLayerRows), src.data(), static_cast<std::int64_t>(src.size()), [&] {
    for (std::int64_t row = 0; row < kLayerRows; ++row) {
      kernels.place_line(std::span(dst).subspan(static_cast<std::size_t>(row * out), static_cast<std::size_t>(out)),
                         250, std::span(src).subspan(static_cast<std::size_t>(row * in)), 0, kLayerWidth,
                         {.mirror = row % 2 == 1});
    }
  });
}

/// Lines of 3500 pixels put together of stretches of `width`, each from another bit of a line of its own: a band or a
/// pass shows one stretch, a helical line one of every layer, here beside each other in what is read.
void window(benchmark::State& state, const Kernels& kernels, std::int64_t width, bool invert) {
  const std::int64_t stretches = kLayerWidth / width;
  const std::int64_t in = packed_bytes(width + 7);
  const std::int64_t out = packed_bytes(stretches * width);
  const Bytes src = picture(kLayerRows * stretches * in, 32);
  Bytes dst(static_cast<std::size_t>(kLayerRows * out));
  compare(state, product(stretches * width, kLayerRows), src.data(), static_cast<std::int64_t>(dst.size()), [&] {
    for (std::int64_t row = 0; row < kLayerRows; ++row) {
      const std::span<std::byte> line =
          std::span(dst).subspan(static_cast<std::size_t>(row * out), static_cast<std::size_t>(out));
      for (std::int64_t i = 0; i < stretches; ++i) {
        kernels.place_line(line, i * width,
                           std::span(src).subspan(static_cast<std::size_t>((row * stretches + i) * in)), (row + i) % 8,
                           width, {.invert = invert});
      }
    }
  });
}

void count(benchmark::State& state, const Kernels& kernels, std::int64_t kind) {
  const Bytes a = picture(kLayerRows * packed_bytes(kLayerWidth), 32);
  const Bytes b = a;
  compare(state, product(8, static_cast<std::int64_t>(a.size())), a.data(), static_cast<std::int64_t>(a.size()), [&] {
    benchmark::DoNotOptimize(kind == 0   ? kernels.popcount(a)
                             : kind == 1 ? kernels.first_difference(a, b)
                                         : kernels.count_differences(a, b));
  });
}

template <class Sample>
void threshold(benchmark::State& state, const Kernels& kernels, std::int64_t width, std::int64_t rows) {
  const std::vector<Sample> src = depth_map<Sample>(width * rows);
  Bytes dst(static_cast<std::size_t>(rows * packed_bytes(width)));
  compare(state, product(width, rows), src.data(), static_cast<std::int64_t>(src.size() * sizeof(Sample)), [&] {
    if constexpr (sizeof(Sample) == 1) {
      kernels.threshold_u8(dst, src, width, rows, 128, Where::at_least);
    } else if constexpr (sizeof(Sample) == 2) {
      kernels.threshold_u16(dst, src, width, rows, 32768, Where::at_least);
    } else {
      kernels.threshold_f32(dst, src, width, rows, 1e9f, Where::at_least);
    }
  });
}

/// One hundred layers of `rows` lines; memcpy copies the bytes of all layers.
template <class Sample>
void slice(benchmark::State& state, const Kernels& kernels, std::int64_t rows) {
  const std::vector<Sample> src = depth_map<Sample>(kLayerWidth * rows);
  const SliceRange range{.levels = 100, .vmin = 0, .vmax = std::numeric_limits<Sample>::max()};
  const std::int64_t plane = rows * packed_bytes(kLayerWidth);
  Bytes dst(static_cast<std::size_t>(100 * plane));
  const Bytes all(dst.size());
  std::vector<std::span<std::byte>> layers;
  for (std::int64_t k = 0; k < 100; ++k) {
    layers.push_back(std::span(dst).subspan(static_cast<std::size_t>(k * plane), static_cast<std::size_t>(plane)));
  }
  compare(state, product(100 * kLayerWidth, rows), all.data(), 100 * plane, [&] {
    if constexpr (sizeof(Sample) == 1) {
      kernels.slice_u8(layers, 0, src, kLayerWidth, rows, range);
    } else {
      kernels.slice_u16(layers, 0, src, kLayerWidth, rows, range);
    }
  });
}

void transpose(benchmark::State& state, const Kernels& kernels, std::int64_t rows, std::int64_t cols) {
  const Bytes src = picture(rows * packed_bytes(cols), 32);
  Bytes dst(static_cast<std::size_t>(cols * packed_bytes(rows)));
  compare(state, product(rows, cols), src.data(), static_cast<std::int64_t>(src.size()),
          [&] { kernels.transpose(dst, src, rows, cols); });
}

void runs(benchmark::State& state, const Kernels& kernels, unsigned mean_run) {
  const std::int64_t stride = packed_bytes(kLayerWidth);
  const Bytes src = picture(kLayerRows * stride, mean_run);
  std::vector<std::uint32_t> edges;
  compare(state, product(kLayerWidth, kLayerRows), src.data(), static_cast<std::int64_t>(src.size()), [&] {
    for (std::int64_t row = 0; row < kLayerRows; ++row) {
      edges.clear();
      kernels.append_runs(std::span(src).subspan(static_cast<std::size_t>(row * stride)), kLayerWidth, edges);
    }
  });
}

template <class Function, class... Arguments>
void add(const Kernels& kernels, const std::string& name, Function function, Arguments... arguments) {
  const std::string full = name + "/" + std::string(isa_name(kernels.isa));
  benchmark::RegisterBenchmark(full.c_str(), [=, &kernels](benchmark::State& state) {
    function(state, kernels, arguments...);
  })->UseManualTime();
}

void add_all(const Kernels& kernels) {
  add(kernels, "place_rows/3500/straight", place, kLayerWidth, kLayerRows, RowOptions{});
  add(kernels, "place_rows/3500/alternating", place, kLayerWidth, kLayerRows, RowOptions{.alternate = true});
  add(kernels, "place_rows/3500/mirrored", place, kLayerWidth, kLayerRows, RowOptions{.first_mirrored = true});
  add(kernels, "place_rows/27489/alternating", place, kLayerRows, kLayerWidth, RowOptions{.alternate = true});
  add(kernels, "place_line/3500+500/alternating", pad, 0);
  add(kernels, "place_line/window/3500", window, kLayerWidth, false);
  add(kernels, "place_line/window/3500/inverted", window, kLayerWidth, true);
  add(kernels, "place_line/window/100x35", window, std::int64_t{35}, false);
  add(kernels, "popcount", count, 0);
  add(kernels, "first_difference", count, 1);
  add(kernels, "count_differences", count, 2);
  add(kernels, "threshold_u8/memory", threshold<std::uint8_t>, kLayerWidth, kLayerRows);
  add(kernels, "threshold_u16/memory", threshold<std::uint16_t>, kLayerWidth, kLayerRows);
  add(kernels, "threshold_f32/memory", threshold<float>, kLayerWidth, kLayerRows);
  add(kernels, "threshold_u8/cache", threshold<std::uint8_t>, kLayerWidth, std::int64_t{64});
  add(kernels, "slice_u8/100_layers/64_lines", slice<std::uint8_t>, std::int64_t{64});
  add(kernels, "slice_u8/100_layers/memory", slice<std::uint8_t>, std::int64_t{4096});
  add(kernels, "slice_u16/100_layers/64_lines", slice<std::uint16_t>, std::int64_t{64});
  add(kernels, "slice_u16/100_layers/memory", slice<std::uint16_t>, std::int64_t{4096});
  add(kernels, "transpose/27489x3500", transpose, kLayerRows, kLayerWidth);
  add(kernels, "transpose/3500x27489", transpose, kLayerWidth, kLayerRows);
  add(kernels, "transpose/28160x3584", transpose, std::int64_t{28160}, std::int64_t{3584});
  add(kernels, "transpose/512x512", transpose, std::int64_t{512}, std::int64_t{512});
  add(kernels, "runs/mean_32", runs, 32u);
  add(kernels, "runs/mean_2", runs, 2u);
}

}  // namespace
}  // namespace gravure::raster

int main(int argc, char** argv) {
  using gravure::raster::Isa;
  for (const Isa isa : {Isa::portable, Isa::avx2, Isa::avx512}) {
    if (const gravure::raster::Kernels* kernels = gravure::raster::kernels_for(isa)) {
      gravure::raster::add_all(*kernels);
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
