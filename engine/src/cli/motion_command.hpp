#pragma once

#include <CLI/CLI.hpp>

#include "verb.hpp"

namespace gravure::cli {

/// `gravure motion profile|respond|search|identify|unreverse`.
void add_motion_command(CLI::App& app, Command& command);

/// The two that read recordings and rotary programs.
void add_motion_identify(CLI::App& motion, Command& command);
void add_motion_unreverse(CLI::App& motion, Command& command);

}  // namespace gravure::cli
