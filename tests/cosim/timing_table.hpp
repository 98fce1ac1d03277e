#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "machine.hpp"

namespace gravure::cosim {

/// A table "clock: inputs -> outputs" of fpga/timing (its README says how to read one).
struct TimingTable {
  struct Row {
    std::uint64_t clock = 0;
    std::map<std::string, std::uint64_t> inputs;   ///< those that change, before this clock
    std::map<std::string, std::uint64_t> outputs;  ///< those that are known, just after it
  };
  std::string block;
  std::vector<Row> rows;
};

/// Throws std::runtime_error "file:line: what" (a test's own input).
TimingTable read_timing_table(const std::string& path);
std::vector<std::string> timing_table_paths();

/// The first disagreement, or an empty text.
std::string run_timing_table(const TimingTable& table, Machine& machine);

}  // namespace gravure::cosim
