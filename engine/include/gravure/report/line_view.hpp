#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"

namespace gravure::report {

/// A stretch of slots in which every pulse passes.
struct GateRun {
  std::int64_t first_slot = 0;
  std::int64_t slots = 0;
};

/// Where the mirrors stand at a slot, and where the light is told to be.
struct MirrorSample {
  std::int64_t slot = 0;
  double u_mm = 0;
  double v_mm = 0;
};

/// What happens in the time of one line; ticks count from its begin.
struct LineView {
  std::int64_t revolution = 0;
  std::int64_t line = 0;
  bool reverse = false;
  std::int64_t first_slot = 0;  ///< of the marking window
  std::vector<GateRun> gate;
  std::int64_t fired = 0;
  bool gate_cut = false;  ///< there are more runs than kMostGateRuns

  int ab_state_at_start = 0;             ///< (A, B) as the number 2 A + B
  std::vector<std::int64_t> edge_ticks;  ///< changes of A or B: the next of 00, 01, 11, 10
  bool backward = false;                 ///< or, where the stage comes back, the one before
  bool edges_cut = false;                ///< there are more than kMostEdges

  std::vector<MirrorSample> mirrors;  ///< empty: the plan has no scanner
  std::string no_mirrors;             ///< why
};
inline constexpr std::size_t kMostGateRuns = 20'000;
inline constexpr std::size_t kMostEdges = 50'000;
inline constexpr std::int64_t kMostMirrorSamples = 1'500;

/// The first line of a revolution, from `line` on, that fires; `line` itself where none does.
Result<std::int64_t> first_firing_line(LineSource& program, std::int64_t revolution, std::int64_t line);

/// One line as the board puts it out; edges in closed form, exactly. Of a program that follows a path a line is a servo
/// period: no edges, and the galvo's set-points at its begin and its end. Fails where the program cannot be read.
Result<LineView> line_view(LineSource& program, std::int64_t revolution, std::int64_t line);

/// The ticks in (begin, end] of a board run at which A or B of its first channel changes, at most `most`, and how many
/// edges lie before: an edge is put out on the first clock that has carried the counter over a quarter.
struct EdgesIn {
  Integer before = 0;
  std::vector<std::int64_t> ticks;
  bool cut = false;
};
EdgesIn edges_in(const AbPlan& ab, const std::optional<AxisSpin>& spin, std::int64_t begin, std::int64_t end,
                 std::size_t most);

}  // namespace gravure::report
