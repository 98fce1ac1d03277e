#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
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
  std::function<double(std::int64_t column, std::int64_t row)> share;  ///< 0 to 1; below 0: nothing there
};
/// The shares of a part that stand row by row.
std::function<double(std::int64_t, std::int64_t)> shares_of_rows(std::vector<double> shares, std::int64_t width);

/// {"left", "top", "width", "height"} of a part, in pixels.
Json place_json(const PicturePart& part);

/// The size of a part in a frame of `width` by `most_rows`; a value is `aspect` times as high as wide on the workpiece.
report::Extent size_in_frame(const report::Extent& values, double aspect, std::int64_t width, std::int64_t most_rows);

/// bad_argument where the name does not end in .png (any case): pictures are written as PNG.
Result<void> check_png_name(const std::string& path);

/// A picture to put parts on, which are drawn row by row as it is written.
class Canvas {
 public:
  explicit Canvas(const report::Extent& size) : size_(size) {}
  void draw(const PicturePart& part, Ramp ramp) { parts_.push_back({part, ramp, std::nullopt}); }
  /// And the seam through the middle of the part, dashed.
  void draw_with_seam(const PicturePart& part, Ramp ramp, bool across) { parts_.push_back({part, ramp, across}); }
  /// The whole PNG, or none where the user has stopped before.
  Result<void> write(const std::string& path) const;

 private:
  struct Colour;
  struct Drawn {
    PicturePart part;
    Ramp ramp;
    std::optional<bool> seam_across;
  };
  static void put(std::span<std::byte> row, std::int64_t x, const Colour& colour);
  static void draw_row(const Drawn& drawn, std::int64_t y, std::span<std::byte> row);
  static void draw_seam(const Drawn& drawn, std::int64_t y, std::span<std::byte> row);

  report::Extent size_;
  std::vector<Drawn> parts_;
};

}  // namespace gravure::cli
