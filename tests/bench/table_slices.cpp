#include "table_step.hpp"

#include <cstring>
#include <fstream>
#include <memory>

namespace gravure::bench {
namespace {

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

}  // namespace

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

}  // namespace gravure::bench
