#include "verb.hpp"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>

#include "gravure/core/file_output.hpp"
#include "log.hpp"

namespace gravure::cli {

CLI::App* add_verb(CLI::App& app, Command& command, const std::string& name, const std::string& description) {
  CLI::App* verb = app.add_subcommand(name, description);
  verb->add_flag("--json", command.json, "Print one JSON document on standard output and nothing else there");
  return verb;
}

void add_work_options(CLI::App& verb, Command& command) {
  add_integer(verb, "--memory", command.memory_mib, "Budget for all buffers in MiB", 1, std::uint64_t{1} << 20);
  add_integer(verb, "--threads", command.threads, "Workers; 0: one for each processor", 0, 1024);
}

CLI::Validator integer_from(std::int64_t least, std::uint64_t most) {
  const std::string range = std::to_string(least) + " to " + std::to_string(most);
  return CLI::Validator(
      [least, most, range](std::string& text) {
        constexpr std::size_t kMostDigits = 21;
        const std::string digits = text.substr(text.find_first_not_of('-') == 1 ? 1 : 0);
        const bool is_integer = !digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos;
        if (is_integer && text.size() <= kMostDigits && Integer(text) >= least && Integer(text) <= most) {
          return std::string();
        }
        return "must be an integer from " + range + ", not \"" + text.substr(0, 40) + (text.size() > 40 ? "..." : "") +
               "\"";
      },
      range, "integer");
}

Result<Rational> decimal_option(const std::string& option, const std::string& text) {
  static const Rational kMost = Integer(1'000'000'000'000'000'000);
  Result<Rational> value = parse_decimal(text);
  if (!value) {
    return Error{value.error().code, option + " " + value.error().message};
  }
  if (abs(value.value()) > kMost) {
    return Error{ErrorCode::out_of_range, option + " " + text.substr(0, 40) + ": must be from -1e18 to 1e18"};
  }
  return value;
}

void print(const std::string& text) {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

Result<void> check_not_stopped() {
  return cancel_token().cancelled() ? Error{ErrorCode::cancelled, "stopped; nothing was written"} : Result<void>();
}

double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale + 0.0;
}

void print_json(const Json& document) {
  print(document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void warn(const std::string& text) {
  log(LogLevel::warning, text);
}

Json json_integer(const Integer& value) {
  const Integer exact = Integer(1) << 53;
  if (abs(value) > exact) {
    return value.str();
  }
  return static_cast<std::int64_t>(value);
}

Json json_ratio(const Rational& value) {
  return {{"num", json_integer(numerator_of(value))}, {"den", json_integer(denominator_of(value))}};
}

namespace {

CancelToken the_token;
std::atomic<bool> token_watched{false};
std::atomic<bool> json_promised{false};
static_assert(std::atomic<bool>::is_always_lock_free, "interrupt() runs in a signal handler");

}  // namespace

CancelToken& cancel_token() {
  token_watched = true;
  return the_token;
}

void promise_json() {
  json_promised = true;
}

void interrupt() {
  if (!token_watched && !FileOutput::any_begun()) {
    if (json_promised) {
      constexpr std::string_view kDocument =
          "{\n  \"error\": {\n    \"code\": \"cancelled\",\n    \"message\": \"stopped; nothing was written\"\n  "
          "}\n}\n";
      static_cast<void>(!::write(STDOUT_FILENO, kDocument.data(), kDocument.size()));
    }
    constexpr std::string_view kSaid = "gravure: error: stopped; nothing was written\n";
    static_cast<void>(!::write(STDERR_FILENO, kSaid.data(), kSaid.size()));
    ::_exit(exit_status(ErrorCode::cancelled));
  }
  the_token.cancel();
}

std::string printable(std::string_view text) {
  // The JSON writer knows UTF-8: what it cannot read becomes U+FFFD.
  const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string clean = Json::parse(quoted).get<std::string>();
  std::string shown;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    const auto byte = static_cast<unsigned char>(clean[i]);
    const auto next = i + 1 < clean.size() ? static_cast<unsigned char>(clean[i + 1]) : 0U;
    const auto after = i + 2 < clean.size() ? static_cast<unsigned char>(clean[i + 2]) : 0U;
    const bool c1 = byte == 0xC2 && next >= 0x80 && next < 0xA0;
    // U+200E to U+200F, U+202A to U+202E, U+2066 to U+2069 turn the direction of writing.
    const bool turns = byte == 0xE2 && ((next == 0x80 && (after == 0x8E || after == 0x8F)) ||
                                        (next == 0x80 && after >= 0xAA && after <= 0xAE) ||
                                        (next == 0x81 && after >= 0xA6 && after <= 0xA9));
    if (c1 || turns || (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7F) {
      shown += '?';
      i += c1 ? 1 : turns ? 2 : 0;
    } else {
      shown += clean[i];
    }
  }
  return shown;
}

}  // namespace gravure::cli
