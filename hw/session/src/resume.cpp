#include "gravure/session/resume.hpp"

#include <fmt/format.h>

namespace gravure::session {
namespace {

/// By the board's own count.
Result<Beginning> by_board(const Attempt& last, const BoardMemory& board) {
  // The count has 32 bits: what it went on since the journal was written, then.
  const auto known = static_cast<std::uint32_t>(last.executed.line - last.first.line);
  const std::int64_t line = last.executed.line + static_cast<std::int64_t>(std::uint32_t{board.executed_lines - known});
  if (line > last.sent_limit) {
    return Error{ErrorCode::device,
                 fmt::format("the board has executed {} lines since line {}, the journal allows {}: they contradict "
                             "each other; begin anew with --again, or on another board with --other-device",
                             board.executed_lines, last.first.line, last.sent_limit - last.first.line)};
  }
  const std::int64_t before = line == last.first.line ? last.first.slots : 0;
  return Beginning{.place = {line, std::max(before, std::int64_t{board.closed_slot.value_or(0)})},
                   .uncertain = {},
                   .why = "by the board's own count"};
}

Beginning by_journal(const Attempt& last, UncertainPolicy policy) {
  Beginning beginning;
  beginning.place = last.executed;
  if (last.sent_limit > last.executed.line) {
    beginning.uncertain = Uncertain{last.executed, last.sent_limit};
    beginning.place = policy == UncertainPolicy::skip ? Place{last.sent_limit, 0} : last.executed;
  }
  return beginning;
}

/// Counts a channel has put out after some ticks, since its counter was loaded; exact.
Rational counts_after(const AbPlan& ab, const Integer& ticks) {
  const Integer steps = ticks / Integer(ab.prescaler);
  return Rational(steps) *
         (Rational(Integer(ab.increment)) + Rational(Integer(ab.fraction_num)) / Rational(Integer(ab.fraction_den)));
}

/// How many counts further on a channel would have been at a line, had it not begun anew with its revolution.
Rational counts_lost(const Plan& plan, const AbPlan& ab, const Rational& edges_per_revolution, std::int64_t revolutions,
                     std::int64_t line) {
  const Integer ticks = Integer(line) * plan.line.ticks;
  const Integer all = Integer(revolutions) * plan.rotary.ticks_per_revolution + ticks;
  const Rational per_revolution = edges_per_revolution * Rational(Integer(1) << (ab.counter_bits - 2));
  return counts_after(ab, all) - counts_after(ab, ticks) - Rational(revolutions) * per_revolution;
}

Rational um_of(const Rational& counts, const AbPlan& ab, const Rational& edges_per_revolution, const Rational& um) {
  return counts / (edges_per_revolution * Rational(Integer(1) << (ab.counter_bits - 2))) * um;
}

}  // namespace

const char* to_string(UncertainPolicy policy) {
  return policy == UncertainPolicy::skip ? "skip" : "repeat";
}

Result<void> check_options(const Journal& journal, const ResumeOptions& options) {
  if (options.again) {
    return {};
  }
  if (journal.finished()) {
    const std::int64_t skipped = count_lines(journal.skipped());
    const std::string how = skipped == 0 ? std::string("every line was executed")
                                         : fmt::format("{} lines were skipped, not known to be fired", skipped);
    return Error{ErrorCode::bad_argument,
                 fmt::format("journal {}: the job is finished, {}: --again exposes it once more", journal.path(), how)};
  }
  if (!options.resume && journal.last_started()) {
    const std::int64_t done = journal.last_started()->executed.line;
    const std::string known = done == 0 ? std::string("no line of it is known to be done")
                                        : fmt::format("line {} of it is the last that is known to be done", done - 1);
    return Error{ErrorCode::bad_argument,
                 fmt::format("journal {}: the job was begun, {}: go on with --resume, or begin anew with --again",
                             journal.path(), known)};
  }
  return {};
}

Result<Beginning> where_to_begin(const Journal& journal, const BoardMemory& board, const ResumeOptions& options) {
  if (options.again || !journal.last()) {
    return Beginning{.place = {}, .uncertain = {}, .why = "from the first line"};
  }
  if (!journal.last_started()) {
    return Beginning{.place = journal.last()->first, .uncertain = {}, .why = "no line of the last attempt was begun"};
  }
  const Attempt& last = *journal.last_started();
  if (last.serial != board.serial && !options.other_device) {
    return Error{ErrorCode::bad_argument, fmt::format("the job was begun on board {}, this is {}: give that one, or "
                                                      "--other-device to go on with this one",
                                                      last.serial, board.serial)};
  }
  if (last.state == AttemptState::ended) {
    return Beginning{.place = last.executed, .uncertain = {}, .why = "by the journal"};
  }
  if (last.serial == board.serial && last.power_up == board.power_up && last.mark == board.mark) {
    return by_board(last, board);
  }
  Beginning beginning = by_journal(last, options.uncertain);
  beginning.why = last.serial != board.serial       ? "by the journal alone: this is another board"
                  : last.power_up != board.power_up ? "by the journal alone: the board has been without power"
                                                    : "by the journal alone: the board has run other lines since";
  return beginning;
}

std::string line_text(const Plan& plan, std::int64_t line) {
  if (plan.path) {
    return fmt::format("servo period {}", line);
  }
  const std::int64_t lines = plan.rotary.lines_per_revolution;
  return fmt::format("{} {}, line {}", plan.mode == Mode::flat ? "pass" : "revolution", line / lines, line % lines);
}

ResumeOffset resume_offset(const Plan& plan, const BoardRun& run, std::int64_t line) {
  const std::int64_t per_revolution = plan.rotary.lines_per_revolution;
  const std::int64_t revolutions = line / per_revolution - run.first_revolution;
  ResumeOffset offset;
  offset.lines_before = line % per_revolution;
  if (!plan.path) {  // where an A-B signal turns an axis
    offset.axis_um =
        um_of(counts_lost(plan, plan.ab, plan.rotary.edges_per_revolution, revolutions, offset.lines_before), plan.ab,
              plan.rotary.edges_per_revolution, plan.rotary.circumference_um);
  }
  if (plan.carriage) {
    const CarriagePlan& carriage = *plan.carriage;
    offset.carriage_um =
        um_of(counts_lost(plan, carriage.ab, carriage.edges_per_revolution, revolutions, offset.lines_before),
              carriage.ab, carriage.edges_per_revolution, carriage.feed_um);
    offset.carriage_start_mm = Rational(revolutions) * carriage.feed_um / 1000;
  }
  return offset;
}

}  // namespace gravure::session
