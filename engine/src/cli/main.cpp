#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include "motion_command.hpp"
#include "verb.hpp"

namespace {

using gravure::Error;
using gravure::Result;
using gravure::cli::Command;

extern "C" void on_signal(int) {
  gravure::cli::cancel_token().cancel();
}

void watch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // a second Ctrl-C ends at once; nothing half-written shows
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
  std::fprintf(stderr, "gravure: error: %s\n", error.message.c_str());
  if (json) {
    gravure::cli::print_json({{"error", {{"code", gravure::error_code_name(error.code)}, {"message", error.message}}}});
  }
  return gravure::exit_status(error.code);
}

int run(int argc, char** argv) {
  Command command;
  CLI::App app("Raster gravure engine for rotational workpieces: image stacks to verified laser programs.", "gravure");
  app.set_version_flag("--version", "gravure " GRAVURE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done and within limits, 1 a limit is violated, 2 bad usage, job or input file,\n"
      "3 device or I/O failure, 4 interrupted.");
  gravure::cli::add_init(app, command);
  gravure::cli::add_plan(app, command);
  gravure::cli::add_suggest(app, command);
  gravure::cli::add_slice(app, command);
  gravure::cli::add_compile(app, command);
  gravure::cli::add_inspect(app, command);
  gravure::cli::add_dump(app, command);
  gravure::cli::add_unroll(app, command);
  gravure::cli::add_verify(app, command);
  gravure::cli::add_emulate(app, command);
  gravure::cli::add_motion_command(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  watch_signals();
  const Result<int> result = command.run();
  const int status = result ? result.value() : report(result.error(), command.json);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report({gravure::ErrorCode::io, "standard output: cannot write"}, false);
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("gravure: error: out of memory: lower --memory or --threads\n", stderr);
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gravure: error: internal: %s\n", error.what());
    return 3;
  }
}
