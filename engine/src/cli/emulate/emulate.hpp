#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/plan.hpp"
#include "gravure/formats/waves_dump.hpp"
#include "gravure/fpga/ab_edges.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// What `gravure emulate` was asked for.
struct EmulateOptions {
  std::string program;
  fpga::AbRegisters registers;
  std::uint64_t clocks = 0;
  std::int64_t fpga_hz = 0;
  std::string edges_path;
  std::string vcd_path;
  std::optional<std::uint64_t> from;
  std::optional<std::uint64_t> to;
  std::vector<std::string> faults;
  std::vector<std::string> acknowledgements;
  bool rtl = false;

  bool writes() const { return !edges_path.empty() || !vcd_path.empty(); }
};

/// Ticks that are looked at in detail: the state after `first`, then every change up to and including `last`.
struct TickWindow {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
};
/// --from and --to within 0..`end`; out_of_range or bad_argument where they are not.
Result<TickWindow> tick_window(const EmulateOptions& options, std::uint64_t end);

/// Nanoseconds where the clock is known, else one unit a tick.
Result<formats::VcdTime> vcd_time(std::int64_t fpga_hz);

/// The edges of a window of a program as CSV, written but not in its place: every run begins with the counter at 0, and
/// backward runs have the pins exchanged.
Result<TextOutput> write_run_edges(const std::string& path, const Plan& plan, TickWindow window);

/// Counter and pins after a tick, exactly.
Json axis_json(const fpga::AbRegisters& registers, std::uint64_t tick);

Result<int> run_counter(const EmulateOptions& options, const Command& command);
Result<int> run_program(const EmulateOptions& options, const Command& command);

}  // namespace gravure::cli
