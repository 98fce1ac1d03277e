#include "gravure/emulator/board_name.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <limits>
#include <vector>

#include "gravure/fpga/register_map.hpp"

namespace gravure::emulator {
namespace {

constexpr std::string_view kKeys = "pace, capacity, fifo_bits, serial, seed, seed_hz, fault";
constexpr std::uint64_t kMostCapacity = std::uint64_t{1} << 30;
constexpr std::uint64_t kMostHz = 10'000'000'000;
constexpr std::size_t kMostSerial = 64;

std::uint64_t steady_ns() {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
          .count());
}

Result<std::uint64_t> number(std::string_view key, std::string_view text, std::uint64_t low, std::uint64_t high) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || value < low || value > high) {
    return Error{ErrorCode::out_of_range, "emulated board: " + std::string(key) + "=" + std::string(text) +
                                              ": allowed is " + std::to_string(low) + " to " + std::to_string(high)};
  }
  return value;
}

Error refusal(std::string_view key, std::string_view value, const std::string& allowed) {
  return {ErrorCode::bad_argument, "emulated board: " + std::string(key) + "=" + std::string(value) + ": " + allowed};
}

Result<void> set_serial(std::string_view value, BoardOptions& options) {
  const bool plain = std::all_of(value.begin(), value.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_';
  });
  if (value.empty() || value.size() > kMostSerial || !plain) {
    return refusal("serial", value, "1 to " + std::to_string(kMostSerial) + " letters, digits, - and _");
  }
  options.serial = value;
  return {};
}

Result<void> set_option(std::string_view key, std::string_view value, BoardOptions& options) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  if (key == "pace") {
    if (value != "wait" && value != "real") {
      return refusal(key, value, "must be wait (for the host) or real");
    }
    options.now_ns = value == "real" ? std::function<std::uint64_t()>(steady_ns) : nullptr;
  } else if (key == "capacity") {
    GRAVURE_TRY(options.capacity_bytes, number(key, value, 64, kMostCapacity));
  } else if (key == "fifo_bits") {
    GRAVURE_TRY(const std::uint64_t bits, number(key, value, fpga::kFifoBitsRange.low, fpga::kFifoBitsRange.high));
    options.fifo_bits = static_cast<int>(bits);
  } else if (key == "serial") {
    return set_serial(value, options);
  } else if (key == "seed") {
    GRAVURE_TRY(options.seed, number(key, value, 0, kMost));
  } else if (key == "seed_hz") {
    GRAVURE_TRY(options.seed_hz, number(key, value, 1, kMostHz));
  } else if (key == "fault") {
    GRAVURE_TRY(const WireFault fault, parse_wire_fault(value));
    options.faults.push_back(fault);
  } else {
    return Error{ErrorCode::bad_argument,
                 key.empty()
                     ? "emulated board: an option without a name; there are " + std::string(kKeys)
                     : "emulated board: \"" + std::string(key) + "\" is no option; there are " + std::string(kKeys)};
  }
  return {};
}

}  // namespace

Result<void> parse_board_options(std::string_view text, BoardOptions& options) {
  std::vector<std::string_view> given;
  for (bool more = !text.empty(); more;) {
    const std::size_t end = std::min(text.find(','), text.size());
    const std::string_view option = text.substr(0, end);
    more = end < text.size();
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string_view key = option.substr(0, equals);
    const std::string_view value = option.substr(std::min(equals + 1, option.size()));
    if (key != "fault" && std::ranges::find(given, key) != given.end()) {
      return refusal(key, value, "given a second time; give " + std::string(key) + " once");
    }
    given.push_back(key);
    GRAVURE_CHECK(set_option(key, value, options));
  }
  return {};
}

Result<BoardName> parse_board_name(std::string_view text) {
  const std::size_t end = std::min(text.find(','), text.size());
  BoardName name{.folder = std::string(text.substr(0, end)), .options = {}};
  if (name.folder.empty()) {
    return Error{ErrorCode::bad_argument, "emulated board: no folder given; name it emulated:DIR[,key=value...]"};
  }
  if (end + 1 == text.size()) {
    return Error{ErrorCode::bad_argument, "emulated board: no option behind the last comma; leave the comma out"};
  }
  GRAVURE_CHECK(parse_board_options(text.substr(std::min(end + 1, text.size())), name.options));
  return name;
}

std::string board_options_text(const BoardOptions& options) {
  std::string text = std::string("pace=") + (options.now_ns ? "real" : "wait");
  text += options.capacity_bytes == 0 ? "" : ",capacity=" + std::to_string(options.capacity_bytes);
  text += options.fifo_bits == 0 ? "" : ",fifo_bits=" + std::to_string(options.fifo_bits);
  text += ",seed=" + std::to_string(options.seed) + ",seed_hz=" + std::to_string(options.seed_hz);
  text += options.serial.empty() ? "" : ",serial=" + options.serial;
  for (const WireFault& fault : options.faults) {
    text += ",fault=" + to_string(fault);
  }
  return text;
}

}  // namespace gravure::emulator
