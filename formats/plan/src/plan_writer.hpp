#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/plan.hpp"

namespace gravure::plan_json {

/// Archive of describe_plan() that fills a JSON object.
class PlanWriter {
 public:
  using Json = nlohmann::ordered_json;

  void field(const char* key, std::int64_t value) { here()[key] = whole(value); }
  void field(const char* key, std::uint64_t value) { here()[key] = whole(value); }
  void field(const char* key, int value) { here()[key] = value; }
  void field(const char* key, bool value) { here()[key] = value; }
  void field(const char* key, const std::string& value) { here()[key] = value; }
  void field(const char* key, const std::vector<std::string>& value) { here()[key] = value; }
  void field(const char* key, const std::vector<SpinSegment>& value);
  void field(const char* key, Mode mode);
  void field(const char* key, const Integer& value) { here()[key] = whole(value); }
  void field(const char* key, const std::optional<Integer>& value);
  void field(const char* key, const Rational& value);
  void field(const char* key, const std::optional<Rational>& value);
  void exact_field(const char* key, const Rational& value) { here()[key] = parts(value); }

  template <class Describe>
  void section(const char* key, const Describe& describe) {
    stack_.emplace_back();
    describe();
    Level done = std::move(stack_.back());
    stack_.pop_back();
    if (!done.ratios.empty()) {
      done.object["ratios"] = std::move(done.ratios);
    }
    here()[key] = std::move(done.object);
  }

  template <class T, class Describe>
  void optional_section(const char* key, const std::optional<T>& value, const Describe& describe) {
    if (value) {
      section(key, [&] { describe(*value); });
    }
  }

  const Json& result() const { return stack_.front().object; }

 private:
  struct Level {
    Json object = Json::object();
    Json ratios = Json::object();  ///< written last
  };

  Json& here() { return stack_.back().object; }
  static Json whole(const Integer& value);
  static Json parts(const Rational& value);

  std::vector<Level> stack_{1};
};

}  // namespace gravure::plan_json
