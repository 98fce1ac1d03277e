#include "table_step.hpp"

#include <cmath>
#include <cstring>
#include <memory>

#include "gravure/formats/grv.hpp"

namespace gravure::bench {
namespace {

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

}  // namespace

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
  const std::filesystem::path work = std::filesystem::temp_directory_path() / "gravure-growth.grv";
  PackingSink sink(must(create_grv(work.string(), 1, picture.lines(), picture.line_bytes())));
  CompileOptions options;
  options.threads = 1;
  options.memory_bytes = std::int64_t{columns ? 128 : 32} << 20;
  const double start = cpu_ms();
  must(compile(std::move(made.header), made.stack, images, sink, options));
  std::printf("%.0f %.0f\n", cpu_ms() - start, peak_mib());
}

}  // namespace gravure::bench
