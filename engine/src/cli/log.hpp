#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <string_view>

namespace gravure::cli {

/// What may go to standard error, the most important first.
enum class LogLevel : std::uint8_t { error, warning, info, debug };

/// Adds --log-level to every verb below `app` that has none of its own below it: to be called once all are there.
void add_log_level(CLI::App& app);

bool is_logged(LogLevel level);

/// "gravure: warning: ..." on standard error, where --log-level asks for it; the name of the level is coloured on a
/// terminal alone, and not where NO_COLOR is set (no-color.org). `text` is shown as printable() makes it.
void log(LogLevel level, std::string_view text);

}  // namespace gravure::cli
