#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/contour.hpp"
#include "gravure/core/error.hpp"

namespace gravure::formats {

/// Larger files are refused before they are read, more points or contours before they are stored.
inline constexpr std::size_t kMaxContourBytes = std::size_t{1} << 28U;
inline constexpr std::size_t kMaxContourPoints = 5'000'000;
inline constexpr std::size_t kMaxContours = 1'000'000;
/// Largest coordinate.
inline constexpr double kMaxContourMm = 1e6;
/// Largest number of a contour: JSON's numbers are exact so far.
inline constexpr std::int64_t kMaxContourId = (std::int64_t{1} << 53U) - 1;

/// The contours of a file, one or more.
struct ContourFile {
  std::vector<Contour> contours;
  std::vector<std::string> notes;  ///< what was read otherwise than it stands there: for warnings
};

/// Reads contours as JSON or CSV (docs/formats/contours.md); which of them, the first character tells. Fails as
/// read_file() (core) and parse_contours() do.
Result<ContourFile> read_contours(const std::string& path);

/// The contours in `text`; `path` is only named, in errors. Directions come out with length 1.
///
/// Fails with bad_file, naming line and column or contour and point: text that is neither form, keys missing or twice,
/// an id twice, a contour of one point or of no length, a direction of no length, CSV rows of one contour that differ
/// in direction, more than the limits above; with out_of_range where a number is beyond its range.
Result<ContourFile> parse_contours(std::string_view text, const std::string& path);

/// The JSON form, which parse_contours() reads back bit for bit.
std::string contours_to_json(const std::vector<Contour>& contours);
/// The CSV form, likewise.
std::string contours_to_csv(const std::vector<Contour>& contours);

}  // namespace gravure::formats
