// One step of the table that tests/bench/run prints, in a process of its own, so that its peak of memory is its own:
//   gravure_table_step pictures FOLDER                 writes the pictures and prints their names
//   gravure_table_step STEP FILE WORK SECONDS          repeats a step after a warm-up; prints CPU ms of one, peak MiB,
//   wall ms of one gravure_table_step slices FILE OUT                 slices of a map in memory; the lines of all of
//   them go to OUT gravure_table_step growth GPX sparse|dense rows|columns    a generated picture through the compiler
//   gravure_table_step roller FILE                     a BigTIFF of 188,496 x 200,000 pixels, one metre of a roller
//   gravure_table_step bits FILE OUT                   the lines of a program, or the rows of a bilevel TIFF, as they
//   are
// docs/benchmarks.md has the method.
#include <fcntl.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <string>

#include "bench_case.hpp"
#include "gravure/core/file_output.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"

namespace {

namespace fs = std::filesystem;
using namespace gravure;
using namespace gravure::bench;
using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kWidth = 3500;
constexpr std::uint32_t kHeight = 27489;
constexpr std::size_t kRowBytes = (kWidth + 7) / 8;
constexpr std::int64_t kSlices = 10;
constexpr std::int64_t kStack = 10;

[[noreturn]] void stop(const std::string& why) {
  std::cerr << why << "\n";
  std::exit(1);
}

// ---- pictures

enum class Kind : std::uint8_t { sparse, dense, screened };

/// 0 to 1: floors, walls and what lies between them of hexagonal cells.
double cell(double x, double y) {
  constexpr double kPitch = 61.37;
  const double a = x / kPitch * 2 * M_PI;
  const double b = y / kPitch * 2 * M_PI / std::sqrt(3.0);
  return (std::cos(a) * std::cos(b) + 0.5 * std::cos(2 * b) + 0.75) / 2.25;
}

std::uint32_t noise(std::uint32_t x, std::uint32_t y) {
  std::uint32_t v = x * 0x9E3779B1U ^ y * 0x85EBCA77U;
  v ^= v >> 15U;
  v *= 0x2C1B3C6DU;
  return v ^ v >> 12U;
}

/// sparse: struts of a stent; dense: the walls of the cells; screened: the cells as a scattered dither.
Bytes draw(Kind kind) {
  Bytes bits(kRowBytes * kHeight);
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const double strut = std::fabs(std::remainder(x - 40 * std::sin(y / 90.0), 140.0));
      const bool one = kind == Kind::sparse  ? strut < 6
                       : kind == Kind::dense ? cell(x, y) > 0.38
                                             : cell(x, y) * 65536 > (noise(x, y) & 0xFFFFU);
      if (one) {
        bits[y * kRowBytes + x / 8] |= static_cast<std::byte>(0x80U >> (x % 8));
      }
    }
  }
  return bits;
}

struct Form {
  const char* name;
  int compression;
  std::uint32_t rows_per_strip = 64;
  bool tiles = false;
  const char* mode = "w";
};

void set_common(TIFF* tiff, const Form& form, int bits) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWidth);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, form.compression);
}

constexpr std::uint32_t kTile = 256;

void write_tiled(TIFF* tiff, const Bytes& bits) {
  TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kTile);
  TIFFSetField(tiff, TIFFTAG_TILELENGTH, kTile);
  Bytes tile(kTile / 8 * kTile);
  for (std::uint32_t y = 0; y < kHeight; y += kTile) {
    for (std::uint32_t x = 0; x < kWidth; x += kTile) {
      std::fill(tile.begin(), tile.end(), std::byte{0});
      for (std::uint32_t row = 0; row < std::min(kTile, kHeight - y); ++row) {
        const std::size_t bytes = std::min<std::size_t>(kTile / 8, kRowBytes - x / 8);
        std::memcpy(&tile[row * kTile / 8], &bits[(y + row) * kRowBytes + x / 8], bytes);
      }
      TIFFWriteTile(tiff, tile.data(), x, y, 0, 0);
    }
  }
}

void write_bits(const std::string& path, const Form& form, Bytes bits) {
  TIFF* tiff = TIFFOpen(path.c_str(), form.mode);
  set_common(tiff, form, 1);
  if (form.tiles) {
    write_tiled(tiff, bits);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, form.rows_per_strip);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      TIFFWriteScanline(tiff, &bits[y * kRowBytes], y);
    }
  }
  TIFFClose(tiff);
}

