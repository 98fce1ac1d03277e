#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gravure/formats/toml/document.hpp"

namespace gravure::job_file {

using namespace toml_file;

enum class Type : std::uint8_t {
  boolean,
  integer,
  decimal,
  title,
  text,  ///< as long as a path
  path,
  paths,
  word,
  two_integers,
  two_decimals,
  three_decimals,
};

enum class Presence : std::uint8_t {
  required,
  optional,
  decided,  ///< whether it must be there depends on other keys
};

/// What a reader knows about one key: the single source for checking, messages and documentation.
struct KeySpec {
  std::string_view section;
  std::string_view key;
  Type type = Type::text;
  std::string_view unit = {};
  std::string_view low = {};  ///< numbers: smallest and largest value allowed, as the file would write them
  std::string_view high = {};
  std::span<const std::string_view> words = {};
  Presence presence = Presence::optional;
  std::string_view fallback = {};  ///< for the documentation
};

/// The same with what is done with a value that has passed: the single source for storing, too.
template <class Target>
struct StoredKey : KeySpec {
  void (*store)(Target& target, const Value& value);
};

inline constexpr std::string_view kRequired = "required";

constexpr Presence presence_of(std::string_view fallback) {
  return fallback == kRequired ? Presence::required : Presence::optional;
}

inline constexpr std::size_t kMaxTitleBytes = 200;
inline constexpr std::size_t kMaxPathBytes = 4095;  ///< longest path Linux takes

/// Where a word stands among those allowed, which an enumeration counts as well.
template <class Enum>
Enum enum_of(std::span<const std::string_view> words, const Value& value) {
  return static_cast<Enum>(std::find(words.begin(), words.end(), value.text) - words.begin());
}

/// "integer", "two decimals": for documentation.
std::string type_name(Type type);

/// "1 to 1_000_000", "\"rows\" or \"columns\"": what the value may be, for documentation and messages.
std::string range_text(const KeySpec& spec);

/// "an integer, 1 to 1_000_000 Hz": what the value must be.
std::string expectation(const KeySpec& spec);

}  // namespace gravure::job_file
