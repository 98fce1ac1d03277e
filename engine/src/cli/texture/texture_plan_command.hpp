#pragma once

#include "verb.hpp"

namespace gravure::cli {

/// `gravure texture plan`.
void add_texture_plan(CLI::App& texture, Command& command);

}  // namespace gravure::cli
