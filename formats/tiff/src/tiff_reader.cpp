#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "gravure/formats/tiff.hpp"
#include "tiff_handle.hpp"
#include "tiff_page_info.hpp"
#include "tiff_page_offsets.hpp"

namespace gravure {
namespace {

ImageInfo image_info(const TiffPageInfo& page_info, const std::string& path, std::int64_t page) {
  ImageInfo info;
  info.path = path;
  info.page = page;
  info.width = page_info.width;
  info.height = page_info.height;
  info.samples = SampleType::bit;
  info.zero_is_white = page_info.zero_is_white;
  info.rows_per_block = std::min(page_info.rows_per_block, page_info.height);
  info.x_dots_per_mm = page_info.x_dots_per_mm;
  info.y_dots_per_mm = page_info.y_dots_per_mm;
  const bool fax = page_info.compression == COMPRESSION_CCITTFAX3 || page_info.compression == COMPRESSION_CCITTFAX4;
  info.fax_larger_than_raw = fax && page_info.all_block_bytes > info.height * row_bytes(SampleType::bit, info.width);
  return info;
}

/// What all ways of reading share: the handle, the checks of a call, the wording of damage.
class BilevelSource : public ImageSource {
 public:
  BilevelSource(TiffHandle handle, ImageInfo info)
      : handle_(std::move(handle)), info_(std::move(info)), row_bytes_(row_bytes(SampleType::bit, info_.width)) {}

  const ImageInfo& info() const noexcept override { return info_; }

  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) final {
    if (first_row < 0 || row_count < 0 || row_count > info_.height || first_row > info_.height - row_count) {
      return Error{ErrorCode::out_of_range, place() + "rows " + std::to_string(first_row) + " + " +
                                                std::to_string(row_count) + " asked for: it has rows 0 to " +
                                                std::to_string(info_.height - 1)};
    }
    if (out.size() < static_cast<std::size_t>(row_count * row_bytes_)) {
      return Error{ErrorCode::bad_argument, place() + "the buffer for " + std::to_string(row_count) + " rows holds " +
                                                std::to_string(out.size()) + " bytes, " +
                                                std::to_string(row_count * row_bytes_) + " are needed"};
    }
    return read_checked(first_row, row_count, out.data());
  }

 protected:
  virtual Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) = 0;

  TIFF* tiff() const noexcept { return handle_.get(); }
  void clear_messages() noexcept { handle_.messages().clear(); }
  /// A warning while decoding means that libtiff filled in what it could not read: damage all the same.
  bool said_anything() const noexcept { return handle_.messages().any(); }
  std::string place() const { return tiff_place(info_.path, info_.page); }
  Error damage(std::int64_t row) const {
    return {ErrorCode::bad_file, place() + "row " + std::to_string(row) +
                                     ": the image data are damaged or truncated; copy or export the file again" +
                                     handle_.messages().text()};
  }

  TiffHandle handle_;
  ImageInfo info_;
  std::int64_t row_bytes_;
};

/// Blocks (strips, or rows of tiles) decoded one at a time. The latest one is kept, so that reading it in parts does
/// not decode it twice; blocks that are wanted whole go straight to the caller.
class BlockSource : public BilevelSource {
 public:
  using BilevelSource::BilevelSource;

 protected:
  /// Decodes the rows of block `index` that exist.
  virtual Result<void> decode(std::int64_t index, std::byte* out) = 0;

  std::int64_t rows_in(std::int64_t index) const {
    return std::min(info_.rows_per_block, info_.height - index * info_.rows_per_block);
  }

 private:
  Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) override {
    const std::int64_t end = first_row + row_count;
    for (std::int64_t row = first_row; row < end;) {
      const std::int64_t index = row / info_.rows_per_block;
      const std::int64_t skip = row - index * info_.rows_per_block;
      const std::int64_t rows = std::min(rows_in(index) - skip, end - row);
      if (rows == rows_in(index) && index != cached_) {
        GRAVURE_CHECK(decode(index, out));
      } else {
        GRAVURE_CHECK(fill_cache(index));
        std::memcpy(out, cache_.data() + skip * row_bytes_, static_cast<std::size_t>(rows * row_bytes_));
      }
      out += rows * row_bytes_;
      row += rows;
    }
    return {};
  }

  Result<void> fill_cache(std::int64_t index) {
    if (cached_ != index) {
      cached_ = -1;
      cache_.resize(static_cast<std::size_t>(info_.rows_per_block * row_bytes_));
      GRAVURE_CHECK(decode(index, cache_.data()));
      cached_ = index;
    }
    return {};
  }

  std::vector<std::byte> cache_;
  std::int64_t cached_ = -1;
};

class StripSource final : public BlockSource {
 public:
  using BlockSource::BlockSource;

 private:
  Result<void> decode(std::int64_t index, std::byte* out) override {
    clear_messages();
    const std::int64_t bytes = rows_in(index) * row_bytes_;
    if (TIFFReadEncodedStrip(tiff(), static_cast<std::uint32_t>(index), out, bytes) != bytes || said_anything()) {
      return damage(index * info_.rows_per_block);
    }
    return {};
  }
};

