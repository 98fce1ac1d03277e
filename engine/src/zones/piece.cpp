#include "gravure/zones/piece.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

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

using Line = std::vector<Vector3>;

/// A place on a line: on the way to a corner.
struct Cut {
  std::size_t corner = 1;
  double share = 0;  ///< of the way from the corner before

  Vector3 of(const Line& line) const { return line[corner - 1] + share * (line[corner] - line[corner - 1]); }
  bool operator<(const Cut& other) const {
    return corner != other.corner ? corner < other.corner : share < other.share;
  }
};
using Cuts = std::vector<Cut>;

/// How far a part that begins at `from` fits the field: `to`, or where it leaves the field before that.
Cut fitting(const Line& line, Cut from, const Cut& to, double field_mm) {
  Box box(from.of(line));
  for (;; from = {from.corner + 1, 0}) {
    const bool is_last = from.corner == to.corner;
    const Cut next{from.corner, is_last ? to.share : 1};
    const Vector3 point = next.of(line);
    const double share = share_inside(box, from.of(line), point, field_mm);
    if (share < 1) {
      return {from.corner, from.share + share * (next.share - from.share)};
    }
    if (is_last) {
      return to;
    }
    box.add(point);
  }
}

/// Cuts a line in the frame of its contour where it leaves the field; nothing where `most` cuts are not enough.
///
/// No fewer cuts do: what fits the field still fits it without its beginning.
std::optional<Cuts> cut_at_edges(const Line& line, double field_mm, std::size_t most) {
  const Cut end{line.size() - 1, 1};
  Cuts cuts;
  for (Cut at = fitting(line, {}, end, field_mm); at < end; at = fitting(line, at, end, field_mm)) {
    if (cuts.size() >= most) {
      return std::nullopt;
    }
    cuts.push_back(at);
  }
  return cuts;
}

/// As few parts as fit the field, of equal length as far as they do: a remnant of micrometres would become a zone of
/// its own, and a part as wide as the field fits it from one direction alone.
std::optional<Cuts> cut_evenly(const Line& line, double field_mm, std::size_t most) {
  std::optional<Cuts> cuts = cut_at_edges(line, field_mm, most);
  if (!cuts || cuts->empty()) {
    return cuts;
  }
  // Cut from its end, a line shows how early each cut may be: what comes after it still fits as many fields.
  const std::optional<Cuts> from_end = cut_at_edges({line.rbegin(), line.rend()}, field_mm, cuts->size());
  if (!from_end || from_end->size() != cuts->size()) {  // by rounding
    return cuts;
  }
  std::vector<double> along{0};
  for (std::size_t i = 1; i < line.size(); ++i) {
    along.push_back(along.back() + (line[i] - line[i - 1]).norm());
  }
  Cut from;
  for (std::size_t i = 0; i < cuts->size(); ++i) {
    const Cut& mirrored = (*from_end)[cuts->size() - 1 - i];
    const Cut earliest{line.size() - mirrored.corner, 1 - mirrored.share};
    const double begin = along[from.corner - 1] + from.share * (along[from.corner] - along[from.corner - 1]);
    const double end = begin + (along.back() - begin) / static_cast<double>(cuts->size() + 1 - i);
    const auto after = std::upper_bound(along.begin() + 1, along.end() - 1, end);
    const Cut equal{static_cast<std::size_t>(after - along.begin()), (end - *(after - 1)) / (*after - *(after - 1))};
    from = std::max(fitting(line, from, std::max({from, equal, earliest}), field_mm), earliest);
    (*cuts)[i] = from;
  }
  return cuts;
}

std::vector<Line> parts_of(const Line& line, const Cuts& cuts) {
  std::vector<Line> parts{{line[0]}};
  auto cut = cuts.begin();
  for (std::size_t i = 1; i < line.size(); ++i) {
    for (; cut != cuts.end() && cut->corner == i; ++cut) {
      const Vector3 point = cut->of(line);
      if (point != parts.back().back()) {
        parts.back().push_back(point);
      }
      parts.push_back({point});
    }
    parts.back().push_back(line[i]);
  }
  return parts;
}

/// Cuts one contour; `pieces` gets its parts.
Result<void> cut_contour(const Contour& contour, std::size_t number, double field_mm, std::vector<Piece>& pieces) {
  GRAVURE_TRY(const LocalFrame frame, local_frame(vector_of(contour.direction), Vector3::Zero()));
  const Line whole = points_of(contour);
  Line local;
  for (const Vector3& point : whole) {
    local.push_back(frame.to_local(point));
  }
  const std::size_t most = kMostPieces - std::min(kMostPieces, pieces.size() + 1);
  const std::optional<Cuts> cuts = cut_evenly(local, field_mm, most);
  if (!cuts) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format(
            "field_mm = {:.6g}: the contours would be cut into more than {} parts: give a larger field, or part "
            "of the contours",
            field_mm, kMostPieces)};
  }
  std::vector<Line> parts = parts_of(whole, *cuts);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    pieces.push_back({number, part, std::move(parts[part]), frame.z});
  }
  return {};
}

}  // namespace

std::vector<Vector3> points_of(const Contour& contour) {
  std::vector<Vector3> points;
  points.reserve(contour.points_mm.size());
  std::transform(contour.points_mm.begin(), contour.points_mm.end(), std::back_inserter(points), vector_of);
  return points;
}

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
