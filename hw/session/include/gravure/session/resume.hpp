#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gravure/core/board_runs.hpp"
#include "gravure/core/plan.hpp"
#include "gravure/session/journal.hpp"

namespace gravure::session {

/// What to do with lines of which nobody knows whether they were fired.
enum class UncertainPolicy : std::uint8_t {
  skip,    ///< go on behind them: nothing is fired twice, some of them may stay dark
  repeat,  ///< go on at their begin: all are fired, some of them may be fired twice
};
const char* to_string(UncertainPolicy policy);

struct ResumeOptions {
  bool resume = false;
  bool again = false;         ///< expose the workpiece once more, from the first line
  bool other_device = false;  ///< go on with another board than the job was begun with
  UncertainPolicy uncertain = UncertainPolicy::skip;
};

/// Where lines go on.
struct Beginning {
  Place place;
  std::optional<Uncertain> uncertain;
  std::string why;  ///< for people and the journal
};

/// What the board in front of us can tell of the last attempt.
struct BoardMemory {
  std::string serial;
  std::uint64_t power_up = 0;
  std::uint32_t mark = 0;            ///< as it stands in the board
  std::uint32_t executed_lines = 0;  ///< since its position was set
  std::optional<std::uint32_t> closed_slot;
};

/// Whether these options let a job begin or go on at all, before a board is looked at: bad_argument where it is
/// finished or was begun and the options do not say what to do.
Result<void> check_options(const Journal& journal, const ResumeOptions& options);

/// Decides by journal and board. The board's own count is exact, if it is of this attempt: same serial, power-up and
/// mark. bad_argument where another device would go on unasked; device where board and journal contradict each other.
Result<Beginning> where_to_begin(const Journal& journal, const BoardMemory& board, const ResumeOptions& options);

/// What going on at a line costs: axes that begin at their reference know nothing of the drift of the revolutions
/// before.
struct ResumeOffset {
  std::int64_t lines_before = 0;   ///< of its revolution, whose time passes first
  Rational axis_um = 0;            ///< how much further on the axis would have been; negative: less far
  Rational carriage_um = 0;        ///< likewise
  Rational carriage_start_mm = 0;  ///< helical mode: where the carriage's reference is to be
};
ResumeOffset resume_offset(const Plan& plan, const BoardRun& run, std::int64_t line);

/// "revolution 3, line 17" of a line of the job; in flat mode "pass", of a program that follows a path "servo period
/// 17".
std::string line_text(const Plan& plan, std::int64_t line);

}  // namespace gravure::session
