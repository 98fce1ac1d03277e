#include <gtest/gtest.h>
#include <malloc.h>
#include <tiffio.h>

#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "gravure/core/units.hpp"
#include "gravure/formats/image_files.hpp"
#include "naive_compile.hpp"
#include "temp_folder.hpp"
#include "tiff_maker.hpp"

/// What a compile of real files takes at its peak, as the system counts it: whatever libtiff and OpenImageIO hold is in
/// it.
namespace gravure::test {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

/// A line of /proc/self/status in bytes.
std::int64_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(name + ":", 0) == 0) {
      return std::stoll(line.substr(name.size() + 1)) * 1024;
    }
  }
  return -1;
}

/// From here on VmHWM is the peak of what follows. False where the system does not allow it.
bool restart_peak() {
  std::ofstream clear("/proc/self/clear_refs");
  clear << "5" << std::flush;
  return static_cast<bool>(clear);
}

struct Picture {
  std::uint16_t codec = kNone;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint16_t bits = 1;
  std::uint32_t tile = 0;  ///< 0: all rows in one strip
  bool noise = false;
};

/// Cells of changing size, or noise. Returns how many pixels are white (the upper half of what a sample can be).
std::int64_t fill(const Picture& picture, std::uint32_t row, std::vector<std::byte>& out) {
  std::int64_t white = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint64_t cell = ((i >> 5U) + (row >> 7U)) & 1U;
    const std::uint64_t edge = i % 512 == row % 512 ? 0x3CU : 0U;
    out[i] = static_cast<std::byte>(picture.noise ? mixed(1, row, static_cast<std::int64_t>(i))
                                                  : (cell != 0 ? 0xFFU : 0U) ^ edge);
    if (picture.bits == 1) {
      white += std::popcount(std::to_integer<unsigned>(out[i]));
    } else if (i % 2 == 1) {
      white += std::to_integer<unsigned>(out[i]) >= 0x80U ? 1 : 0;
    }
  }
  return white;
}

/// Writes the picture with libtiff itself; returns its white pixels.
std::int64_t write_picture(const std::string& path, const Picture& picture) {
  TIFF* const tiff = TIFFOpen(path.c_str(), "w8");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, picture.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, picture.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, picture.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, picture.codec);
  std::int64_t white = 0;
  if (picture.tile != 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, picture.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, picture.tile);
    std::vector<std::byte> tile(static_cast<std::size_t>(TIFFTileSize(tiff)));
    for (std::uint32_t i = 0; i < TIFFNumberOfTiles(tiff); ++i) {
      white += fill(picture, i, tile);
      TIFFWriteEncodedTile(tiff, i, tile.data(), static_cast<tmsize_t>(tile.size()));
    }
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, picture.height);
    std::vector<std::byte> row(static_cast<std::size_t>(picture.width) * picture.bits / 8);
    for (std::uint32_t y = 0; y < picture.height; ++y) {
      white += fill(picture, y, row);
      TIFFWriteScanline(tiff, row.data(), y, 0);
    }
  }
  TIFFClose(tiff);
  return white;
}

struct Outcome {
  Result<ProgramHeader> result = Error{ErrorCode::bad_argument, "not run"};
  std::int64_t peak_bytes = 0;
};

/// Two layers of the same picture, two workers, nothing kept of the program.
Outcome compile_file(const std::string& path, const Picture& picture, LinesAlong along, std::int64_t memory) {
  const ImageFiles files;
  LayerStack stack;
  stack.layers = {{path, 0, 0}, {path, 0, 0}};
  stack.lines_along = along;
  stack.lines = along == LinesAlong::rows ? picture.height : picture.width;
  stack.pixels = along == LinesAlong::rows ? picture.width : picture.height;
  stack.threshold = picture.bits == 1 ? std::optional<std::int64_t>() : 0x8000;
  learn_images(stack, files);
  const ProgramHeader header = header_for(stack, true);
  MemoryProgram program;
  program.lines_per_chunk = std::max<std::int64_t>(1, kMiB / header.line_bytes());
  MemorySink sink(program);
  sink.keep = false;
  ::malloc_trim(0);  // what was freed before is not to be had for nothing
  const std::int64_t before = status_bytes("VmRSS");
  EXPECT_TRUE(restart_peak());
  Outcome outcome;
  outcome.result = compile(header, stack, files, sink, {.memory_bytes = memory, .threads = 2});
  outcome.peak_bytes = status_bytes("VmHWM") - before;
  return outcome;
}

class CompileFilesMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) {
      GTEST_SKIP() << "a sanitizer's own memory hides what is measured";
    }
    if (!restart_peak() || status_bytes("VmHWM") < 0) {
      GTEST_SKIP() << "/proc/self/clear_refs cannot be written: no peak to measure";
    }
  }

  void expect_within(const Picture& picture, LinesAlong along, std::int64_t memory) {
    SCOPED_TRACE(testing::Message() << "codec " << picture.codec << ", " << picture.bits << " bits, tile "
                                    << picture.tile << (along == LinesAlong::rows ? ", rows" : ", columns"));
    const std::string path = folder_ / "a.tif";
    const std::int64_t white = write_picture(path, picture);
    const Outcome outcome = compile_file(path, picture, along, memory);
    ASSERT_TRUE(outcome.result) << outcome.result.error().message;
    EXPECT_EQ(outcome.result.value().layers[0].fired_pixels, white);
    EXPECT_EQ(outcome.result.value().layers[1].fired_pixels, white);
    EXPECT_LE(outcome.peak_bytes, memory);
    std::printf("codec %5d, %2d bits, tile %3u, %-7s: budget %3lld MiB, peak %5.1f MiB\n", picture.codec, picture.bits,
                picture.tile, along == LinesAlong::rows ? "rows" : "columns", static_cast<long long>(memory / kMiB),
                static_cast<double>(outcome.peak_bytes) / static_cast<double>(kMiB));
  }

  TempFolder folder_;
};

TEST_F(CompileFilesMemory, OfBilevelPicturesInOneStripStaysWithinTheBudget) {
  for (const std::uint16_t codec : {kNone, kPackBits, kLzw, kDeflate, kG4}) {
    const Picture picture{codec, 32768, 16384};  // 64 MiB of bits
    expect_within(picture, LinesAlong::rows, 28 * kMiB);
    expect_within(picture, LinesAlong::columns, 48 * kMiB);
  }
}

TEST_F(CompileFilesMemory, OfTilesStaysWithinTheBudget) {
  const Picture picture{kLzw, 32768, 16384, 1, 256};
  expect_within(picture, LinesAlong::rows, 28 * kMiB);
  expect_within(picture, LinesAlong::columns, 48 * kMiB);
}

TEST_F(CompileFilesMemory, OfPicturesInOneStripThatCannotBeStreamedIsRefusedWithTheNeed) {
  const Picture picture{kLzw, 16384, 16384, 1, 0, true};  // 44 MiB as stored
  const std::string path = folder_ / "a.tif";
  const std::int64_t white = write_picture(path, picture);
  const Outcome refused = compile_file(path, picture, LinesAlong::rows, 28 * kMiB);
  ASSERT_FALSE(refused.result);
  EXPECT_EQ(refused.result.error().code, ErrorCode::out_of_range);
  EXPECT_NE(refused.result.error().message.find("tiffcp -s -r 64"), std::string::npos)
      << refused.result.error().message;
  const Outcome done = compile_file(path, picture, LinesAlong::rows, 64 * kMiB);
  ASSERT_TRUE(done.result) << done.result.error().message;
  EXPECT_EQ(done.result.value().layers[1].fired_pixels, white);
  EXPECT_LE(done.peak_bytes, 64 * kMiB) << "one worker, since two do not fit";
  EXPECT_GT(done.peak_bytes, 40 * kMiB) << "the meter does not run";
}

#if defined(GRAVURE_TEST_IMPORT)
TEST_F(CompileFilesMemory, OfGreyPicturesStaysWithinTheBudget) {
  // The libraries behind the import module are there before anything is counted.
  write_picture(folder_ / "a.tif", {kNone, 64, 64, 16});
  ASSERT_TRUE(compile_file(folder_ / "a.tif", {kNone, 64, 64, 16}, LinesAlong::rows, 256 * kMiB).result);
  for (const std::uint16_t codec : {kNone, kLzw, kDeflate}) {
    const Picture strip{codec, 8192, 4096, 16};  // 64 MiB of samples
    expect_within(strip, LinesAlong::rows, 56 * kMiB);
    expect_within(strip, LinesAlong::columns, 56 * kMiB);
  }
  expect_within({kDeflate, 8192, 4096, 16, 256}, LinesAlong::rows, 56 * kMiB);
}
#endif

}  // namespace
}  // namespace gravure::test
