#include "gravure/zones/piece.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gravure/zones/local_frame.hpp"

namespace gravure::zones {
namespace {

constexpr std::size_t kMostPieces = 10'000;

Vector3 vector_of(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

/// The box that a part fills in its local x and y.
struct Box {
  double least[2];
  double most[2];

  explicit Box(const Vector3& point) : least{point.x(), point.y()}, most{point.x(), point.y()} {}
  void add(const Vector3& point) {
    for (int k = 0; k < 2; ++k) {
      least[k] = std::min(least[k], point[k]);
      most[k] = std::max(most[k], point[k]);
    }
  }
};

/// How far of the way from a to b the box stays within the field, 1: all of it.
double share_inside(const Box& box, const Vector3& a, const Vector3& b, double field_mm) {
  double share = 1;
  for (int k = 0; k < 2; ++k) {
    const double way = b[k] - a[k];
    const double limit = way > 0 ? box.least[k] + field_mm : box.most[k] - field_mm;
    if ((way > 0 && b[k] > limit) || (way < 0 && b[k] < limit)) {
      share = std::min(share, std::max(0.0, (limit - a[k]) / way));
    }
  }
  return share;
}

/// Cuts one contour; `pieces` gets its parts.
Result<void> cut_contour(const Contour& contour, std::size_t number, double field_mm, std::vector<Piece>& pieces) {
  GRAVURE_TRY(const LocalFrame frame, local_frame(vector_of(contour.direction), Vector3::Zero()));
  Vector3 from = vector_of(contour.points_mm[0]);
  Box box(frame.to_local(from));
  pieces.push_back({number, 0, {from}, frame.z});
  for (std::size_t i = 1; i < contour.points_mm.size();) {
    const Vector3 to = vector_of(contour.points_mm[i]);
    const Vector3 a = frame.to_local(from);
    const Vector3 b = frame.to_local(to);
    const double share = share_inside(box, a, b, field_mm);
    if (share >= 1) {
      pieces.back().points_mm.push_back(to);
      box.add(b);
      from = to;
      ++i;
      continue;
    }
    if (pieces.size() >= kMostPieces) {
      return Error{
          ErrorCode::out_of_range,
          fmt::format(
              "field_mm = {:.6g}: the contours would be cut into more than {} parts: give a larger field, or part "
              "of the contours",
              field_mm, kMostPieces)};
    }
    const Vector3 cut = from + share * (to - from);
    if (cut != from) {
      pieces.back().points_mm.push_back(cut);
    }
    // A part that ends where it begins has used up the field by one corner: the next begins there all the same.
    pieces.push_back({number, pieces.back().part + 1, {cut}, frame.z});
    from = cut;
    box = Box(frame.to_local(cut));
  }
  return {};
}

}  // namespace

double length_mm(const std::vector<Vector3>& points) noexcept {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    sum += (points[i] - points[i - 1]).norm();
  }
  return sum;
}

Result<std::vector<Piece>> cut_to_field(const std::vector<Contour>& contours, double field_mm) {
  constexpr double kLeastField = 5e-4;  // 1 um, less the room for the swing of the mirrors
  if (!(field_mm >= kLeastField) || !std::isfinite(field_mm)) {
    return Error{ErrorCode::out_of_range, fmt::format("field_mm = {}: must be {} or more", field_mm, kLeastField)};
  }
  if (contours.size() > kMostPieces) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("{} contours: zones are made of at most {} at a time: take several "
                             "jobs, one for each side of the part",
                             contours.size(), kMostPieces)};
  }
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    if (contours[i].points_mm.size() < 2) {
      return Error{ErrorCode::bad_argument, fmt::format("contour {}: must have two points or more", contours[i].id)};
    }
    GRAVURE_CHECK(cut_contour(contours[i], i, field_mm, pieces));
  }
  return pieces;
}

}  // namespace gravure::zones
