#pragma once

#include <cstdint>

#include "gravure/core/error.hpp"
#include "gravure/core/layer_lines.hpp"
#include "gravure/core/path_motion.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/texture/split.hpp"

namespace gravure::texture {

/// A picture in the plane, centred on the origin, its first row at the largest y. It is projected along z as a whole:
/// pixels stay where they are in the plane, on a slope they lie further apart on the surface.
struct PictureGrid {
  std::int64_t columns = 0;  ///< pixels of a line, along x
  std::int64_t rows = 0;     ///< lines
  double pixel_mm = 0;       ///< along the line
  double line_mm = 0;        ///< from line to line
  double run_out_mm = 0;     ///< dark, before and behind every line, at least
  double step_mm = 0;        ///< between points of the path along a line, at most
};

/// Lines to and fro, row by row from the first, which runs towards larger x; in the dark out beyond the end, on to the
/// next row, in again. TexturePath::pulse_mm is the length of lines that has been run in the plane: pulse i of
/// picture_pulses() stands above the middle of its pixel. bad_argument for a grid that is none, out_of_range for more
/// than `most_points`.
Result<TexturePath> picture_path(const PictureGrid& grid, std::size_t most_points);

/// A pulse for every pixel, in the order of the path; its bit is that of the pixel in layer 0 of `lines`, every other
/// row mirrored: the same rows and bits as those of a job on a cylinder. Errors as `lines`; cancelled on request;
/// out_of_range for more than 2^33 pixels.
Result<PathPulses> picture_pulses(const PictureGrid& grid, LayerLines& lines, const CancelToken& cancel);

struct Pixel {
  std::int64_t row = 0;
  std::int64_t column = 0;
};
/// The pixel of a pulse.
Pixel pixel_of(const PictureGrid& grid, std::int64_t pulse);
/// Its middle.
Vector2 pixel_mm(const PictureGrid& grid, const Pixel& pixel);

}  // namespace gravure::texture