class TileSource final : public BlockSource {
 public:
  TileSource(TiffHandle handle, ImageInfo info, std::int64_t tile_rows, std::int64_t tile_row_bytes)
      : BlockSource(std::move(handle), std::move(info)),
        tile_row_bytes_(tile_row_bytes),
        tiles_across_((row_bytes_ + tile_row_bytes - 1) / tile_row_bytes),
        tile_(static_cast<std::size_t>(tile_rows * tile_row_bytes)) {}

 private:
  Result<void> decode(std::int64_t index, std::byte* out) override {
    for (std::int64_t across = 0; across < tiles_across_; ++across) {
      clear_messages();
      const auto bytes = static_cast<std::int64_t>(tile_.size());
      const auto number = static_cast<std::uint32_t>(index * tiles_across_ + across);
      if (TIFFReadEncodedTile(tiff(), number, tile_.data(), bytes) != bytes || said_anything()) {
        return damage(index * info_.rows_per_block);
      }
      place_tile(across * tile_row_bytes_, rows_in(index), out);
    }
    return {};
  }

  void place_tile(std::int64_t left_byte, std::int64_t rows, std::byte* out) const {
    const std::int64_t bytes = std::min(tile_row_bytes_, row_bytes_ - left_byte);
    for (std::int64_t row = 0; row < rows; ++row) {
      std::memcpy(out + row * row_bytes_ + left_byte, tile_.data() + row * tile_row_bytes_,
                  static_cast<std::size_t>(bytes));
    }
  }

  std::int64_t tile_row_bytes_;
  std::int64_t tiles_across_;
  std::vector<std::byte> tile_;
};

/// Uncompressed strips: rows straight from their places in the file, of all strips that stand there in a row at once.
class PlainSource final : public BilevelSource {
 public:
  PlainSource(TiffHandle handle, ImageInfo info, bool lowest_bit_first)
      : BilevelSource(std::move(handle), std::move(info)), lowest_bit_first_(lowest_bit_first) {}

 private:
  Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) override {
    const std::int64_t end = first_row + row_count;
    for (std::int64_t row = first_row; row < end;) {
      const std::int64_t offset = offset_of(row);
      std::int64_t rows = std::min(rows_left_in_strip(row), end - row);
      while (row + rows < end && offset_of(row + rows) == offset + rows * row_bytes_) {
        rows += std::min(rows_left_in_strip(row + rows), end - row - rows);
      }
      GRAVURE_CHECK(read_bytes(offset, rows * row_bytes_, row, out));
      out += rows * row_bytes_;
      row += rows;
    }
    return {};
  }

  std::int64_t rows_left_in_strip(std::int64_t row) const { return info_.rows_per_block - row % info_.rows_per_block; }

  std::int64_t offset_of(std::int64_t row) const {
    const auto strip = static_cast<std::uint32_t>(row / info_.rows_per_block);
    return static_cast<std::int64_t>(TIFFGetStrileOffset(tiff(), strip)) + row % info_.rows_per_block * row_bytes_;
  }

  Result<void> read_bytes(std::int64_t offset, std::int64_t bytes, std::int64_t row, std::byte* out) {
    clear_messages();
    for (std::int64_t done = 0; done < bytes;) {
      const ssize_t got =
          ::pread(TIFFFileno(tiff()), out + done, static_cast<std::size_t>(bytes - done), offset + done);
      if (got <= 0) {
        return damage(row + done / row_bytes_);
      }
      done += got;
    }
    if (lowest_bit_first_) {
      TIFFReverseBits(reinterpret_cast<std::uint8_t*>(out), bytes);
    }
    return {};
  }

  bool lowest_bit_first_;
};

/// Compressed strips too large to decode whole: libtiff streams them row by row. They only run upwards; going back
/// would decode the strip from its start again, so only a fresh start is allowed.
class RowSource final : public BilevelSource {
 public:
  using BilevelSource::BilevelSource;

 private:
  Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) override {
    if (first_row != 0 && first_row < next_row_) {
      return Error{ErrorCode::bad_argument, place() + "row " + std::to_string(first_row) + " asked for after row " +
                                                std::to_string(next_row_ - 1) +
                                                ": its strips are too large to be read other than upwards; rewrite the "
                                                "file with smaller strips (`tiffcp -r 64`)"};
    }
    if (first_row < next_row_) {
      next_row_ = 0;
    }
    skipped_.resize(next_row_ < first_row ? static_cast<std::size_t>(row_bytes_) : 0);
    while (next_row_ < first_row) {  // not every codec of libtiff can skip rows
      GRAVURE_CHECK(read_next(skipped_.data()));
    }
    for (std::int64_t i = 0; i < row_count; ++i) {
      GRAVURE_CHECK(read_next(out + i * row_bytes_));
    }
    return {};
  }

  Result<void> read_next(std::byte* out) {
    clear_messages();
    const std::int64_t row = next_row_;
    if (TIFFReadScanline(tiff(), out, static_cast<std::uint32_t>(row), 0) != 1 || said_anything()) {
      next_row_ = info_.height;  // nothing more upwards of here
      return damage(row);
    }
    ++next_row_;
    return {};
  }

  std::vector<std::byte> skipped_;
  std::int64_t next_row_ = 0;
};