/// The walls of the cells again and again across and around a roller of 300 mm, one metre wide, at 5 um.
void write_roller(const std::string& path) {
  constexpr std::uint32_t kAcross = 200'000;
  constexpr std::uint32_t kAround = 188'496;
  constexpr std::uint32_t kRows = 64;
  constexpr std::size_t kBytes = kAcross / 8;
  constexpr std::size_t kWhole = kWidth / 8;  // of a row of the cells
  const Bytes cells = draw(Kind::dense);
  TIFF* tiff = TIFFOpen(path.c_str(), "w8");
  if (tiff == nullptr) {
    stop(path + ": cannot write");
  }
  set_common(tiff, {"none", COMPRESSION_NONE}, 1);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kAcross);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kAround);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kRows);
  Bytes strip(kBytes * kRows);
  for (std::uint32_t y = 0; y < kAround; y += kRows) {
    const std::uint32_t rows = std::min(kRows, kAround - y);
    for (std::uint32_t row = 0; row < rows; ++row) {
      const std::byte* from = &cells[(y + row) % kHeight * kRowBytes];
      for (std::size_t at = 0; at < kBytes; at += kWhole) {
        std::memcpy(&strip[row * kBytes + at], from, std::min(kWhole, kBytes - at));
      }
    }
    if (TIFFWriteEncodedStrip(tiff, y / kRows, strip.data(), static_cast<tmsize_t>(rows * kBytes)) < 0) {
      stop(path + ": cannot write");
    }
  }
  TIFFClose(tiff);
}

template <class Sample>
void write_grey(const std::string& path, const Form& form) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  set_common(tiff, form, 8 * sizeof(Sample));
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, form.rows_per_strip);
  constexpr double kMost = sizeof(Sample) == 1 ? 255 : 65535;
  std::vector<Sample> row(kWidth);
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      row[x] = static_cast<Sample>(kMost * std::min(1.0, std::max(0.0, cell(x, y))));
    }
    TIFFWriteScanline(tiff, row.data(), y);
  }
  TIFFClose(tiff);
}

/// Names are KIND_FORM.tif; the rest of this program and tests/bench/table know a file by its name, to which `.columns`
/// (lines along columns) or `.stack` (ten layers of it) may be added.
void write_pictures(const fs::path& folder) {
  const std::pair<const char*, Kind> kinds[] = {
      {"sparse", Kind::sparse}, {"dense", Kind::dense}, {"screened", Kind::screened}};
  const Form strips[] = {{"none", COMPRESSION_NONE},
                         {"packbits", COMPRESSION_PACKBITS},
                         {"lzw", COMPRESSION_LZW},
                         {"deflate", COMPRESSION_ADOBE_DEFLATE},
                         {"g4", COMPRESSION_CCITTFAX4}};
  const Form others[] = {{"none-tiles", COMPRESSION_NONE, 0, true},
                         {"deflate-tiles", COMPRESSION_ADOBE_DEFLATE, 0, true},
                         {"g4-tiles", COMPRESSION_CCITTFAX4, 0, true},
                         {"none-bigtiff", COMPRESSION_NONE, 64, false, "w8"},
                         {"lzw-onestrip", COMPRESSION_LZW, kHeight}};
  for (const auto& [name, kind] : kinds) {
    const Bytes bits = draw(kind);
    for (const Form& form : strips) {
      write_bits((folder / (std::string(name) + "_" + form.name + ".tif")).string(), form, bits);
    }
    for (const Form& form : others) {
      if (kind == Kind::dense) {
        write_bits((folder / (std::string(name) + "_" + form.name + ".tif")).string(), form, bits);
      }
    }
  }
  write_grey<std::uint8_t>((folder / "grey8_none.tif").string(), {"none", COMPRESSION_NONE});
  write_grey<std::uint8_t>((folder / "grey8_deflate.tif").string(), {"deflate", COMPRESSION_ADOBE_DEFLATE});
  write_grey<std::uint16_t>((folder / "grey16_deflate.tif").string(), {"deflate", COMPRESSION_ADOBE_DEFLATE});
}

