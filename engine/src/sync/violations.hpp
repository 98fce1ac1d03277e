#pragma once

#include <initializer_list>
#include <set>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"
#include "text.hpp"

namespace gravure::sync_plan {

/// Collects what is wrong with a job, so that one message can say it all, each violation on a line of its own.
class Violations {
 public:
  explicit Violations(const Job& job) : job_(job) {}

  /// A value that is in order by itself but not with others, or not within reach.
  void conflict(ErrorCode code, std::string_view key, const std::string& value, const std::string& problem) {
    add(code, key, " = " + value + ": " + problem);
  }
  /// A value nothing can be computed from: checks that need it are left out (see sound()), or it would be complained
  /// about twice.
  void refuse(ErrorCode code, std::string_view key, const std::string& value, const std::string& problem) {
    conflict(code, key, value, problem);
    refused_.insert(std::string(key));
  }
  /// A key whose absence (or double) is the violation.
  void refuse_missing(std::string_view key, const std::string& problem) {
    add(ErrorCode::bad_argument, key, " " + problem);
    refused_.insert(std::string(key));
  }
  /// Refuses a value outside least..most.
  void check_range(std::string_view key, const Rational& value, const Rational& least, const Rational& most) {
    if (value < least || value > most) {
      refuse(ErrorCode::out_of_range, key, number_text(value),
             "must be " + number_text(least) + " to " + number_text(most));
    }
  }
  /// Refuses a value that is not above 0 or is above most.
  void check_positive(std::string_view key, const Rational& value, const Rational& most) {
    if (value <= 0 || value > most) {
      refuse(ErrorCode::out_of_range, key, number_text(value),
             "must be greater than 0 and at most " + number_text(most));
    }
  }

  /// None of these was refused.
  bool sound(std::initializer_list<std::string_view> keys) const {
    for (const std::string_view key : keys) {
      if (refused_.count(std::string(key)) != 0) {
        return false;
      }
    }
    return true;
  }
  bool none() const { return text_.empty(); }
  Error error() const { return {code_, text_}; }

 private:
  void add(ErrorCode code, std::string_view key, const std::string& rest) {
    code_ = text_.empty() ? code : code_;
    text_ += (text_.empty() ? "" : "\n") + job_.place_of(key) + std::string(key) + rest;
  }

  const Job& job_;
  ErrorCode code_ = ErrorCode::bad_argument;
  std::string text_;
  std::set<std::string> refused_;
};

}  // namespace gravure::sync_plan
