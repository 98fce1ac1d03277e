// Compiling and verifying 96-megapixel layers (rows, columns, and 100 slices of a 16-bit map) against a bare libtiff
// decode of the same file, in one run, one thread, CPU time. docs/benchmarks.md has the method. Arguments are Google
// Benchmark's; the defaults interleave 7 repetitions.
#include <benchmark/benchmark.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench_case.hpp"
#include "gravure/emulator/emulated_device.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/twin/verify.hpp"

namespace {

namespace fs = std::filesystem;
using namespace gravure;
using namespace gravure::bench;

constexpr std::int64_t kWidth = 3500;
constexpr std::int64_t kHeight = 27489;
constexpr std::int64_t kRowBytes = (kWidth + 7) / 8;

/// Hexagonal walls, about 110 transitions a line: what a thresholded honeycomb looks like.
std::vector<std::byte> honeycomb() {
  std::vector<std::byte> bits(static_cast<std::size_t>(kRowBytes * kHeight));
  for (std::int64_t y = 0; y < kHeight; ++y) {
    for (std::int64_t x = 0; x < kWidth; ++x) {
      constexpr double kPitch = 61.37;
      const double a = static_cast<double>(x) / kPitch * 2 * M_PI;
      const double b = static_cast<double>(y) / kPitch * 2 * M_PI / std::sqrt(3.0);
      if (std::cos(a) * std::cos(b) + 0.5 * std::cos(2 * b) > 0.1) {
        bits[static_cast<std::size_t>(y * kRowBytes + x / 8)] |= static_cast<std::byte>(0x80U >> (x % 8));
      }
    }
  }
  return bits;
}

/// The same brightness as noise: about half of all neighbours differ. No codec likes it.
std::vector<std::byte> noise() {
  std::vector<std::byte> bits(static_cast<std::size_t>(kRowBytes * kHeight));
  std::uint64_t state = 1;
  for (std::byte& byte : bits) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    byte = static_cast<std::byte>(state >> 56U);
  }
  return bits;
}

/// The same walls as depths of 16 bits, with floors that lean: what a roller is sliced from.
std::vector<std::uint16_t> depths(std::int64_t y) {
  std::vector<std::uint16_t> row(static_cast<std::size_t>(kWidth));
  for (std::int64_t x = 0; x < kWidth; ++x) {
    constexpr double kPitch = 61.37;
    const double a = static_cast<double>(x) / kPitch * 2 * M_PI;
    const double b = static_cast<double>(y) / kPitch * 2 * M_PI / std::sqrt(3.0);
    const double wall = std::cos(a) * std::cos(b) + 0.5 * std::cos(2 * b);
    const double lean = 0.2 * static_cast<double>(x % 61) / 61;
    row[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(65535 * std::clamp(0.3 - wall + lean, 0.0, 1.0));
  }
  return row;
}

constexpr std::int64_t kMapLevels = 100;

void write_map(const std::string& path) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(kWidth));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(kHeight));
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 64);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  for (std::int64_t y = 0; y < kHeight; ++y) {
    std::vector<std::uint16_t> row = depths(y);
    if (TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y)) != 1) {
      std::fprintf(stderr, "%s: cannot write\n", path.c_str());
      std::exit(1);
    }
  }
  TIFFClose(tiff);
}

std::vector<Picture> write_pictures(const fs::path& folder) {
  const std::map<std::string, TiffCompression> codecs = {{"none", TiffCompression::none},
                                                         {"PackBits", TiffCompression::packbits},
                                                         {"LZW", TiffCompression::lzw},
                                                         {"Deflate", TiffCompression::deflate},
                                                         {"G4", TiffCompression::g4}};
  std::vector<Picture> pictures;
  const std::map<std::string, std::vector<std::byte>> kinds = {{"honeycomb", honeycomb()}, {"noise", noise()}};
  for (const auto& [kind, bits] : kinds) {
    for (const auto& [codec, compression] : codecs) {
      BilevelTiffPage page;
      page.width = kWidth;
      page.height = kHeight;
      page.compression = compression;
      const std::string path = (folder / (kind + "_" + codec + ".tif")).string();
      BilevelTiffWriter writer = must(BilevelTiffWriter::create(path, page));
      must(writer.append_rows(bits));
      must(writer.commit());
      pictures.push_back({kind + "/" + codec, path, kWidth, kHeight});
    }
  }
  pictures.push_back({"columns/none", (folder / "honeycomb_none.tif").string(), kWidth, kHeight, LinesAlong::columns});
  pictures.push_back({"columns/G4", (folder / "honeycomb_G4.tif").string(), kWidth, kHeight, LinesAlong::columns});
  pictures.push_back({"map of 100/Deflate", (folder / "map.tif").string(), kWidth, kHeight, LinesAlong::rows,
                      SampleType::u16, kMapLevels});
  write_map(pictures.back().path);
  return pictures;
}