Picture picture_of(const std::string& file) {
  const std::string suffix = fs::path(file).extension().string();
  const bool turned = suffix == ".columns";
  const bool stack = suffix == ".stack";
  Picture picture;
  picture.path = turned || stack ? file.substr(0, file.size() - suffix.size()) : file;
  picture.repeats = stack ? kStack : 1;
  picture.width = kWidth;
  picture.height = kHeight;
  picture.along = turned ? LinesAlong::columns : LinesAlong::rows;
  const std::string name = fs::path(file).filename().string();
  picture.samples = name.starts_with("grey16")  ? SampleType::u16
                    : name.starts_with("grey8") ? SampleType::u8
                                                : SampleType::bit;
  picture.levels = name.starts_with("grey16") ? kSlices : 0;
  return picture;
}

// ---- steps

using Pieces = std::function<void(std::span<const std::byte>)>;

/// What a bare loop over libtiff costs: the floor for every reader that goes through it.
void decode(const std::string& path, const Pieces& take) {
  TIFF* tiff = TIFFOpen(path.c_str(), "rm");
  if (tiff == nullptr) {
    stop(path + ": cannot open");
  }
  static Bytes buffer;
  std::uint32_t rows = 0;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &rows);
  const bool tiled = TIFFIsTiled(tiff) != 0;
  const bool one_strip = !tiled && rows >= kHeight;  // row by row: nobody wants it in memory whole
  const auto size = static_cast<std::size_t>(tiled       ? TIFFTileSize(tiff)
                                             : one_strip ? TIFFScanlineSize(tiff)
                                                         : TIFFStripSize(tiff));
  buffer.resize(size);
  const std::uint32_t count = tiled ? TIFFNumberOfTiles(tiff) : one_strip ? kHeight : TIFFNumberOfStrips(tiff);
  for (std::uint32_t i = 0; i < count; ++i) {
    tmsize_t got = static_cast<tmsize_t>(size);
    if (tiled) {
      got = TIFFReadEncodedTile(tiff, i, buffer.data(), got);
    } else if (one_strip) {
      TIFFReadScanline(tiff, buffer.data(), i);
    } else {
      got = TIFFReadEncodedStrip(tiff, i, buffer.data(), got);
    }
    benchmark::DoNotOptimize(buffer.data());
    take(std::span<const std::byte>(buffer).first(static_cast<std::size_t>(got)));
  }
  TIFFClose(tiff);
}

void decode_layers(const Picture& picture, const Pieces& take) {
  for (std::int64_t layer = 0; layer < picture.repeats; ++layer) {
    decode(picture.path, take);
  }
}

/// Our reader alone, asked for as many rows at a time as the loop above gets.
void read_layers(const Picture& picture) {
  static const ImageFiles files;
  constexpr std::int64_t kRows = 64;
  for (std::int64_t layer = 0; layer < picture.repeats; ++layer) {
    const std::unique_ptr<ImageSource> source = must(files.open(picture.path, 0));
    static Bytes buffer;
    buffer.resize(static_cast<std::size_t>(kRows * row_bytes(picture.samples, picture.width)));
    for (std::int64_t row = 0; row < picture.height; row += kRows) {
      const std::int64_t now = std::min(kRows, picture.height - row);
      const auto bytes = static_cast<std::size_t>(now * row_bytes(picture.samples, picture.width));
      must(source->read_rows(row, now, std::span(buffer).first(bytes)));
      benchmark::DoNotOptimize(buffer.data());
    }
  }
}