Result<std::unique_ptr<ImageSource>> make_tile_source(TiffHandle handle, ImageInfo info,
                                                      const TiffPageInfo& page_info) {
  const std::string place = tiff_place(info.path, info.page);
  std::uint32_t tile_width = 0;
  TIFFGetField(handle.get(), TIFFTAG_TILEWIDTH, &tile_width);
  const std::int64_t tile_bytes_across = tile_width / 8;
  if (tile_width == 0 || tile_width % 8 != 0) {
    return Error{ErrorCode::bad_file, place + "tiles " + std::to_string(tile_width) +
                                          " pixels wide: a TIFF tile is a multiple of 16 wide; the file is damaged"};
  }
  const std::int64_t widest = std::max(tile_bytes_across, row_bytes(SampleType::bit, info.width));
  if (page_info.rows_per_block > kMaxTiffBlockBytes / widest) {
    return Error{ErrorCode::bad_file, place + "one row of tiles (" + std::to_string(page_info.rows_per_block) +
                                          " rows) is larger than the " + std::to_string(kMaxTiffBlockBytes) +
                                          " bytes allowed; rewrite it in strips with `tiffcp -s -r 64`"};
  }
  info.decoder_bytes =
      page_info.codec_bytes() + page_info.rows_per_block * (tile_bytes_across + row_bytes(SampleType::bit, info.width));
  return std::unique_ptr<ImageSource>(
      new TileSource(std::move(handle), std::move(info), page_info.rows_per_block, tile_bytes_across));
}

Result<std::unique_ptr<ImageSource>> make_source(TiffHandle handle, ImageInfo info, const TiffPageInfo& page_info) {
  if (page_info.tiled) {
    return make_tile_source(std::move(handle), std::move(info), page_info);
  }
  info.decoder_bytes = page_info.codec_bytes();
  if (!page_info.compressed()) {
    return std::unique_ptr<ImageSource>(
        new PlainSource(std::move(handle), std::move(info), page_info.lowest_bit_first));
  }
  const std::int64_t bytes_a_row = row_bytes(SampleType::bit, info.width);
  if (info.rows_per_block <= kMaxTiffStripBytes / bytes_a_row && page_info.largest_block_bytes <= kMaxTiffStripBytes) {
    info.decoder_bytes += info.rows_per_block * bytes_a_row;
    return std::unique_ptr<ImageSource>(new StripSource(std::move(handle), std::move(info)));
  }
  info.decoder_bytes += bytes_a_row;
  info.rows_per_block = 1;
  info.random_access = false;
  return std::unique_ptr<ImageSource>(new RowSource(std::move(handle), std::move(info)));
}

}  // namespace

BilevelTiffOpener::BilevelTiffOpener() : offsets_(std::make_unique<TiffPageOffsets>()) {}
BilevelTiffOpener::~BilevelTiffOpener() = default;

Result<std::int64_t> BilevelTiffOpener::count_pages(const std::string& path) const {
  GRAVURE_TRY(const auto pages, offsets_->find(path));
  return static_cast<std::int64_t>(pages->offsets.size());
}

Result<TiffPageInfo> BilevelTiffOpener::read_page_info(const std::string& path, std::int64_t page) const {
  GRAVURE_TRY(const auto pages, offsets_->find(path));
  GRAVURE_TRY(const TiffHandle handle, open_tiff_page(path, page, *pages));
  return inspect_tiff_page(handle, path, page, pages->file_bytes);
}

Result<std::unique_ptr<ImageSource>> BilevelTiffOpener::open(const std::string& path, std::int64_t page) const {
  GRAVURE_TRY(const auto pages, offsets_->find(path));
  GRAVURE_TRY(TiffHandle handle, open_tiff_page(path, page, *pages));
  GRAVURE_TRY(const TiffPageInfo page_info, inspect_tiff_page(handle, path, page, pages->file_bytes));
  if (!page_info.bilevel() || page_info.palette) {
    return Error{ErrorCode::bad_file, tiff_place(path, page) + std::to_string(page_info.samples_per_pixel) +
                                          " sample(s) of " + std::to_string(page_info.bits_per_sample) +
                                          " bit(s) a pixel" + (page_info.palette ? ", through a palette" : "") +
                                          ": only one plain bit a pixel is bilevel"};
  }
  return make_source(std::move(handle), image_info(page_info, path, page), page_info);
}

Result<bool> is_bilevel_tiff(const std::string& path, std::int64_t page) {
  GRAVURE_TRY(const TiffPageInfo info, BilevelTiffOpener().read_page_info(path, page));
  return info.bilevel();
}

}  // namespace gravure
