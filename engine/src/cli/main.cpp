#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/formats/grv.hpp"
#include "log.hpp"
#include "motion/motion_command.hpp"
#include "report/report_command.hpp"
#include "texture/texture_command.hpp"
#include "verb.hpp"
#include "zones/zones_command.hpp"

namespace {

using gravure::Error;
using gravure::Result;
using gravure::cli::Command;

extern "C" void on_signal(int) {
  gravure::cli::interrupt();
}

void watch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  // A second Ctrl-C ends at once; nothing half-written shows. Reads of libraries go on: they would take an interrupted
  // one for the end of the file.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  // A closed pipe and a file too large are write errors like any other: reported, and nothing half-written.
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);
}

int report(const Error& error, bool json) {
  gravure::cli::log(gravure::cli::LogLevel::error, error.message);
  if (json) {
    gravure::cli::print_json({{"error", {{"code", gravure::error_code_name(error.code)}, {"message", error.message}}}});
  }
  return gravure::exit_status(error.code);
}

struct Verb {
  std::string_view name;
  void (*add)(CLI::App&, Command&);
};

/// In the order in which --help shows them.
constexpr std::array<Verb, 26> kVerbs = {{
    {"init", gravure::cli::add_init},
    {"plan", gravure::cli::add_plan},
    {"suggest", gravure::cli::add_suggest},
    {"slice", gravure::cli::add_slice},
    {"compile", gravure::cli::add_compile},
    {"merge", gravure::cli::add_merge},
    {"inspect", gravure::cli::add_inspect},
    {"dump", gravure::cli::add_dump},
    {"unroll", gravure::cli::add_unroll},
    {"verify", gravure::cli::add_verify},
    {"report", gravure::cli::add_report},
    {"preview", gravure::cli::add_preview},
    {"emulate", gravure::cli::add_emulate},
    {"run", gravure::cli::add_run},
    {"exposure", gravure::cli::add_exposure},
    {"trajectory", gravure::cli::add_trajectory},
    {"export", gravure::cli::add_export},
    {"calibrate", gravure::cli::add_calibrate},
    {"register", gravure::cli::add_register},
    {"devices", gravure::cli::add_devices},
    {"motion", gravure::cli::add_motion_command},
    {"texture", gravure::cli::add_texture},
    {"zones", gravure::cli::add_zones},
    {"chart", gravure::cli::add_chart_command},
    {"completion", gravure::cli::add_completion},
    {"man", gravure::cli::add_man},
}};

/// The verb that is asked for, alone: adding all of them costs every run a millisecond. Where none of them is, all,
/// so that --help and errors show them; `completion` and `man` tell of all, too.
void add_verbs(CLI::App& app, Command& command, const std::vector<std::string>& arguments) {
  const std::string_view asked = arguments.empty() ? "" : std::string_view(arguments.front());
  const bool one = asked != "completion" && asked != "man" &&
                   std::any_of(kVerbs.begin(), kVerbs.end(), [&](const Verb& verb) { return verb.name == asked; });
  for (const Verb& verb : kVerbs) {
    if (!one || verb.name == asked) {
      verb.add(app, command);
    }
  }
}

/// "gravure --help", or that of the verb that was given.
std::string help_of(const CLI::App& app) {
  std::string verbs;
  const CLI::App* level = &app;
  while (!level->get_subcommands().empty()) {
    level = level->get_subcommands().front();
    verbs += level->get_name() + " ";
  }
  return "gravure " + verbs + "--help";
}

/// The verb that was given, as deep as it goes: "motion" and "texture" have verbs of their own. The parser takes an
/// unknown one for a missing one.
const CLI::App& given_verb(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* level = &app;
  for (const std::string& argument : arguments) {
    const std::vector<const CLI::App*> known = level->get_subcommands([](const CLI::App*) { return true; });
    if (known.empty() || argument[0] == '-') {
      break;
    }
    const auto given =
        std::find_if(known.begin(), known.end(), [&](const CLI::App* verb) { return verb->get_name() == argument; });
    if (given == known.end()) {
      std::string verbs;
      for (const CLI::App* verb : known) {
        verbs += (verbs.empty() ? "" : ", ") + verb->get_name();
      }
      throw CLI::ValidationError("\"" + argument.substr(0, 40) + "\"", "is no verb; the verbs are " + verbs);
    }
    level = *given;
  }
  return *level;
}

