#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "contour_list.hpp"
#include "gravure/core/csv_rows.hpp"

namespace gravure::formats::contour_file {
namespace {

/// Directions of the rows of one contour may differ by rounding, no more: a contour has one.
constexpr double kSameDirection = 1e-6;

class Rows {
 public:
  Result<void> add(std::span<const double> row) {
    if (!started_ || row[0] != id_) {
      GRAVURE_CHECK(end_contour());
      GRAVURE_CHECK(list_.set_id(row[0]));
      GRAVURE_CHECK(list_.set_direction({row[4], row[5], row[6]}));
      started_ = true;
      id_ = row[0];
    } else {
      GRAVURE_CHECK(check_direction({row[4], row[5], row[6]}));
    }
    return list_.add_point({row[1], row[2], row[3]});
  }

  Result<ContourFile> finish() && {
    GRAVURE_CHECK(end_contour());
    return std::move(list_).finish();
  }

 private:
  Result<void> end_contour() { return started_ ? list_.end_contour() : Result<void>(); }

  Result<void> check_direction(const std::array<double, 3>& direction) {
    const std::array<double, 3> unit = unit_vector(direction).direction;
    for (std::size_t k = 0; k < unit.size(); ++k) {
      if (!(std::abs(unit[k] - list_.current().direction[k]) <= kSameDirection)) {
        return Error{
            ErrorCode::bad_file,
            fmt::format("{}: points[{}]: direction {}, {}, {} differs from that of its first row: all points "
                        "of a contour share one direction",
                        list_.where(), list_.current().points_mm.size(), direction[0], direction[1], direction[2])};
      }
    }
    return {};
  }

  ContourList list_;
  bool started_ = false;
  double id_ = 0;
};

}  // namespace

Result<ContourFile> parse_csv(std::string_view text) {
  Rows rows;
  std::optional<Error> error;
  GRAVURE_CHECK(read_csv_rows(
      text, {"contours", "id, then x, y, z in mm and the direction u, v, w: seven numbers and no more", 7},
      [&](std::span<const double> row) {
        if (!error) {
          if (const Result<void> added = rows.add(row); !added) {
            error = added.error();
          }
        }
      }));
  if (error) {
    return *error;
  }
  return std::move(rows).finish();
}

}  // namespace gravure::formats::contour_file
