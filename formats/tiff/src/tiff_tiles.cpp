#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "gravure/formats/tiff.hpp"
#include "tiff_source.hpp"

namespace gravure {
namespace {

/// `rows` pieces of kBytes from one stride to another. A known size is a load and a store; calling memcpy for each
/// 32 bytes took as long as reading uncompressed tiles.
template <std::size_t kBytes>
void copy_pieces(std::byte* out, std::int64_t out_stride, const std::byte* from, std::int64_t rows) {
  for (std::int64_t row = 0; row < rows; ++row) {
    std::memcpy(out + row * out_stride, from + row * static_cast<std::int64_t>(kBytes), kBytes);
  }
}

/// A row of tiles at a time, kept as the tiles are: whatever is asked for is put into rows once, where the caller wants
/// it.
class TileSource final : public BilevelSource {
 public:
  TileSource(TiffHandle handle, ImageInfo info, const TiffPageInfo& page_info, std::int64_t tile_row_bytes)
      : BilevelSource(std::move(handle), std::move(info)),
        compressed_(page_info.compressed()),
        lowest_bit_first_(page_info.lowest_bit_first),
        tile_row_bytes_(tile_row_bytes),
        tile_bytes_(page_info.rows_per_block * tile_row_bytes),
        tiles_across_(tiles_in_a_row(row_bytes_, tile_row_bytes)) {}

  static std::int64_t tiles_in_a_row(std::int64_t row_bytes, std::int64_t tile_row_bytes) {
    return (row_bytes + tile_row_bytes - 1) / tile_row_bytes;
  }

 private:
  Result<void> read_checked(std::int64_t first_row, std::int64_t row_count, std::byte* out) override {
    constexpr std::int64_t kBandRows = 64;  // of the caller's rows stay in the first-level cache until the last tile
    const std::int64_t end = first_row + row_count;
    for (std::int64_t row = first_row; row < end;) {
      const std::int64_t index = row / info_.rows_per_block;
      const std::int64_t skip = row - index * info_.rows_per_block;
      const std::int64_t rows = std::min({info_.rows_per_block - skip, end - row, kBandRows});
      GRAVURE_CHECK(keep(index));
      place_band(skip, rows, out);
      out += rows * row_bytes_;
      row += rows;
    }
    return {};
  }

  Result<void> keep(std::int64_t index) {
    if (kept_ != index) {
      kept_ = -1;
      tiles_.resize(static_cast<std::size_t>(tiles_across_ * tile_bytes_));
      GRAVURE_CHECK(compressed_ ? decode(index) : read_plain(index));
      kept_ = index;
    }
    return {};
  }

  Result<void> decode(std::int64_t index) {
    for (std::int64_t across = 0; across < tiles_across_; ++across) {
      if (!decode_block(tile_number(index, across), tiles_.data() + across * tile_bytes_, tile_bytes_)) {
        return damage(index * info_.rows_per_block);
      }
    }
    return {};
  }

  /// Uncompressed tiles from their places in the file; those that lie one behind the other at once.
  Result<void> read_plain(std::int64_t index) {
    clear_messages();
    for (std::int64_t across = 0; across < tiles_across_;) {
      const std::int64_t offset = tile_offset(index, across);
      std::int64_t count = 1;
      while (across + count < tiles_across_ && tile_offset(index, across + count) == offset + count * tile_bytes_) {
        ++count;
      }
      if (read_bytes(offset, count * tile_bytes_, tiles_.data() + across * tile_bytes_, lowest_bit_first_) !=
          count * tile_bytes_) {
        return damage(index * info_.rows_per_block);
      }
      across += count;
    }
    return {};
  }

  std::uint32_t tile_number(std::int64_t index, std::int64_t across) const {
    return static_cast<std::uint32_t>(index * tiles_across_ + across);
  }
  std::int64_t tile_offset(std::int64_t index, std::int64_t across) const {
    return static_cast<std::int64_t>(TIFFGetStrileOffset(tiff(), tile_number(index, across)));
  }

  void place_band(std::int64_t first_row, std::int64_t rows, std::byte* out) const {
    for (std::int64_t across = 0; across < tiles_across_; ++across) {
      const std::int64_t left = across * tile_row_bytes_;
      const std::byte* const from = tiles_.data() + across * tile_bytes_ + first_row * tile_row_bytes_;
      place_pieces(out + left, from, std::min(tile_row_bytes_, row_bytes_ - left), rows);
    }
  }

  void place_pieces(std::byte* out, const std::byte* from, std::int64_t bytes, std::int64_t rows) const {
    if (bytes == tile_row_bytes_ && bytes == 16) {
      return copy_pieces<16>(out, row_bytes_, from, rows);
    }
    if (bytes == tile_row_bytes_ && bytes == 32) {
      return copy_pieces<32>(out, row_bytes_, from, rows);
    }
    if (bytes == tile_row_bytes_ && bytes == 64) {
      return copy_pieces<64>(out, row_bytes_, from, rows);
    }
    for (std::int64_t row = 0; row < rows; ++row) {
      std::memcpy(out + row * row_bytes_, from + row * tile_row_bytes_, static_cast<std::size_t>(bytes));
    }
  }

  bool compressed_;
  bool lowest_bit_first_;
  std::int64_t tile_row_bytes_;
  std::int64_t tile_bytes_;
  std::int64_t tiles_across_;
  std::vector<std::byte> tiles_;  // cleared at first: of some damaged tiles libtiff leaves the rest as it was
  std::int64_t kept_ = -1;        // the row of tiles in there
};

}  // namespace

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
  const std::int64_t across =
      TileSource::tiles_in_a_row(row_bytes(SampleType::bit, info.width), tile_bytes_across) * tile_bytes_across;
  info.decoder_bytes = page_info.codec_bytes() + StoredBlocks::kBytes + page_info.rows_per_block * across;
  return std::unique_ptr<ImageSource>(new TileSource(std::move(handle), std::move(info), page_info, tile_bytes_across));
}

}  // namespace gravure