void decode(benchmark::State& state, const std::string& path) {
  std::vector<std::byte> buffer;
  for (auto unused : state) {
    TIFF* tiff = TIFFOpen(path.c_str(), "rm");
    buffer.resize(static_cast<std::size_t>(TIFFStripSize(tiff)));
    for (std::uint32_t strip = 0; strip < TIFFNumberOfStrips(tiff); ++strip) {
      benchmark::DoNotOptimize(TIFFReadEncodedStrip(tiff, strip, buffer.data(), TIFFStripSize(tiff)));
    }
    TIFFClose(tiff);
  }
}

void compile_only(benchmark::State& state, const Picture& picture) {
  const ImageFiles files;
  CompileOptions options;
  options.threads = 1;
  for (auto unused : state) {
    Case made = case_of(picture);
    NullSink sink(picture.line_bytes());
    must(compile(std::move(made.header), made.stack, files, sink, options));
  }
}

void compile_write(benchmark::State& state, const Picture& picture, const std::string& output,
                   GrvOptions::Compression compression) {
  const ImageFiles files;
  CompileOptions options;
  options.threads = 1;
  GrvOptions grv;
  grv.compression = compression;
  for (auto unused : state) {
    Case made = case_of(picture);
    const std::unique_ptr<LineSink> sink =
        must(create_grv(output, picture.layers(), picture.lines(), picture.line_bytes(), grv));
    must(compile(std::move(made.header), made.stack, files, *sink, options));
  }
}

void verify_program(benchmark::State& state, const Picture& picture, const std::string& output) {
  const ImageFiles files;
  const Case made = case_of(picture);
  VerifyOptions options;
  options.threads = 1;
  for (auto unused : state) {
    const VerifyReport report =
        must(verify([&] { return open_grv(output); },
                    [](PinObserver& pins) { return std::make_unique<emulator::EmulatedDevice>(&pins); },
                    [&]() -> Result<std::unique_ptr<LayerLines>> {
                      return std::unique_ptr<LayerLines>(std::make_unique<LayerReader>(made.stack, files, 0));
                    },
                    options));
    if (report.wrong_pixels != 0) {
      state.SkipWithError("the program does not show the picture");
    }
  }
}

/// Prints every median, and at the end each as a share of the bare decode.
class RatioReporter final : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.aggregate_name == "median") {
        const std::string& name = run.run_name.function_name;
        const std::size_t cut = name.rfind('/');
        ms_[name.substr(0, cut)][name.substr(cut + 1)] = run.GetAdjustedCPUTime();
      }
    }
  }
  void print_ratios() const {
    std::printf("\n%-20s %10s %12s %14s %14s %14s   CPU ms; in brackets decode / it\n", "picture", "decode", "compile",
                "+ write", "+ zstd, write", "verify");
    for (const auto& [picture, ms] : ms_) {
      std::printf("%-20s %10.1f", picture.c_str(), ms.at("decode"));
      for (const char* step : {"compile", "write", "zstd", "verify"}) {
        std::printf(" %7.1f [%.2f]", ms.at(step), ms.at("decode") / ms.at(step));
      }
      std::printf("\n");
    }
  }

 private:
  std::map<std::string, std::map<std::string, double>> ms_;
};

}  // namespace

int main(int argc, char** argv) {
  const fs::path folder = fs::temp_directory_path() / "gravure-compile-bench";
  fs::create_directories(folder);
  int packed_programs = 0;
  for (const Picture& picture : write_pictures(folder)) {
    const std::string path = picture.path;
    const std::string raw = (folder / "raw.grv").string();
    const std::string packed = (folder / (std::to_string(packed_programs++) + ".grv")).string();
    const auto add = [&](const std::string& step, auto function) {
      benchmark::RegisterBenchmark((picture.name + "/" + step).c_str(), function)->Unit(benchmark::kMillisecond);
    };
    {  // verify needs it whichever order the benchmarks run in
      Case made = case_of(picture);
      const ImageFiles files;
      const std::unique_ptr<LineSink> sink =
          must(create_grv(packed, picture.layers(), picture.lines(), picture.line_bytes()));
      must(compile(std::move(made.header), made.stack, files, *sink, {}));
    }
    add("decode", [path](benchmark::State& state) { decode(state, path); });
    add("compile", [picture](benchmark::State& state) { compile_only(state, picture); });
    add("write",
        [picture, raw](benchmark::State& state) { compile_write(state, picture, raw, GrvOptions::Compression::none); });
    add("zstd",
        [picture, raw](benchmark::State& state) { compile_write(state, picture, raw, GrvOptions::Compression::zstd); });
    add("verify", [picture, packed](benchmark::State& state) { verify_program(state, picture, packed); });
  }
  std::vector<char*> arguments(argv, argv + argc);
  std::string defaults[] = {"--benchmark_repetitions=7", "--benchmark_enable_random_interleaving=true",
                            "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.05"};
  for (std::string& option : defaults) {
    arguments.insert(arguments.begin() + 1, option.data());
  }
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print_ratios();
  fs::remove_all(folder);
  return 0;
}
