#include "gravure/pipeline/tiles.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "gravure/core/as_size.hpp"
#include "gravure/raster/place.hpp"

namespace gravure {
namespace {

constexpr std::int64_t kTileBytes = std::int64_t{1} << 20;  // rows of the tile held at a time

std::int64_t tile_row_bytes(const ImageInfo& tile) {
  return row_bytes(tile.samples, tile.width);
}

std::int64_t block_rows(const ImageInfo& tile) {
  return std::clamp<std::int64_t>(kTileBytes / std::max<std::int64_t>(1, tile_row_bytes(tile)), 1,
                                  std::max<std::int64_t>(1, tile.height));
}

bool turned_over(bool mirror, std::int64_t tile) {
  return mirror && tile % 2 != 0;
}

class TiledSource final : public ImageSource {
 public:
  TiledSource(const ImageOpener& opener, std::unique_ptr<ImageSource> image, const TileGrid& grid)
      : opener_(opener),
        image_(std::move(image)),
        tile_(image_->info()),
        grid_(grid),
        info_(tiled_info(tile_, grid)),
        block_rows_(block_rows(tile_)) {}

  const ImageInfo& info() const noexcept override { return info_; }

  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) override {
    const std::int64_t bytes = row_bytes(info_.samples, info_.width);
    while (row_count > 0) {
      const std::int64_t in_tile = first_row % tile_.height;
      const bool mirrored = turned_over(grid_.mirror_down, first_row / tile_.height);
      const bool as_they_are = grid_.across == 1 && !mirrored;
      std::int64_t count = std::min(row_count, tile_.height - in_tile);
      if (as_they_are) {
        GRAVURE_CHECK(read_tile(in_tile, count, out));
      } else {
        count = std::min(count, block_rows_);
        GRAVURE_CHECK(lay_rows(mirrored ? tile_.height - in_tile - count : in_tile, count, mirrored, out));
      }
      out = out.subspan(as_size(count * bytes));
      first_row += count;
      row_count -= count;
    }
    return {};
  }

 private:
  Result<void> read_tile(std::int64_t first_row, std::int64_t count, std::span<std::byte> out) {
    if (!image_ || (!tile_.random_access && first_row < next_row_)) {
      image_.reset();  // one at a time is what its memory is counted for
      GRAVURE_TRY(image_, opener_.open(tile_.path, tile_.page));
    }
    next_row_ = first_row + count;
    Result<void> read = image_->read_rows(first_row, count, out.first(as_size(count * tile_row_bytes(tile_))));
    if (!read) {
      image_.reset();
    }
    return read;
  }

  /// Rows of the tile, from top to bottom or the other way, laid side by side.
  Result<void> lay_rows(std::int64_t first_row, std::int64_t count, bool upwards, std::span<std::byte> out) {
    const std::int64_t tile_bytes = tile_row_bytes(tile_);
    const std::int64_t bytes = row_bytes(info_.samples, info_.width);
    rows_.resize(as_size(block_rows_ * tile_bytes));
    GRAVURE_CHECK(read_tile(first_row, count, rows_));
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t row = upwards ? count - 1 - i : i;
      lay_row(std::span<const std::byte>(rows_).subspan(as_size(row * tile_bytes), as_size(tile_bytes)),
              out.subspan(as_size(i * bytes), as_size(bytes)));
    }
    return {};
  }

  void lay_row(std::span<const std::byte> row, std::span<std::byte> out) const {
    const std::int64_t sample = row_bytes(tile_.samples, 1);
    for (std::int64_t tile = 0; tile < grid_.across; ++tile) {
      const bool mirrored = turned_over(grid_.mirror_across, tile);
      if (tile_.samples == SampleType::bit) {
        raster::place_line(out, tile * tile_.width, row, 0, tile_.width, {.mirror = mirrored});
        continue;
      }
      const std::span<std::byte> place = out.subspan(as_size(tile) * row.size(), row.size());
      if (!mirrored) {
        std::memcpy(place.data(), row.data(), row.size());
        continue;
      }
      for (std::int64_t column = 0; column < tile_.width; ++column) {
        std::memcpy(place.data() + column * sample, row.data() + (tile_.width - 1 - column) * sample, as_size(sample));
      }
    }
  }

  const ImageOpener& opener_;
  std::unique_ptr<ImageSource> image_;
  const ImageInfo tile_;
  const TileGrid grid_;
  const ImageInfo info_;
  const std::int64_t block_rows_;
  std::int64_t next_row_ = 0;  // what a tile that only runs upwards has not given yet
  std::vector<std::byte> rows_;
};

}  // namespace

TileGrid tile_grid(const RepeatSettings& repeat, LinesAlong lines_along) {
  return lines_along == LinesAlong::rows
             ? TileGrid{repeat.along, repeat.around, repeat.mirror_along, repeat.mirror_around}
             : TileGrid{repeat.around, repeat.along, repeat.mirror_around, repeat.mirror_along};
}

ImageInfo tiled_info(const ImageInfo& tile, const TileGrid& grid) {
  ImageInfo info = tile;
  if (grid.repeats()) {
    info.width *= grid.across;
    info.height *= grid.down;
    info.decoder_bytes += block_rows(tile) * tile_row_bytes(tile);
  }
  return info;
}

Result<std::unique_ptr<ImageSource>> open_tiled(const ImageOpener& opener, const std::string& path, std::int64_t page,
                                                const TileGrid& grid) {
  GRAVURE_TRY(std::unique_ptr<ImageSource> image, opener.open(path, page));
  if (!grid.repeats()) {
    return image;
  }
  return std::unique_ptr<ImageSource>(new TiledSource(opener, std::move(image), grid));
}

}  // namespace gravure
