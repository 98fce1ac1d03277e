#pragma once

#include <string>

#include "verb.hpp"

namespace gravure::cli {

/// What `export --nc` does: NC programs of the stages (G-code at inverse-time feed, PVT), frames of the galvo, a table
/// of all axes at every period; each read back and compared with the set-points of the program.
Result<int> export_path(const std::string& program, const std::string& folder, double block_ms, const Command& command);

}  // namespace gravure::cli