/// Rewrites a file whose pages are there already: the least that storing bits can cost.
class Rewriter {
 public:
  explicit Rewriter(const std::string& path) : fd_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {}
  Rewriter(const Rewriter&) = delete;
  Rewriter& operator=(const Rewriter&) = delete;
  ~Rewriter() { ::close(fd_); }
  void put(std::span<const std::byte> bytes) {
    if (::write(fd_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      stop("cannot write");
    }
  }

 private:
  int fd_;
};

/// The packed bits of every layer of the picture: what "write alone" stores.
void write_alone(const Picture& picture, const std::string& work) {
  static const Bytes piece(std::size_t{1} << 20, std::byte{0x5A});
  Rewriter out(work);
  std::int64_t left = picture.layers() * picture.lines() * picture.line_bytes();
  for (; left > 0; left -= static_cast<std::int64_t>(piece.size())) {
    out.put(std::span(piece).first(std::min(piece.size(), static_cast<std::size_t>(left))));
  }
}

void compile_picture(const Picture& picture, LineSink& sink, int threads = 1) {
  static const ImageFiles files;
  Case made = case_of(picture);
  CompileOptions options;
  options.threads = threads;
  must(compile(std::move(made.header), made.stack, files, sink, options));
}

void compile_to_file(const Picture& picture, const std::string& work, GrvOptions::Compression compression) {
  GrvOptions grv;
  grv.compression = compression;
  const std::unique_ptr<LineSink> sink =
      must(create_grv(work, picture.layers(), picture.lines(), picture.line_bytes(), grv));
  compile_picture(picture, *sink);
}

std::function<void()> step_named(const std::string& step, const Picture& picture, const std::string& work) {
  if (step == "decode") {
    return [=] { decode_layers(picture, [](std::span<const std::byte>) {}); };
  }
  if (step == "read") {
    return [=] { read_layers(picture); };
  }
  if (step == "write") {
    return [=] { write_alone(picture, work); };
  }
  if (step == "decode+write") {
    return [=] {
      Rewriter out(work);
      decode_layers(picture, [&](std::span<const std::byte> bytes) { out.put(bytes); });
    };
  }
  if (step == "compile" || step == "compile@2") {
    return [=] {
      NullSink sink(picture.line_bytes());
      compile_picture(picture, sink, step == "compile" ? 1 : 2);
    };
  }
  if (step == "compile+write") {
    return [=] { compile_to_file(picture, work, GrvOptions::Compression::none); };
  }
  if (step == "compile+zstd") {
    return [=] { compile_to_file(picture, work, GrvOptions::Compression::zstd); };
  }
  stop("no step called " + step);
}

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Of this program alone: what getrusage() gives begins with the peak of the process that started it.
double peak_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) {
      return std::stod(line.substr(6)) / 1024;
    }
  }
  stop("/proc/self/status does not tell VmHWM");
}

double wall_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void repeat(const std::function<void()>& step, double seconds) {
  constexpr double kLongMs = 150;  // beside this, what a first run costs more is nothing
  double start = cpu_ms();
  double wall = wall_ms();
  int times = 1;
  step();
  if (cpu_ms() - start <= kLongMs) {
    start = cpu_ms();
    wall = wall_ms();
    times = 0;
    do {
      step();
      ++times;
    } while (cpu_ms() - start < 1e3 * seconds);
  }
  std::printf("%.3f %.0f %.3f\n", (cpu_ms() - start) / times, peak_mib(), (wall_ms() - wall) / times);
}

// ---- slices

/// A map that is in memory already.
class HeldRows final : public ImageSource {
 public:
  HeldRows(ImageInfo info, const Bytes& samples) : info_(std::move(info)), samples_(samples) {}
  const ImageInfo& info() const noexcept override { return info_; }
  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) override {
    const auto row = static_cast<std::size_t>(row_bytes(info_.samples, info_.width));
    std::memcpy(out.data(), samples_.data() + static_cast<std::size_t>(first_row) * row,
                static_cast<std::size_t>(row_count) * row);
    return {};
  }

 private:
  ImageInfo info_;
  const Bytes& samples_;
};

class HeldImage final : public ImageOpener {
 public:
  explicit HeldImage(const Picture& picture) {
    info_.path = picture.path;
    info_.width = picture.width;
    info_.height = picture.height;
    info_.samples = picture.samples;
    decode(picture.path,
           [this](std::span<const std::byte> rows) { samples_.insert(samples_.end(), rows.begin(), rows.end()); });
  }
  Result<std::int64_t> count_pages(const std::string&) const override { return std::int64_t{1}; }
  Result<std::unique_ptr<ImageSource>> open(const std::string&, std::int64_t) const override {
    return std::unique_ptr<ImageSource>(std::make_unique<HeldRows>(info_, samples_));
  }

 private:
  ImageInfo info_;
  Bytes samples_;
};

