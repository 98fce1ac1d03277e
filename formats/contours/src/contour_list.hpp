#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_set>

#include "gravure/formats/contours.hpp"

namespace gravure::formats::contour_file {

/// Contours as a reader finds them, held against what is allowed.
class ContourList {
 public:
  /// "contours[3] (id 7)", for messages about the contour that is read.
  std::string where() const;
  std::size_t size() const noexcept { return file_.contours.size(); }
  Contour& current() noexcept { return current_; }

  Result<void> set_id(double value);
  Result<void> add_point(const std::array<double, 3>& point);
  /// Makes it of length 1.
  Result<void> set_direction(const std::array<double, 3>& direction);
  /// Takes the current contour over and begins another.
  Result<void> end_contour();
  Result<ContourFile> finish() &&;
  void note(std::string text) { file_.notes.push_back(std::move(text)); }

 private:
  Error bad(const std::string& problem, ErrorCode code = ErrorCode::bad_file) const;

  ContourFile file_;
  Contour current_;
  bool has_id_ = false;
  std::size_t points_ = 0;
  std::unordered_set<std::int64_t> ids_;
  std::size_t renormalised_ = 0;
  double least_length_ = 1;
  double most_length_ = 1;
};

/// A vector of length 1 along `direction`, and the length that it had.
struct UnitVector {
  std::array<double, 3> direction;
  double length = 0;
};
UnitVector unit_vector(const std::array<double, 3>& direction);

/// The two forms, without the name of the file in their errors.
Result<ContourFile> parse_json(std::string_view text);
Result<ContourFile> parse_csv(std::string_view text);

}  // namespace gravure::formats::contour_file
