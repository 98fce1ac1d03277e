#include "table_step.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include <memory>
#include <span>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"

namespace gravure::bench {
namespace {

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

}  // namespace

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

}  // namespace gravure::bench