/// Keeps the lines of all layers, for a comparison with what another program makes of the same map.
class KeepingSink final : public LineSink {
 public:
  KeepingSink(std::int64_t lines, std::int64_t line_bytes) : lines_(lines), line_bytes_(line_bytes) {}
  std::int64_t lines_per_chunk() const noexcept override { return (std::int64_t{1} << 18) / line_bytes_; }
  Result<StoredChunk> encode(ChunkAddress address, std::span<const std::byte> lines) const override {
    return StoredChunk{address, {lines.begin(), lines.end()}, 0, 0, 0};
  }
  Result<void> put(const StoredChunk& chunk) override {
    const auto layer = static_cast<std::size_t>(chunk.address.layer * lines_ * line_bytes_);
    const auto at = layer + static_cast<std::size_t>(chunk.address.chunk * lines_per_chunk() * line_bytes_);
    bits_.resize(std::max(bits_.size(), at + chunk.bytes.size()));
    std::copy(chunk.bytes.begin(), chunk.bytes.end(), bits_.begin() + static_cast<std::ptrdiff_t>(at));
    return {};
  }
  Result<void> finish(const ProgramHeader&) override { return {}; }
  const Bytes& bits() const { return bits_; }

 private:
  std::int64_t lines_;
  std::int64_t line_bytes_;
  Bytes bits_;
};

/// Slices of a map that is in memory, placed and dropped; before that the lines of all of them go to `out` once.
void slice_held(const Picture& picture, const std::string& out) {
  const HeldImage image(picture);
  const auto run = [&](LineSink& sink) {
    Case made = case_of(picture);
    CompileOptions options;
    options.threads = 1;
    must(compile(std::move(made.header), made.stack, image, sink, options));
  };
  KeepingSink kept(picture.lines(), picture.line_bytes());
  run(kept);
  std::ofstream(out, std::ios::binary)
      .write(reinterpret_cast<const char*>(kept.bits().data()), static_cast<std::streamsize>(kept.bits().size()));
  constexpr double kSeconds = 0.2;
  repeat(
      [&] {
        NullSink sink(picture.line_bytes());
        run(sink);
      },
      kSeconds);
}

// ---- growth

/// Rows made as they are asked for, at the speed of memory: struts, or noise that no codec makes smaller.
class GeneratedRows final : public ImageSource {
 public:
  GeneratedRows(ImageInfo info, bool dense) : info_(std::move(info)), dense_(dense) {
    pattern_.resize(static_cast<std::size_t>((info_.width + 7) / 8) + kSpread);
    for (std::size_t i = 0; i < pattern_.size(); ++i) {
      const auto place = static_cast<std::uint32_t>(i);
      pattern_[i] =
          dense_ ? static_cast<std::byte>(noise(place, 7)) : static_cast<std::byte>(place % 24 == 0 ? 0xFFU : 0U);
    }
  }
  const ImageInfo& info() const noexcept override { return info_; }
  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) override {
    const auto bytes = static_cast<std::size_t>((info_.width + 7) / 8);
    for (std::int64_t row = 0; row < row_count; ++row) {
      const std::size_t shift = noise(static_cast<std::uint32_t>(first_row + row), 3) % kSpread;
      std::memcpy(out.data() + static_cast<std::size_t>(row) * bytes, pattern_.data() + (dense_ ? shift : 0), bytes);
    }
    return {};
  }

 private:
  static constexpr std::size_t kSpread = 4096;
  ImageInfo info_;
  bool dense_;
  Bytes pattern_;
};

class GeneratedImages final : public ImageOpener {
 public:
  GeneratedImages(ImageInfo info, bool dense) : info_(std::move(info)), dense_(dense) {}
  Result<std::int64_t> count_pages(const std::string&) const override { return std::int64_t{1}; }
  Result<std::unique_ptr<ImageSource>> open(const std::string&, std::int64_t) const override {
    return std::unique_ptr<ImageSource>(std::make_unique<GeneratedRows>(info_, dense_));
  }

 private:
  ImageInfo info_;
  bool dense_;
};

/// Packs chunks as a program file does, and keeps none.
class PackingSink final : public LineSink {
 public:
  explicit PackingSink(std::unique_ptr<LineSink> inner) : inner_(std::move(inner)) {}
  std::int64_t lines_per_chunk() const noexcept override { return inner_->lines_per_chunk(); }
  Result<StoredChunk> encode(ChunkAddress address, std::span<const std::byte> lines) const override {
    return inner_->encode(address, lines);
  }
  Result<void> put(const StoredChunk&) override { return {}; }
  Result<void> finish(const ProgramHeader&) override { return {}; }

