#pragma once

#include <optional>
#include <string>

#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"

namespace gravure::plan_json {

/// Keeps the first complaint.
class Complaint {
 public:
  void unless(bool fine, const std::string& key, const std::string& problem) {
    if (!fine && !error_) {
      error_ = Error{ErrorCode::bad_file, "plan: " + key + " " + problem};
    }
  }
  void least_one(const std::string& key, const Integer& value) {
    unless(value >= 1, key, "= " + to_string(value) + ": must be at least 1");
  }
  void positive(const std::string& key, const Rational& value) {
    unless(value > 0, key, "= " + to_string(value).substr(0, kShown) + ": must be greater than 0");
  }
  /// A figure that follows from the others.
  void equal(const std::string& key, const Rational& value, const Rational& expected) {
    unless(value == expected, key,
           "= " + to_string(value).substr(0, kShown) + ": the rest of the plan gives " +
               to_string(expected).substr(0, kShown));
  }
  Result<void> result() const { return error_ ? Result<void>(*error_) : Result<void>(); }
  bool none() const { return !error_; }

 private:
  static constexpr std::size_t kShown = 80;
  std::optional<Error> error_;
};

}  // namespace gravure::plan_json
