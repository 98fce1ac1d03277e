#include "plan_reader.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "plan_names.hpp"

namespace gravure::plan_json {
namespace {

// The longest numbers a plan can hold come from decimals of 400 digits times pi; the rest is head room.
constexpr std::size_t kMostDigits = 4000;

/// The value of "-12": digits without a leading 0 (which would make them octal), or nothing.
std::optional<Integer> parse_digits(const std::string& text) {
  const std::string_view digits = std::string_view(text).substr(text.starts_with('-') ? 1 : 0);
  const bool plain = std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!plain || digits.empty() || digits.size() > kMostDigits || (digits[0] == '0' && digits.size() > 1)) {
    return std::nullopt;
  }
  return Integer(text);
}

}  // namespace

void PlanReader::fail(const std::string& key, const std::string& problem) {
  if (!error_) {
    error_ = Error{ErrorCode::bad_file, "plan: " + stack_.back().path + key + " " + problem};
  }
}

const PlanReader::Json* PlanReader::find(const char* key) {
  if (error_) {
    return nullptr;
  }
  const Json& object = *stack_.back().object;
  const auto at = object.find(key);
  if (at == object.end()) {
    fail(key, "is missing");
    return nullptr;
  }
  return &*at;
}

std::optional<Integer> PlanReader::whole(const char* key, const Json& value) {
  std::optional<Integer> number;
  if (value.is_number_unsigned()) {
    number = value.get<std::uint64_t>();
  } else if (value.is_number_integer()) {
    number = value.get<std::int64_t>();
  } else if (value.is_string()) {
    number = parse_digits(value.get_ref<const std::string&>());
  }
  if (!number) {
    fail(key, "must be a whole number, or a string of its digits");
  }
  return number;
}

std::optional<Rational> PlanReader::parts(const char* key, const Json& value) {
  if (!value.is_object() || !value.contains("num") || !value.contains("den")) {
    fail(key, R"(must be {"num": .., "den": ..})");
    return std::nullopt;
  }
  const std::optional<Integer> num = whole(key, value["num"]);
  const std::optional<Integer> den = whole(key, value["den"]);
  if (!num || !den) {
    return std::nullopt;
  }
  if (*den <= 0) {
    fail(key, "has den = " + to_string(*den) + ": must be at least 1");
    return std::nullopt;
  }
  return ratio(*num, *den);
}

void PlanReader::field(const char* key, Integer& value) {
  if (const Json* json = find(key)) {
    value = whole(key, *json).value_or(0);
  }
}

void PlanReader::field(const char* key, std::int64_t& value) {
  Integer number;
  field(key, number);
  if (!fits_int64(number)) {
    fail(key, "= " + to_string(number) + " is beyond 64-bit integers");
    return;
  }
  value = static_cast<std::int64_t>(number);
}

void PlanReader::field(const char* key, std::uint64_t& value) {
  Integer number;
  field(key, number);
  if (!fits_uint64(number)) {
    fail(key, "= " + to_string(number) + " must be 0 to 2^64 - 1");
    return;
  }
  value = static_cast<std::uint64_t>(number);
}

void PlanReader::field(const char* key, int& value) {
  Integer number;
  field(key, number);
  if (number < 0 || number > std::numeric_limits<int>::max()) {
    fail(key, "= " + to_string(number) + " is out of range");
    return;
  }
  value = static_cast<int>(number);
}

void PlanReader::field(const char* key, bool& value) {
  const Json* json = find(key);
  if (json != nullptr && !json->is_boolean()) {
    fail(key, "must be true or false");
  } else if (json != nullptr) {
    value = json->get<bool>();
  }
}

void PlanReader::field(const char* key, std::string& value) {
  const Json* json = find(key);
  if (json != nullptr && !json->is_string()) {
    fail(key, "must be a string");
  } else if (json != nullptr) {
    value = json->get_ref<const std::string&>();
  }
}

void PlanReader::field(const char* key, std::vector<std::string>& value) {
  const Json* json = find(key);
  if (json == nullptr) {
    return;
  }
  const auto is_text = [](const Json& entry) { return entry.is_string(); };
  if (!json->is_array() || !std::all_of(json->begin(), json->end(), is_text)) {
    fail(key, "must be a list of strings");
    return;
  }
  value = json->get<std::vector<std::string>>();
}

void PlanReader::field(const char* key, std::vector<SpinSegment>& value) {
  const Json* json = find(key);
  if (json == nullptr) {
    return;
  }
  const auto is_pair = [](const Json& entry) { return entry.is_array() && entry.size() == 2; };
  if (!json->is_array() || !std::all_of(json->begin(), json->end(), is_pair)) {
    fail(key, "must be a list of pairs [increment, seed clocks]");
    return;
  }
  for (const Json& entry : *json) {
    const Integer increment = whole(key, entry[0]).value_or(-1);
    const Integer seeds = whole(key, entry[1]).value_or(-1);
    if (!fits_uint64(increment) || !fits_int64(seeds)) {
      fail(key, "holds a pair beyond 64-bit integers");
      return;
    }
    value.push_back({static_cast<std::uint64_t>(increment), static_cast<std::int64_t>(seeds)});
  }
}

void PlanReader::field(const char* key, Mode& mode) {
  std::string name;
  field(key, name);
  for (const ModeName& entry : kModeNames) {
    if (entry.name == name) {
      mode = entry.mode;
      return;
    }
  }
  fail(key, "= \"" + name.substr(0, 40) + "\" is none of the known modes");
}

void PlanReader::field(const char* key, std::optional<Integer>& value) {
  const Json* json = find(key);
  if (json != nullptr && json->is_null()) {
    value.reset();
  } else if (json != nullptr) {
    value = whole(key, *json);
  }
}

void PlanReader::exact_field(const char* key, Rational& value) {
  if (const Json* json = find(key)) {
    value = parts(key, *json).value_or(0);
  }
}

void PlanReader::field(const char* key, Rational& value) {
  const Json* plain = find(key);
  section("ratios", [&] { exact_field(key, value); });
  if (plain == nullptr || error_) {
    return;
  }
  if (!plain->is_number()) {
    fail(key, "must be a number");
  } else if (plain->get<double>() != to_double(value)) {
    fail(key, "= " + plain->dump() + " is not ratios." + key + " = " + to_string(value).substr(0, 80));
  }
}

void PlanReader::field(const char* key, std::optional<Rational>& value) {
  const Json* json = find(key);
  value.reset();
  if (json != nullptr && !json->is_null()) {
    field(key, value.emplace());
  }
}

}  // namespace gravure::plan_json
