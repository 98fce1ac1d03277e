#include "src/key_spec.hpp"

namespace gravure::job_file {
namespace {

std::string either(std::span<const std::string_view> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += i == 0 ? "" : i + 1 == words.size() ? " or " : ", ";
    text += "\"" + std::string(words[i]) + "\"";
  }
  return text;
}

std::string with_unit(const std::string& text, std::string_view unit) {
  return unit.empty() ? text : text + " " + std::string(unit);
}

}  // namespace

std::string type_name(Type type) {
  switch (type) {
    case Type::boolean:
      return "boolean";
    case Type::integer:
      return "integer";
    case Type::decimal:
      return "decimal";
    case Type::title:
    case Type::text:
    case Type::path:
    case Type::word:
      return "string";
    case Type::paths:
      return "list of strings";
    case Type::two_integers:
      return "two integers";
    case Type::two_decimals:
      return "two decimals";
    case Type::three_decimals:
      return "three decimals";
  }
  return "";
}

std::string range_text(const KeySpec& spec) {
  switch (spec.type) {
    case Type::boolean:
      return "true or false";
    case Type::integer:
    case Type::decimal:
    case Type::two_integers:
    case Type::two_decimals:
    case Type::three_decimals:
      return std::string(spec.low) + " to " + std::string(spec.high);
    case Type::title:
      return "at most " + std::to_string(kMaxTitleBytes) + " bytes, no control characters";
    case Type::text:
    case Type::path:
    case Type::paths:
      return "1 to " + std::to_string(kMaxPathBytes) + " bytes, no control characters";
    case Type::word:
      return either(spec.words);
  }
  return "";
}

std::string expectation(const KeySpec& spec) {
  switch (spec.type) {
    case Type::boolean:
    case Type::word:
      return range_text(spec);
    case Type::integer:
      return with_unit("an integer from " + range_text(spec), spec.unit);
    case Type::decimal:
      return with_unit("a number from " + range_text(spec), spec.unit);
    case Type::two_integers:
      return "[encoder turns, workpiece turns], two integers from " + range_text(spec);
    case Type::two_decimals:
      return with_unit("[first, second], two numbers from " + range_text(spec), spec.unit);
    case Type::three_decimals:
      return with_unit("[x, y, z], three numbers from " + range_text(spec), spec.unit);
    case Type::title:
    case Type::text:
    case Type::path:
      return "a string of " + range_text(spec);
    case Type::paths:
      return "a list of one or more file patterns such as [\"layers/*.tif\"], each " + range_text(spec);
  }
  return "";
}

}  // namespace gravure::job_file
