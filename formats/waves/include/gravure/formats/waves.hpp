#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "gravure/core/error.hpp"
#include "gravure/formats/waves_dump.hpp"
#include "gravure/fpga/ab_edges.hpp"

namespace gravure::formats {

/// CSV of A-B edges: "tick,a,b" and then one line an edge, for example "1024,0,1". Appends to `out`.
void append_csv_header(std::string& out);
void append_csv_edge(std::string& out, const fpga::AbEdge& edge);

/// The pins A and B alone as a value change dump.
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
  explicit VcdWriter(WaveDump dump) : dump_(std::move(dump)) {}

  WaveDump dump_;
};

}  // namespace gravure::formats
