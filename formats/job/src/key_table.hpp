#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gravure/core/job.hpp"
#include "src/key_spec.hpp"

namespace gravure::job_file {

using Key = StoredKey<Job>;

std::span<const Key> key_table();

/// The sections in the order of the documentation.
std::span<const std::string_view> section_names();

/// Names whose tables are sections of their own: "twin" of "twin.servo".
std::span<const std::string_view> parent_names();

/// May every job leave the section out?
bool section_is_optional(std::string_view section);

/// The key's row, or null.
const Key* find_key(std::string_view section, std::string_view key);

/// `mode` words of jobs that have keys of their own.
std::span<const std::string_view> other_modes();

/// The mode that `mode = "word"` asks for, where it is one of these.
std::optional<Mode> mode_of(std::string_view word);

/// Does a job of this mode have the section?
bool section_is_of(std::string_view section, Mode mode);

}  // namespace gravure::job_file