/// What the parser would take for something else: an empty text for 0 or no path, an option for the value of another,
/// or for one of no verb.
void refuse_ambiguous(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto empty = std::find(arguments.begin(), arguments.end(), "");
  if (empty != arguments.end()) {
    throw CLI::ValidationError(empty == arguments.begin() ? "the verb" : "the argument after " + *(empty - 1),
                               "is empty");
  }
  if (!arguments.empty() && arguments.front()[0] == '-' && arguments.front() != "--version") {
    const auto verb = std::find_if(arguments.begin(), arguments.end(), [](const std::string& argument) {
      return std::any_of(kVerbs.begin(), kVerbs.end(), [&](const Verb& known) { return known.name == argument; });
    });
    if (verb != arguments.end()) {
      throw CLI::ValidationError(
          arguments.front(), "stands before the verb; options follow it: gravure " + *verb + " " + arguments.front());
    }
  }
  const CLI::App& verb = given_verb(app, arguments);
  for (std::size_t i = 0; i + 1 < arguments.size(); ++i) {
    const CLI::Option* option = verb.get_option_no_throw(arguments[i]);
    const bool takes_value = option != nullptr && option->get_items_expected_min() > 0;
    if (takes_value && arguments[i][0] == '-' && verb.get_option_no_throw(arguments[i + 1]) != nullptr &&
        arguments[i + 1][0] == '-') {
      throw CLI::ValidationError(arguments[i], "needs a value; " + arguments[i + 1] + " is an option");
    }
  }
}

bool wants_json(const std::vector<std::string>& arguments) {
  return std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
}

/// Why nothing more can be printed, after a failed write to standard output.
Error output_error() {
  const std::string why = errno == EPIPE ? "whoever reads it has closed it before all was written"
                                         : std::string("cannot write: ") + std::strerror(errno);
  return {gravure::ErrorCode::io, "standard output: " + why};
}

void log_end(int status, double seconds) {
  struct rusage used = {};
  getrusage(RUSAGE_SELF, &used);
  gravure::cli::log(gravure::cli::LogLevel::debug, "exit status " + std::to_string(status) + " after " +
                                                       std::to_string(seconds) + " s, at most " +
                                                       std::to_string(used.ru_maxrss / 1024) + " MiB of memory");
}

/// Chunks of programs, a quarter of a MiB each, come and go by the thousand. By default glibc gives their memory back
/// to the system each time, and fetching it again costs as much as reading what goes into it.
void keep_chunks() {
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 8 << 20);
}

int run(int argc, char** argv) {
  keep_chunks();
  gravure::leave_hdf5_to_exit();
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (wants_json(arguments)) {
    gravure::cli::promise_json();
  }
  watch_signals();
  Command command;
  CLI::App app("Raster gravure engine for rotational workpieces: image stacks to verified laser programs.", "gravure");
  app.set_version_flag("--version", "gravure " GRAVURE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done and within limits, 1 a limit is violated, 2 bad usage, job or input file,\n"
      "3 device or I/O failure, 4 interrupted.");
  add_verbs(app, command, arguments);
  gravure::cli::add_log_level(app);  // after all verbs: each gets it
  try {
    refuse_ambiguous(app, arguments);
    app.parse(argc, argv);
  } catch (const CLI::Success& shown) {  // --help, --version
    app.exit(shown);
    return std::cout.flush() ? 0 : report(output_error(), false);
  } catch (const CLI::ParseError& error) {
    const bool no_verb = std::string(error.what()) == "A subcommand is required";
    const std::string what = no_verb ? "a verb is missing" : error.what();
    return report({gravure::ErrorCode::bad_argument, what + "; see " + help_of(app)}, wants_json(arguments));
  }
  const auto start = std::chrono::steady_clock::now();
  const Result<int> result = command.run();
  const int status = result ? result.value() : report(result.error(), command.json);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report(output_error(), false);
  }
  log_end(status, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  const bool json = wants_json({argv, argv + argc});
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return report({gravure::ErrorCode::io,
                   "out of memory: give a smaller job, or less to --memory and --threads where "
                   "the verb has them"},
                  json);
  } catch (const std::exception& error) {
    return report({gravure::ErrorCode::io, std::string("internal: ") + error.what()}, json);
  }
}
