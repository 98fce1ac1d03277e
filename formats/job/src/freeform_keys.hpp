#pragma once

#include <span>
#include <string_view>

#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/toml/violations.hpp"
#include "src/key_spec.hpp"

namespace gravure::freeform_file {

using namespace job_file;

using Key = StoredKey<FreeformJob>;

std::span<const Key> key_table();

/// The sections in the order of the documentation.
std::span<const std::string_view> section_names();
/// Names whose tables are sections of their own: "axis" of "axis.X".
std::span<const std::string_view> parent_names();
/// Must every job have the section?
bool section_is_required(std::string_view section);

/// The key's row, or null.
const Key* find_key(std::string_view section, std::string_view key);

/// What one key says about another: which exclude or need each other. Keys count as given where they stand in the file,
/// even with a wrong value.
void check_rules(const Document& document, Violations& violations);

}  // namespace gravure::freeform_file
