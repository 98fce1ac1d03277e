#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace gravure {

/// A line on a part that the beam is to follow: x, y, z of its corners in mm in the frame of the part.
struct Contour {
  std::int64_t id = 0;
  std::vector<std::array<double, 3>> points_mm;  ///< two or more; first and last are the same where it is closed
  std::array<double, 3> direction{0, 0, 1};      ///< towards the head, at right angles to the surface; of length 1
};

}  // namespace gravure
