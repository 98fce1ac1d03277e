#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/report/area_count.hpp"
#include "gravure/twin/exposure.hpp"

namespace gravure::report {

/// What one image of the stack looks like on the workpiece, as the emulated board exposed it: in the orientation of its
/// source. A share is 0 .. 255 of the pixels of a cell, rounded.
struct LayerPicture {
  std::int64_t layer = 0;
  std::int64_t source = 0;  ///< index into ProgramHeader::sources
  std::int64_t level = 0;
  std::int64_t revolutions = 0;  ///< that expose it, counted once however many bands there are
  std::int64_t fired_pixels = 0;
  std::vector<std::byte> shares;  ///< of fired pixels, a cell each; empty: not among the shown ones
  std::vector<std::byte> seam;    ///< pixels about the seam, 255 fired; empty: likewise
};

/// Pixels about the seam: the last lines of the revolution and the first ones, joined, in the middle of the lines.
struct SeamPlace {
  std::int64_t first_column = 0;
  std::int64_t columns = 0;
  std::int64_t lines_each = 0;  ///< on either side of the seam
};

/// Every image of a program, and what all of them together expose.
struct LayerPictures {
  Extent picture;              ///< pixels of every image
  Extent cells;                ///< cells they are shown in
  SeamPlace seam_place;        ///< in lines and columns
  bool lines_are_rows = true;  ///< else lines run down the picture
  std::vector<LayerPicture> layers;
  std::vector<std::int64_t> pulses;         ///< of all revolutions, a cell each
  std::vector<std::int64_t> seam_pulses;    ///< of all revolutions, a pixel of the seam each
  std::vector<std::int64_t> column_pulses;  ///< of all revolutions, by the columns of cells along the line
  std::vector<std::int64_t> column_pixels;  ///< pixels of such a column
  std::int64_t exposures = 0;               ///< revolutions that expose a place: of all layers

  Extent seam_extent() const noexcept {
    const Extent lines_down{seam_place.columns, 2 * seam_place.lines_each};
    return lines_are_rows ? lines_down : Extent{lines_down.height, lines_down.width};
  }
};

struct LayerPicturesOptions {
  std::int64_t memory_bytes = std::int64_t{256} << 20;
  std::int64_t table_bytes = 0;  ///< of them for what the readers of the program hold together
  /// Of them for what is made of the pictures when the workers are gone, by what is drawn; none: nothing worth
  /// counting.
  std::function<std::int64_t(const Extent& cells, const Extent& seam, std::int64_t shown_layers)> later_bytes = {};
  std::string remedy = "raise --memory";      ///< where memory_bytes are too few
  int threads = 0;                            ///< 0: one for each processor
  std::int64_t most_cells = 250'000;          ///< of a layer
  std::int64_t most_shown_cells = 4'000'000;  ///< of all shown layers
  std::int64_t most_shown_layers = 96;        ///< 0: pulses alone are wanted
  std::int64_t most_seam_lines = 80;          ///< on either side
  std::int64_t most_seam_columns = 320;
  std::optional<std::int64_t> only_layer = {};  ///< none: all; else this one, once
  CancelToken* cancel = nullptr;
  Progress* progress = nullptr;
};

/// Runs every image once on devices made by `devices` and counts what was exposed; memory does not grow with their
/// size. With only_layer the others have no picture and no pulses. Fails as unroll_layer() does, and with out_of_range
/// where there is no such layer or the budget does not hold the cells and a worker.
Result<LayerPictures> layer_pictures(const std::function<Result<std::unique_ptr<LineSource>>()>& programs,
                                     const DeviceFactory& devices, const LayerPicturesOptions& options);

/// How many revolutions (passes) expose image 0, 1, ... of a program; once however many bands there are.
std::vector<std::int64_t> exposures_of_images(const ProgramHeader& header);

}  // namespace gravure::report
