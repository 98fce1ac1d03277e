#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "digits.hpp"
#include "gravure/formats/waves.hpp"

namespace gravure::formats {
namespace {

constexpr char kPinA = '!';  // the identifiers of the two variables in the dump
constexpr char kPinB = '"';

bool is_timescale(std::string_view text) {
  constexpr std::array<std::string_view, 3> kCounts = {"1 ", "10 ", "100 "};
  constexpr std::array<std::string_view, 6> kUnits = {"s", "ms", "us", "ns", "ps", "fs"};
  return std::any_of(kCounts.begin(), kCounts.end(), [text, kUnits](std::string_view count) {
    return text.substr(0, count.size()) == count &&
           std::find(kUnits.begin(), kUnits.end(), text.substr(count.size())) != kUnits.end();
  });
}

void append_pin(std::string& out, bool level, char pin) {
  out += level ? '1' : '0';
  out += pin;
  out += '\n';
}

}  // namespace

Result<VcdWriter> VcdWriter::make(const VcdTime& time) {
  if (!is_timescale(time.timescale)) {
    return Error{ErrorCode::bad_argument,
                 "timescale = \"" + time.timescale + "\": must be 1, 10 or 100, a space, and s, ms, us, ns, ps or fs"};
  }
  if (time.units_den == 0 || time.units_num < time.units_den) {
    return Error{ErrorCode::bad_argument, "tick = " + std::to_string(time.units_num) + "/" +
                                              std::to_string(time.units_den) + " x " + time.timescale +
                                              ": must be at least 1; take a finer timescale"};
  }
  return VcdWriter(time);
}

Result<void> VcdWriter::append_time(std::string& out, std::uint64_t tick) const {
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

Result<void> VcdWriter::begin(std::string& out, std::uint64_t first, fpga::AbPins pins) {
  std::string head = "$comment 1 FPGA tick = ";
  append_number(head, time_.units_num);
  head += '/';
  append_number(head, time_.units_den);
  head += " x " + time_.timescale + ", times rounded down $end\n";
  head += "$timescale " + time_.timescale + " $end\n";
  head += "$scope module ab $end\n$var wire 1 ! a $end\n$var wire 1 \" b $end\n";
  head += "$upscope $end\n$enddefinitions $end\n";
  GRAVURE_CHECK(append_time(head, first));
  head += "$dumpvars\n";
  append_pin(head, pins.a, kPinA);
  append_pin(head, pins.b, kPinB);
  out += head + "$end\n";
  pins_ = pins;
  return {};
}

Result<void> VcdWriter::edge(std::string& out, const fpga::AbEdge& edge) {
  if (edge.pins == pins_) {
    return {};
  }
  GRAVURE_CHECK(append_time(out, edge.clock));
  if (edge.pins.a != pins_.a) {
    append_pin(out, edge.pins.a, kPinA);
  }
  if (edge.pins.b != pins_.b) {
    append_pin(out, edge.pins.b, kPinB);
  }
  pins_ = edge.pins;
  return {};
}

Result<void> VcdWriter::end(std::string& out, std::uint64_t last) {
  return append_time(out, last);
}

}  // namespace gravure::formats
