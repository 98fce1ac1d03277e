#pragma once

#include <CLI/CLI.hpp>

#include "verb.hpp"

namespace gravure::cli {

/// `gravure motion profile|respond|search|identify|unreverse`.
void add_motion_command(CLI::App& app, Command& command);

/// Its verbs that have a file of their own.
void add_motion_profile(CLI::App& motion, Command& command);
void add_motion_identify(CLI::App& motion, Command& command);
void add_motion_unreverse(CLI::App& motion, Command& command);

}  // namespace gravure::cli
