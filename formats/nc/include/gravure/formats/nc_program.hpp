#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::nc {

/// The five stages of a path program as an NC program moves them: X, Y, Z in mm, A, C in degrees with their turns; and
/// behind them the focus axis W in mm, where there is one, else 0.
inline constexpr std::size_t kStages = 5;
inline constexpr std::size_t kMostStages = 6;
using StagePlace = std::array<double, kMostStages>;

/// A block: the stages arrive there so long after the block before.
struct StageBlock {
  double duration_s = 0;
  StagePlace place{};
  StagePlace speed{};  ///< on arrival, per s; PVT alone
};

/// A program: where the stages stand at its begin, and its blocks.
struct StageProgram {
  std::size_t stages = kStages;  ///< kMostStages with W
  StagePlace start{};
  std::vector<StageBlock> blocks;
};

/// Larger texts are refused by the readers.
inline constexpr std::size_t kMostProgramBytes = std::size_t{1} << 30U;

/// ISO 6983 G-code, straight from block to block at inverse-time feed: G21 (mm), G90, G93, F in 1/min. The start is a
/// block by itself with G0, before which the machine may stand anywhere. `stages` is that of the whole program.
std::string g_code_start(const StagePlace& start, std::string_view title, std::size_t stages = kStages);
void append_g_code(const StageBlock& block, std::string& text, std::size_t stages = kStages);
std::string g_code_end();
/// Reads what these write, and nothing looser; W is there if the start has it. bad_file names the line.
Result<StageProgram> parse_g_code(std::string_view text);

/// Position, velocity, time as PMAC controllers take them: a PVT line with the time of the moves that follow in ms,
/// then X(place):(speed) for each stage, places in mm and degrees, speeds a second. Between two blocks stages move by
/// the cubic with these places and speeds at its ends.
std::string pvt_start(const StagePlace& start, std::string_view title, std::size_t stages = kStages);
void append_pvt(const StageBlock& block, std::string& text, std::size_t stages = kStages);
std::string pvt_end();
Result<StageProgram> parse_pvt(std::string_view text);

/// Where the stages stand `share` 0 to 1 of the way through a block: straight, or by the cubic.
StagePlace straight_between(const StagePlace& from, const StageBlock& block, double share);
StagePlace cubic_between(const StagePlace& from, const StagePlace& from_speed, const StageBlock& block, double share);

}  // namespace gravure::nc
