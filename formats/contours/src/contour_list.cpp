#include "contour_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gravure::formats::contour_file {
namespace {

/// A direction shorter than this points nowhere in particular.
constexpr double kLeastLength = 1e-9;
constexpr double kMostComponent = 1e9;
/// Written with so many digits, a direction of length 1 may be this far off: nobody needs to be told.
constexpr double kSilent = 1e-6;

}  // namespace

UnitVector unit_vector(const std::array<double, 3>& direction) {
  const double length =
      std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
  // What is of length 1 to the last bits stays as it is, so that a file written and read again is the same.
  constexpr double kRounding = 1e-15;
  if (std::abs(length - 1) <= kRounding) {
    return {direction, length};
  }
  return {{direction[0] / length, direction[1] / length, direction[2] / length}, length};
}

std::string ContourList::where() const {
  return has_id_ ? fmt::format("contours[{}] (id {})", size(), current_.id) : fmt::format("contours[{}]", size());
}

Error ContourList::bad(const std::string& problem, ErrorCode code) const {
  return {code, where() + ": " + problem};
}

Result<void> ContourList::set_id(double value) {
  if (!(std::abs(value) <= static_cast<double>(kMaxContourId)) || std::trunc(value) != value) {
    return bad(fmt::format("id = {}: must be an integer from -(2^53 - 1) to 2^53 - 1", value), ErrorCode::out_of_range);
  }
  current_.id = static_cast<std::int64_t>(value);
  has_id_ = true;
  return {};
}

Result<void> ContourList::add_point(const std::array<double, 3>& point) {
  const std::size_t number = current_.points_mm.size();
  for (std::size_t k = 0; k < point.size(); ++k) {
    if (!(std::abs(point[k]) <= kMaxContourMm)) {
      return bad(fmt::format("points[{}]: {} = {}: must be from -{:.0f} to {:.0f} mm", number, "xyz"[k], point[k],
                             kMaxContourMm, kMaxContourMm),
                 ErrorCode::out_of_range);
    }
  }
  if (++points_ > kMaxContourPoints) {
    return bad(fmt::format("points[{}]: more than {} points in all: thin the contours or take several files", number,
                           kMaxContourPoints));
  }
  current_.points_mm.push_back(point);
  return {};
}

Result<void> ContourList::set_direction(const std::array<double, 3>& direction) {
  for (const double component : direction) {
    if (!(std::abs(component) <= kMostComponent)) {
      return bad(fmt::format("direction: {} must be from -1e9 to 1e9", component), ErrorCode::out_of_range);
    }
  }
  const UnitVector unit = unit_vector(direction);
  if (!(unit.length >= kLeastLength)) {
    return bad(fmt::format("direction has length {}: it must point from the surface towards the head", unit.length));
  }
  if (std::abs(unit.length - 1) > kSilent) {
    ++renormalised_;
    least_length_ = std::min(least_length_, unit.length);
    most_length_ = std::max(most_length_, unit.length);
  }
  current_.direction = unit.direction;
  return {};
}

Result<void> ContourList::end_contour() {
  if (current_.points_mm.size() < 2) {
    return bad(fmt::format("has {} point{}: must have two or more", current_.points_mm.size(),
                           current_.points_mm.size() == 1 ? "" : "s"));
  }
  const auto& first = current_.points_mm.front();
  if (std::all_of(current_.points_mm.begin(), current_.points_mm.end(), [&](const auto& p) { return p == first; })) {
    return bad("all its points are one: it has no length");
  }
  if (!ids_.insert(current_.id).second) {
    return bad("its id has been there before: give each contour another one");
  }
  if (size() >= kMaxContours) {
    return bad(fmt::format("more than {} contours: take several files", kMaxContours));
  }
  current_.points_mm.shrink_to_fit();
  file_.contours.push_back(std::exchange(current_, {}));
  has_id_ = false;
  return {};
}

Result<ContourFile> ContourList::finish() && {
  if (file_.contours.empty()) {
    return Error{ErrorCode::bad_file, "no contour in it"};
  }
  if (renormalised_ > 0) {
    note(fmt::format("{} of {} directions were not of length 1 ({:.6g} to {:.6g}) and were made so", renormalised_,
                     size(), least_length_, most_length_));
  }
  return std::move(file_);
}

}  // namespace gravure::formats::contour_file
