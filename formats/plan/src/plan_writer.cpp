#include "plan_writer.hpp"

#include "plan_names.hpp"

namespace gravure::plan_json {

void PlanWriter::field(const char* key, Mode mode) {
  for (const ModeName& entry : kModeNames) {
    if (entry.mode == mode) {
      here()[key] = entry.name;
    }
  }
}

void PlanWriter::field(const char* key, const std::vector<SpinSegment>& value) {
  Json list = Json::array();
  for (const SpinSegment& segment : value) {
    list.push_back({whole(segment.increment), whole(segment.seeds)});
  }
  here()[key] = std::move(list);
}

void PlanWriter::field(const char* key, const std::optional<Integer>& value) {
  here()[key] = value ? whole(*value) : Json(nullptr);
}

void PlanWriter::field(const char* key, const Rational& value) {
  here()[key] = plain_is_whole(value) ? whole(numerator_of(value)) : Json(to_double(value));
  stack_.back().ratios[key] = parts(value);
}

void PlanWriter::field(const char* key, const std::optional<Rational>& value) {
  if (value) {
    field(key, *value);
  } else {
    here()[key] = nullptr;
  }
}

PlanWriter::Json PlanWriter::whole(const Integer& value) {
  return abs(value) <= kLargestJsonInteger ? Json(static_cast<std::int64_t>(value)) : Json(to_string(value));
}

PlanWriter::Json PlanWriter::parts(const Rational& value) {
  Json object = Json::object();
  object["num"] = whole(numerator_of(value));
  object["den"] = whole(denominator_of(value));
  return object;
}

}  // namespace gravure::plan_json
