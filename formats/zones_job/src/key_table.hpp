#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gravure/formats/toml/document.hpp"

namespace gravure::zones_job_file {

using namespace toml_file;

enum class Type : std::uint8_t { integer, decimal, boolean, text, word };

struct KeySpec {
  std::string_view section;
  std::string_view key;
  Type type;
  std::string_view unit;
  std::string_view low;  ///< numbers: smallest and largest value allowed, as the file would write them
  std::string_view high;
  std::span<const std::string_view> words;
  std::string_view fallback;  ///< "required", or what a missing key stands for

  bool is_required() const { return fallback == "required"; }
};

inline constexpr std::size_t kMaxTextBytes = 4096;

std::span<const KeySpec> key_table();
/// One of key_table(), or none.
const KeySpec* find_key(std::string_view section, std::string_view key);
bool is_section(std::string_view name);

/// What the value may be.
std::string range_text(const KeySpec& spec);
/// "a number from -1 to 1 mm": what the value must be.
std::string expectation(const KeySpec& spec);

}  // namespace gravure::zones_job_file
