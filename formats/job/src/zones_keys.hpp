#pragma once

#include <span>
#include <string_view>

#include "gravure/formats/zones_job.hpp"
#include "src/key_spec.hpp"

namespace gravure::zones_file {

using namespace job_file;

using Key = StoredKey<ZonesJob>;

std::span<const Key> key_table();

/// The sections in the order of the documentation.
std::span<const std::string_view> section_names();
/// Must every job have the section?
bool section_is_required(std::string_view section);

}  // namespace gravure::zones_file
