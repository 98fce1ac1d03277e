#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "gravure/core/error.hpp"
#include "gravure/fpga/ab_edges.hpp"

namespace gravure::formats {

/// CSV of A-B edges: "tick,a,b" and then one line an edge, for example "1024,0,1". Appends to `out`.
void append_csv_header(std::string& out);
void append_csv_edge(std::string& out, const fpga::AbEdge& edge);

/// How FPGA ticks become times of a value change dump, which knows only 1, 10 or 100 of a decimal unit. A tick whose
/// time is no whole number of units is rounded down, and the dump's comment says so.
struct VcdTime {
  std::string timescale = "1 ns";  ///< 1, 10 or 100, then s, ms, us, ns, ps or fs
  std::uint64_t units_num = 1;     ///< one tick is num / den units, >= 1
  std::uint64_t units_den = 1;     ///< 1 <= den <= num: two ticks must not share a time
};

/// The pins A and B as a value change dump (IEEE 1364 section 18) for GTKWave and the like. Every call appends to
/// `out`, so that the text can be written away piece by piece.
class VcdWriter {
 public:
  /// bad_argument where `time` breaks its ranges.
  static Result<VcdWriter> make(const VcdTime& time);

  /// The head, and both pins as they stand after tick `first`.
  Result<void> begin(std::string& out, std::uint64_t first, fpga::AbPins pins);
  /// out_of_range where the time does not fit 64 bits; then nothing is appended.
  Result<void> edge(std::string& out, const fpga::AbEdge& edge);
  /// The end of the recording, so that viewers show the last state at its length.
  Result<void> end(std::string& out, std::uint64_t last);

 private:
  explicit VcdWriter(VcdTime time) : time_(std::move(time)) {}
  Result<void> append_time(std::string& out, std::uint64_t tick) const;

  VcdTime time_;
  fpga::AbPins pins_;
};

}  // namespace gravure::formats
