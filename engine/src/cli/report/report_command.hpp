#pragma once

#include "verb.hpp"

namespace gravure::cli {

void add_report(CLI::App& app, Command& command);
void add_preview(CLI::App& app, Command& command);

}  // namespace gravure::cli
