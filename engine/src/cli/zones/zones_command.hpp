#pragma once

#include "verb.hpp"

namespace gravure::cli {

/// The verbs of `gravure zones`.
void add_zones(CLI::App& app, Command& command);

}  // namespace gravure::cli
