#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gravure/core/job.hpp"
#include "gravure/formats/toml/document.hpp"

namespace gravure::job_file {

using namespace toml_file;

enum class Type : std::uint8_t { boolean, integer, decimal, title, path, paths, word, two_integers };

enum class Presence : std::uint8_t {
  required,
  optional,
  decided,  ///< whether it must be there depends on other keys (job_rules.cpp)
};

/// What the reader knows about one key: the single source for checking, storing, messages and documentation.
struct KeySpec {
  std::string_view section;
  std::string_view key;
  Type type;
  std::string_view unit;
  std::string_view low;   ///< numbers: smallest and largest value allowed, as the file would write them
  std::string_view high;  ///< words: unused
  std::span<const std::string_view> words;
  Presence presence;
  std::string_view fallback;  ///< for the documentation
  void (*store)(Job& job, const Value& value);
};

inline constexpr std::size_t kMaxTitleBytes = 200;
inline constexpr std::size_t kMaxPathBytes = 4095;  ///< longest path Linux takes

std::span<const KeySpec> key_table();

/// The sections in the order of the documentation.
std::span<const std::string_view> section_names();

/// Names whose tables are sections of their own: "twin" of "twin.servo".
std::span<const std::string_view> parent_names();

/// May every job leave the section out?
bool section_is_optional(std::string_view section);

/// The key's row, or null.
const KeySpec* find_key(std::string_view section, std::string_view key);

/// `mode` words that a later version will run.
std::span<const std::string_view> later_modes();

/// The mode that `mode = "word"` asks for, where this version runs it.
std::optional<Mode> mode_of(std::string_view word);

/// Does a job of this mode have the section?
bool section_is_of(std::string_view section, Mode mode);

/// "1 to 1_000_000", "\"rows\" or \"columns\"": what the value may be, for documentation and messages.
std::string range_text(const KeySpec& spec);

/// "an integer, 1 to 1_000_000 Hz": what the value must be.
std::string expectation(const KeySpec& spec);

}  // namespace gravure::job_file
