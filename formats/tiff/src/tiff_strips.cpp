#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "gravure/formats/tiff.hpp"
#include "tiff_source.hpp"

namespace gravure {
namespace {

/// Compressed strips: decoded one at a time, or row by row where that costs no more. The latest strip is kept, so that
/// reading it in parts does not decode it twice; strips that are wanted whole go straight to the caller.
class StripSource final : public BilevelSource {
 public:
  /// `by_rows`: libtiff streams the rows, and no strip is kept. That runs upwards only: going back would decode the
  /// strip from its start again. Where the page promises random access whoever goes back is served by whole strips from
  /// then on; where it does not, only a fresh start is allowed.
  StripSource(TiffHandle handle, ImageInfo info, bool by_rows)
      : BilevelSource(std::move(handle), std::move(info)), by_rows_(by_rows) {}

 private:
  Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) override {
    if (by_rows_ && first_row < next_row_) {
      if (info_.random_access) {
        by_rows_ = false;
      } else if (first_row != 0) {
        return Error{ErrorCode::bad_argument, place() + "row " + std::to_string(first_row) + " asked for after row " +
                                                  std::to_string(next_row_ - 1) +
                                                  ": its strips are too large to be read other than upwards; rewrite "
                                                  "the file with smaller strips (`tiffcp -r 64`)"};
      }
      next_row_ = 0;
    }
    return by_rows_ ? read_upwards(first_row, row_count, out) : read_strips(first_row, row_count, out);
  }

  Result<void> read_upwards(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
    if (info_.random_access) {  // then its strips are known, and those in between need no decoding
      next_row_ = std::max(next_row_, first_row - first_row % info_.rows_per_block);
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

  Result<void> read_strips(std::int64_t first_row, std::int64_t row_count, std::byte* out) {
    const std::int64_t end = first_row + row_count;
    for (std::int64_t row = first_row; row < end;) {
      const std::int64_t index = row / info_.rows_per_block;
      const std::int64_t skip = row - index * info_.rows_per_block;
      const std::int64_t rows = std::min(rows_in(index) - skip, end - row);
      if (rows == rows_in(index) && index != kept_) {
        GRAVURE_CHECK(decode(index, out));
      } else {
        GRAVURE_CHECK(keep(index));
        std::memcpy(out, strip_.data() + skip * row_bytes_, static_cast<std::size_t>(rows * row_bytes_));
      }
      out += rows * row_bytes_;
      row += rows;
    }
    return {};
  }

  std::int64_t rows_in(std::int64_t index) const {
    return std::min(info_.rows_per_block, info_.height - index * info_.rows_per_block);
  }

  Result<void> keep(std::int64_t index) {
    if (kept_ != index) {
      kept_ = -1;
      strip_.resize(static_cast<std::size_t>(info_.rows_per_block * row_bytes_));
      GRAVURE_CHECK(decode(index, strip_.data()));
      kept_ = index;
    }
    return {};
  }

  Result<void> decode(std::int64_t index, std::byte* out) {
    const bool decoded = decode_block(static_cast<std::uint32_t>(index), out, rows_in(index) * row_bytes_);
    return decoded ? Result<void>() : damage(index * info_.rows_per_block);
  }

  bool by_rows_;
  std::vector<std::byte> skipped_;
  std::int64_t next_row_ = 0;  // by rows: the one that libtiff gives next
  std::vector<std::byte> strip_;
  std::int64_t kept_ = -1;  // the strip in there
};

/// Uncompressed strips: rows straight from their places in the file, of all strips that stand there in a row at once.
class PlainSource final : public BilevelSource {
 public:
  PlainSource(TiffHandle handle, ImageInfo info, bool lowest_bit_first)
      : BilevelSource(std::move(handle), std::move(info)), lowest_bit_first_(lowest_bit_first) {}

 private:
  Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) override {
    clear_messages();
    const std::int64_t end = first_row + row_count;
    for (std::int64_t row = first_row; row < end;) {
      const std::int64_t offset = offset_of(row);
      std::int64_t rows = std::min(rows_left_in_strip(row), end - row);
      while (row + rows < end && offset_of(row + rows) == offset + rows * row_bytes_) {
        rows += std::min(rows_left_in_strip(row + rows), end - row - rows);
      }
      const std::int64_t bytes = rows * row_bytes_;
      const std::int64_t done = read_bytes(offset, bytes, out, lowest_bit_first_);
      if (done < bytes) {
        return damage(row + done / row_bytes_);
      }
      out += bytes;
      row += rows;
    }
    return {};
  }

  std::int64_t rows_left_in_strip(std::int64_t row) const { return info_.rows_per_block - row % info_.rows_per_block; }

  std::int64_t offset_of(std::int64_t row) const {
    const auto strip = static_cast<std::uint32_t>(row / info_.rows_per_block);
    return static_cast<std::int64_t>(TIFFGetStrileOffset(tiff(), strip)) + row % info_.rows_per_block * row_bytes_;
  }

  bool lowest_bit_first_;
};

/// A strip larger than this leaves the second-level cache before its rows are used.
constexpr std::int64_t kMostCachedBytes = std::int64_t{1} << 20;

/// Does decoding row by row take no longer than decoding a strip at once? Deflate would go through zlib, three times as
/// slow as the libdeflate that decodes whole strips.
bool streams_well(const TiffPageInfo& page_info) {
  switch (page_info.compression) {
    case COMPRESSION_PACKBITS:
    case COMPRESSION_LZW:
    case COMPRESSION_CCITTRLE:
    case COMPRESSION_CCITTRLEW:
    case COMPRESSION_CCITTFAX3:
    case COMPRESSION_CCITTFAX4:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::unique_ptr<ImageSource> make_strip_source(TiffHandle handle, ImageInfo info, const TiffPageInfo& page_info) {
  info.decoder_bytes = page_info.codec_bytes();
  if (!page_info.compressed()) {
    return std::make_unique<PlainSource>(std::move(handle), std::move(info), page_info.lowest_bit_first);
  }
  const std::int64_t bytes_a_row = row_bytes(SampleType::bit, info.width);
  if (info.rows_per_block <= kMaxTiffStripBytes / bytes_a_row && page_info.largest_block_bytes <= kMaxTiffStripBytes) {
    const bool by_rows = streams_well(page_info) && info.rows_per_block > kMostCachedBytes / bytes_a_row;
    info.decoder_bytes += StoredBlocks::kBytes + info.rows_per_block * bytes_a_row;
    return std::make_unique<StripSource>(std::move(handle), std::move(info), by_rows);
  }
  info.decoder_bytes += bytes_a_row;
  info.rows_per_block = 1;
  info.random_access = false;
  return std::make_unique<StripSource>(std::move(handle), std::move(info), true);
}

}  // namespace gravure