 private:
  std::unique_ptr<LineSink> inner_;
};

void grow(double gigapixels, bool dense, bool columns) {
  Picture picture;
  picture.path = "generated";
  picture.width = columns ? std::llround(gigapixels * 1e9 / 188495) : 188495;
  picture.height = columns ? 188495 : std::llround(gigapixels * 1e9 / 188495);
  picture.along = columns ? LinesAlong::columns : LinesAlong::rows;
  Case made;
  made.header.plan.line.pixels = picture.pixels();
  made.header.plan.line.bidirectional = true;
  made.header.plan.rotary.lines_per_revolution = picture.lines();
  made.header.plan.job.revolutions = 1;
  made.header.layers.resize(1);
  made.header.layer_of_revolution = {0};
  made.stack.layers.push_back({picture.path, 0, 0});
  made.stack.lines = picture.lines();
  made.stack.pixels = picture.pixels();
  made.stack.lines_along = picture.along;
  ImageInfo info;
  info.path = picture.path;
  info.width = picture.width;
  info.height = picture.height;
  const GeneratedImages images(info, dense);
  const fs::path work = fs::temp_directory_path() / "gravure-growth.grv";
  PackingSink sink(must(create_grv(work.string(), 1, picture.lines(), picture.line_bytes())));
  CompileOptions options;
  options.threads = 1;
  options.memory_bytes = std::int64_t{columns ? 128 : 32} << 20;
  const double start = cpu_ms();
  must(compile(std::move(made.header), made.stack, images, sink, options));
  std::printf("%.0f %.0f\n", cpu_ms() - start, peak_mib());
}

// ---- outputs

void dump_program(const std::string& path, std::ofstream& out) {
  const std::unique_ptr<LineSource> program = must(open_grv(path));
  const ProgramHeader& header = program->header();
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  const std::int64_t per_chunk = program->lines_per_chunk();
  Bytes bits(static_cast<std::size_t>(per_chunk * header.line_bytes()));
  for (std::int64_t layer = 0; layer < static_cast<std::int64_t>(header.layers.size()); ++layer) {
    for (std::int64_t first = 0; first < lines; first += per_chunk) {
      const auto count = static_cast<std::size_t>(std::min(per_chunk, lines - first) * header.line_bytes());
      must(program->decode(must(program->fetch({layer, first / per_chunk})), std::span(bits).first(count)));
      out.write(reinterpret_cast<const char*>(bits.data()), static_cast<std::streamsize>(count));
    }
  }
}

void dump(const std::string& path, const std::string& to) {
  std::ofstream out(to, std::ios::binary);
  if (path.ends_with(".grv")) {
    dump_program(path, out);
    return;
  }
  TIFF* tiff = TIFFOpen(path.c_str(), "rm");
  std::uint16_t photometric = 0;
  std::uint32_t height = 0;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  Bytes row(static_cast<std::size_t>(TIFFScanlineSize(tiff)));
  for (std::uint32_t y = 0; y < height; ++y) {
    TIFFReadScanline(tiff, row.data(), y);
    for (std::byte& byte : row) {
      byte = photometric == PHOTOMETRIC_MINISWHITE ? ~byte : byte;
    }
    out.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size()));
  }
  TIFFClose(tiff);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> given(argv + 1, argv + argc);
  if (given.size() == 2 && given[0] == "pictures") {
    write_pictures(given[1]);
  } else if (given.size() == 4 && given[0] == "growth") {
    grow(std::stod(given[1]), given[2] == "dense", given[3] == "columns");
  } else if (given.size() == 3 && given[0] == "slices") {
    slice_held(picture_of(given[1]), given[2]);
  } else if (given.size() == 2 && given[0] == "roller") {
    write_roller(given[1]);
  } else if (given.size() == 3 && given[0] == "bits") {
    dump(given[1], given[2]);
  } else if (given.size() == 4) {
    repeat(step_named(given[0], picture_of(given[1]), given[2]), std::stod(given[3]));
  } else {
    stop("see the head of table_step.cpp");
  }
  return 0;
}
