#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>

#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"
#include "gravure/core/progress.hpp"
#include "progress_bar.hpp"

namespace gravure::cli {

using Json = nlohmann::ordered_json;

inline constexpr int kDone = 0;
inline constexpr int kLimitViolated = 1;

inline constexpr double kDegreesPerRad = 180 / std::numbers::pi;

/// To so many decimals, without negative zero: what is less depends on the compiler.
double rounded(double value, int decimals);

/// What the command line asked for: each verb fills in `run`, main() calls it. Standard output belongs to the result
/// (one JSON document with --json), standard error to everything else.
struct Command {
  bool json = false;
  std::int64_t memory_mib = 256;
  int threads = 0;
  std::function<Result<int>()> run;

  std::int64_t memory_bytes() const { return memory_mib << 20; }
};

/// Adds a verb with its --json.
CLI::App* add_verb(CLI::App& app, Command& command, const std::string& name, const std::string& description);
/// Adds --memory and --threads to a verb that works on images.
void add_work_options(CLI::App& verb, Command& command);

/// What a verb does with its options, once they are read.
template <class Options, class Run>
void set_run(CLI::App& verb, Command& command, const std::shared_ptr<Options>& options, Run run) {
  verb.callback([&command, options, run] {
    command.run = [&command, options, run]() -> Result<int> { return run(*options, command); };
  });
}

/// Refuses what is no integer from `least` to `most`. Without it an option takes "" for 0 and cuts a huge number.
CLI::Validator integer_from(std::int64_t least, std::uint64_t most);
inline constexpr std::uint64_t kMostIndex = std::uint64_t{1} << 62;  ///< for revolutions and lines, checked later
/// Adds an option that takes an integer from `least` to `most`; help shows what it is without.
template <class Integer>
CLI::Option* add_integer(CLI::App& verb, const std::string& name, Integer& value, const std::string& text,
                         std::int64_t least, std::uint64_t most) {
  return verb.add_option(name, value, text)->check(integer_from(least, most))->capture_default_str();
}

/// The exact value of a decimal given to an option; an error names the option.
Result<Rational> decimal_option(const std::string& option, const std::string& text);

/// One text to standard output.
void print(const std::string& text);
/// One JSON document to standard output.
void print_json(const Json& document);
/// "gravure: warning: ..." to standard error.
void warn(const std::string& text);

/// An integer as JSON: a number where a double holds it, else its digits in a string.
Json json_integer(const Integer& value);
Json json_ratio(const Rational& value);

/// Set by Ctrl-C. Asking for it says that somebody will look at it from now on.
CancelToken& cancel_token();
/// cancelled, once somebody stopped a verb that writes at its end.
Result<void> check_not_stopped();
/// From now on interrupt() owes standard output a document.
void promise_json();
/// What Ctrl-C does: sets the token where somebody looks at it or a file is being written, else ends the program with
/// the status of `cancelled`.
void interrupt();

/// `text` without what a terminal would obey: control characters but line ends, and bytes that are no UTF-8.
std::string printable(std::string_view text);

// The verbs, a file each.
void add_init(CLI::App& app, Command& command);
void add_plan(CLI::App& app, Command& command);
void add_suggest(CLI::App& app, Command& command);
void add_slice(CLI::App& app, Command& command);
void add_compile(CLI::App& app, Command& command);
void add_merge(CLI::App& app, Command& command);
void add_inspect(CLI::App& app, Command& command);
void add_dump(CLI::App& app, Command& command);
void add_unroll(CLI::App& app, Command& command);
void add_verify(CLI::App& app, Command& command);
void add_emulate(CLI::App& app, Command& command);
void add_run(CLI::App& app, Command& command);
void add_exposure(CLI::App& app, Command& command);
void add_trajectory(CLI::App& app, Command& command);
void add_export(CLI::App& app, Command& command);
void add_calibrate(CLI::App& app, Command& command);
void add_register(CLI::App& app, Command& command);
void add_devices(CLI::App& app, Command& command);
void add_chart_command(CLI::App& app, Command& command);
void add_completion(CLI::App& app, Command& command);
void add_man(CLI::App& app, Command& command);

}  // namespace gravure::cli
