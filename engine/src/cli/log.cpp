#include "log.hpp"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "verb.hpp"

namespace gravure::cli {
namespace {

const std::map<std::string, LogLevel> kLevels = {
    {"error", LogLevel::error}, {"warning", LogLevel::warning}, {"info", LogLevel::info}, {"debug", LogLevel::debug}};
LogLevel the_level = LogLevel::info;

/// As it stands before the text; info says nothing of itself.
constexpr std::array<std::string_view, 4> kNames = {"error: ", "warning: ", "", "debug: "};
constexpr std::array<std::string_view, 4> kColours = {"\033[1;31m", "\033[1;33m", "", "\033[2m"};

bool colours_shown() {
  static const bool shown = [] {
    const char* refused = std::getenv("NO_COLOR");
    const char* terminal = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && (refused == nullptr || *refused == '\0') && terminal != nullptr &&
           std::string_view(terminal) != "dumb";
  }();
  return shown;
}

}  // namespace

void add_log_level(CLI::App& app) {
  const std::vector<CLI::App*> verbs = app.get_subcommands([](CLI::App*) { return true; });
  for (CLI::App* verb : verbs) {
    add_log_level(*verb);
  }
  if (verbs.empty()) {
    app.add_option_function<std::string>(
           "--log-level", [](const std::string& name) { the_level = kLevels.at(name); },
           "What goes to standard error: this and what is more important (default info)")
        ->check(CLI::IsMember({"error", "warning", "info", "debug"}));
  }
}

bool is_logged(LogLevel level) {
  return level <= the_level;
}

void log(LogLevel level, std::string_view text) {
  if (!is_logged(level)) {
    return;
  }
  const auto at = static_cast<std::size_t>(level);
  const bool coloured = colours_shown() && !kColours[at].empty();
  const std::string line = "gravure: " + std::string(coloured ? kColours[at] : "") + std::string(kNames[at]) +
                           (coloured ? "\033[0m" : "") + printable(text) + "\n";
  static_cast<void>(std::fwrite(line.data(), 1, line.size(), stderr));
}

}  // namespace gravure::cli
