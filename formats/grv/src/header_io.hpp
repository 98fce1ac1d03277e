#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"
#include "layout.hpp"

namespace gravure::grv {

/// The parts of a program file that stand beside its bits. Everything here is called within an Hdf5Session; messages
/// name the object, the caller puts the file's name in front.

/// Format, version and units of the whole file.
Result<void> write_root(hid_t file, std::uint32_t format_version);
/// /plan, /job, /sources, /revolutions and the tables of /layers that come from the header.
Result<void> write_header(hid_t file, hid_t layers_group, const ProgramHeader& header);

/// Reads all that write_root() and write_header() wrote, and holds the plan's numbers beside the JSON against it.
/// `format_version` is that of the seal.
Result<ProgramHeader> read_header(hid_t file, const Layout& layout, bool shard, std::uint32_t format_version);

}  // namespace gravure::grv
