#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::plan_json {

/// Archive of describe_plan() that takes the fields from a JSON object. After the first failure it does nothing more;
/// error() tells what it was.
class PlanReader {
 public:
  using Json = nlohmann::json;

  explicit PlanReader(const Json& root) : stack_{{&root, ""}} {}

  void field(const char* key, std::int64_t& value);
  void field(const char* key, std::uint64_t& value);
  void field(const char* key, int& value);
  void field(const char* key, bool& value);
  void field(const char* key, std::string& value);
  void field(const char* key, std::vector<std::string>& value);
  void field(const char* key, std::vector<SpinSegment>& value);
  void field(const char* key, Mode& mode);
  void field(const char* key, Integer& value);
  void field(const char* key, std::optional<Integer>& value);
  void field(const char* key, Rational& value);
  void field(const char* key, std::optional<Rational>& value);
  void exact_field(const char* key, Rational& value);

  template <class Describe>
  void section(const char* key, const Describe& describe) {
    const Json* object = find(key);
    if (object == nullptr) {
      return;
    }
    if (!object->is_object()) {
      fail(key, "must be an object");
      return;
    }
    stack_.push_back({object, stack_.back().path + key + "."});
    describe();
    stack_.pop_back();
  }

  template <class T, class Describe>
  void optional_section(const char* key, std::optional<T>& value, const Describe& describe) {
    value.reset();
    if (!error_ && stack_.back().object->contains(key)) {
      section(key, [&] { describe(value.emplace()); });
    }
  }

  const std::optional<Error>& error() const { return error_; }

 private:
  struct Level {
    const Json* object;
    std::string path;
  };

  /// The value of a key that must be there; nullptr after a failure.
  const Json* find(const char* key);
  std::optional<Integer> whole(const char* key, const Json& value);
  std::optional<Rational> parts(const char* key, const Json& value);
  void fail(const std::string& key, const std::string& problem);

  std::vector<Level> stack_;
  std::optional<Error> error_;
};

}  // namespace gravure::plan_json
