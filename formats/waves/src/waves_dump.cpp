#include "gravure/formats/waves_dump.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "digits.hpp"
#include "gravure/fpga/ab_registers.hpp"

namespace gravure::formats {
namespace {

bool is_timescale(std::string_view text) {
  constexpr std::array<std::string_view, 3> kCounts = {"1 ", "10 ", "100 "};
  constexpr std::array<std::string_view, 6> kUnits = {"s", "ms", "us", "ns", "ps", "fs"};
  return std::any_of(kCounts.begin(), kCounts.end(), [text, kUnits](std::string_view count) {
    return text.substr(0, count.size()) == count &&
           std::find(kUnits.begin(), kUnits.end(), text.substr(count.size())) != kUnits.end();
  });
}

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

char identifier(std::size_t signal) {
  return static_cast<char>('!' + signal);
}

}  // namespace

Result<WaveDump> WaveDump::make(const VcdTime& time, std::string scope, std::vector<WaveSignal> signals) {
  if (!is_timescale(time.timescale)) {
    return Error{ErrorCode::bad_argument,
                 "timescale = \"" + time.timescale + "\": must be 1, 10 or 100, a space, and s, ms, us, ns, ps or fs"};
  }
  if (time.units_den == 0 || time.units_num < time.units_den) {
    return Error{ErrorCode::bad_argument, "tick = " + std::to_string(time.units_num) + "/" +
                                              std::to_string(time.units_den) + " x " + time.timescale +
                                              ": must be at least 1; take a finer timescale"};
  }
  if (signals.size() > kMaxSignals) {
    return Error{ErrorCode::bad_argument,
                 std::to_string(signals.size()) + " signals: at most " + std::to_string(kMaxSignals)};
  }
  for (const WaveSignal& signal : signals) {
    if (!is_name(signal.name) || signal.bits < 1 || signal.bits > 64) {
      return Error{ErrorCode::bad_argument, "signal \"" + signal.name + "\" of " + std::to_string(signal.bits) +
                                                " bits: a name has letters, digits and _, a signal 1 to 64 bits"};
    }
  }
  return WaveDump(time, std::move(scope), std::move(signals));
}

Result<void> WaveDump::append_time(std::string& out, std::uint64_t tick) const {
  const fpga::Uint128 units = static_cast<fpga::Uint128>(tick) * time_.units_num / time_.units_den;
  if (units > std::numeric_limits<std::uint64_t>::max()) {
    return Error{ErrorCode::out_of_range, "tick " + std::to_string(tick) + ": its time in units of " + time_.timescale +
                                              " needs more than 64 bits; take a coarser timescale"};
  }
  out += '#';
  append_number(out, static_cast<std::uint64_t>(units));
  out += '\n';
  return {};
}

void WaveDump::append_value(std::string& out, std::size_t signal, std::uint64_t value) const {
  if (signals_[signal].bits == 1) {
    out += value != 0 ? '1' : '0';
  } else {
    out += 'b';
    int bit = signals_[signal].bits - 1;
    while (bit > 0 && ((value >> static_cast<unsigned>(bit)) & 1U) == 0) {
      --bit;  // leading zeros need not be written
    }
    for (; bit >= 0; --bit) {
      out += ((value >> static_cast<unsigned>(bit)) & 1U) != 0 ? '1' : '0';
    }
    out += ' ';
  }
  out += identifier(signal);
  out += '\n';
}

Result<void> WaveDump::begin(std::string& out, std::uint64_t first, std::span<const std::uint64_t> values) {
  std::string head = "$comment 1 FPGA tick = ";
  append_number(head, time_.units_num);
  head += '/';
  append_number(head, time_.units_den);
  head += " x " + time_.timescale + ", times rounded down $end\n";
  head += "$timescale " + time_.timescale + " $end\n";
  head += "$scope module " + scope_ + " $end\n";
  for (std::size_t signal = 0; signal < signals_.size(); ++signal) {
    head += "$var wire " + std::to_string(signals_[signal].bits) + " ";
    head += identifier(signal);
    head += " " + signals_[signal].name + " $end\n";
  }
  head += "$upscope $end\n$enddefinitions $end\n";
  GRAVURE_CHECK(append_time(head, first));
  head += "$dumpvars\n";
  for (std::size_t signal = 0; signal < signals_.size(); ++signal) {
    append_value(head, signal, values[signal]);
  }
  out += head + "$end\n";
  values_.assign(values.begin(), values.end());
  tick_ = first;
  return {};
}

Result<void> WaveDump::change(std::string& out, std::uint64_t tick, std::size_t signal, std::uint64_t value) {
  if (values_[signal] == value) {
    return {};
  }
  if (tick != tick_) {
    GRAVURE_CHECK(append_time(out, tick));
    tick_ = tick;
  }
  append_value(out, signal, value);
  values_[signal] = value;
  return {};
}

Result<void> WaveDump::end(std::string& out, std::uint64_t last) {
  return last == tick_ ? Result<void>() : append_time(out, last);  // one time is never given twice
}

}  // namespace gravure::formats
