#pragma once

#include "verb.hpp"

namespace gravure::cli {

/// `gravure zones compile`
void add_zones_compile(CLI::App& zones, Command& command);

}  // namespace gravure::cli
