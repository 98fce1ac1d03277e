#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/image_source.hpp"
#include "gravure/texture/surface.hpp"

namespace gravure::texture {

/// Heights on a grid centred on the origin of the plane.
struct HeightGrid {
  std::int64_t columns = 0;  ///< along x
  std::int64_t rows = 0;     ///< along y; the first one has the largest y, as pictures are looked at
  double pitch_x_mm = 0;
  double pitch_y_mm = 0;
  std::vector<double> heights_mm;  ///< row by row
};

/// What the samples of a picture stand for.
struct HeightScale {
  double pitch_x_mm = 0;
  double pitch_y_mm = 0;
  double low_mm = 0;   ///< z of sample 0
  double high_mm = 1;  ///< z of the largest sample of 16 bits, or of 1.0
};

/// Reads all rows of a picture of 16 bits or floats. bad_file for pictures of 8 bits or fewer (their steps are facets,
/// not a surface) and for samples that are not finite; out_of_range for more than 64 million samples or a scale that is
/// none.
Result<HeightGrid> read_height_grid(ImageSource& picture, const HeightScale& scale);

/// The bicubic natural spline through all heights: normals and curvatures are continuous, curvature is 0 across the
/// rim. It ends at the centres of the outermost samples. bad_argument for grids of fewer than 2 x 2 heights or pitches
/// that are not above 0.
Result<std::unique_ptr<Surface>> height_field_surface(HeightGrid grid);

}  // namespace gravure::texture
