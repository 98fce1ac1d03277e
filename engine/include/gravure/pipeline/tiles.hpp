#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gravure/core/image_source.hpp"
#include "gravure/core/job.hpp"

namespace gravure {

/// Step and repeat as the picture lies in its file: the image is a tile, laid side by side with itself. The first tile
/// is never turned over.
struct TileGrid {
  std::int64_t across = 1;     ///< tiles from left to right, at least 1
  std::int64_t down = 1;       ///< tiles from top to bottom, at least 1
  bool mirror_across = false;  ///< every other tile from left to right is turned over left to right
  bool mirror_down = false;    ///< every other tile from top to bottom is turned over top to bottom

  bool repeats() const { return across > 1 || down > 1; }
};

/// Round the workpiece is down where lines run along rows, across where they run along columns.
TileGrid tile_grid(const RepeatSettings& repeat, LinesAlong lines_along);

/// What a picture laid of such tiles says of itself: its size, and what its reader holds beside that of the tile.
ImageInfo tiled_info(const ImageInfo& tile, const TileGrid& grid);

/// Opens a page as the picture laid of it; no more than some rows of the tile are held at a time, 1 MiB or one row. A
/// tile that must be read upwards (ImageInfo::random_access) is opened again whenever an earlier row is asked for, so
/// turned over top to bottom it is decoded many times. `opener` must outlive the source. Errors: those of the opener.
Result<std::unique_ptr<ImageSource>> open_tiled(const ImageOpener& opener, const std::string& path, std::int64_t page,
                                                const TileGrid& grid);

}  // namespace gravure
