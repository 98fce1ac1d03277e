#pragma once

#include <span>
#include <string>
#include <string_view>

#include "gravure/formats/toml/edit_distance.hpp"
#include "gravure/formats/toml/violations.hpp"
#include "src/key_spec.hpp"

namespace gravure::job_file {

/// "[laser]", safe to print.
std::string bracketed(std::string_view section);

bool contains(std::span<const std::string_view> words, std::string_view word);

/// May the value be stored? What is wrong with it is told with its place.
bool check_value(const KeySpec& spec, const Value& value, Violations& violations);

/// What to say of a key nobody knows: the section it belongs to, or the key it resembles.
Suggestion key_advice(std::string_view section, std::string_view key, std::span<const KeySpec* const> known,
                      const Violations& violations);
/// The same of a section.
Suggestion section_advice(std::string_view wrong, std::span<const std::string_view> known,
                          const Violations& violations);

}  // namespace gravure::job_file
