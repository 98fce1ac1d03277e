#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gravure/report/report_data.hpp"
#include "verb.hpp"

namespace gravure::cli {

inline constexpr std::int64_t kPictureGap = 16;  ///< rows between two parts of a picture

/// The colours of the report page: paper to a deep blue, darker is deeper; or paper to ink for what fired.
enum class Ramp : std::uint8_t { depth, fired };

/// Values of one part of a picture, and where it goes.
struct PicturePart {
  report::Extent values;
  report::Extent size;  ///< on the picture
  std::int64_t top = 0;
  std::vector<double> shares;  ///< 0 to 1, row by row; below 0: nothing there
};

/// {"left", "top", "width", "height"} of a part, in pixels.
Json place_json(const PicturePart& part);

/// The size of a part in a frame of `width` by `most_rows`; a value is `aspect` times as high as wide on the workpiece.
report::Extent size_in_frame(const report::Extent& values, double aspect, std::int64_t width, std::int64_t most_rows);

/// bad_argument where the name does not end in .png (any case): pictures are written as PNG.
Result<void> check_png_name(const std::string& path);

/// A picture to draw parts on.
class Canvas {
 public:
  explicit Canvas(const report::Extent& size);
  void draw(const PicturePart& part, Ramp ramp);
  /// The seam through the middle of a part, dashed.
  void draw_seam(const PicturePart& part, bool across);
  Result<std::string> png() const;

 private:
  struct Colour;
  void put(std::int64_t x, std::int64_t y, const Colour& colour);

  report::Extent size_;
  std::vector<std::byte> pixels_;
};

}  // namespace gravure::cli
