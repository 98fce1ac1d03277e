#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <thread>

#include "gravure/core/crc32c.hpp"
#include "gravure/fpga/register_map.hpp"
#include "gravure/session/run.hpp"
#include "gravure/twin/exposure.hpp"
#include "run_part.hpp"

namespace gravure::session {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstStatus{2'000};
/// The watchdog closes the gate after a tenth of a second without a word from the host.
constexpr std::int64_t kSilenceParts = 10;

/// Nothing runs, nor will by a go that was said before.
bool at_rest(const BoardStatus& status) {
  return status.state == BoardState::idle || status.state == BoardState::stopped;
}

/// What the board says of itself now; a gate that is open, or may open by itself, is closed first.
Result<BoardStatus> settled_status(DeviceLink& link) {
  const auto until = std::chrono::steady_clock::now() + kFirstStatus;
  std::optional<BoardStatus> newest;
  bool closed = false;
  while (std::chrono::steady_clock::now() < until) {
    GRAVURE_TRY(const std::optional<BoardStatus> status, link.next_status(milliseconds(newest ? 20 : 100)));
    if (status) {
      newest = status;
    } else if (newest && (at_rest(*newest) || (closed && newest->state == BoardState::filling))) {
      return *newest;
    } else {
      std::this_thread::sleep_for(milliseconds(1));
    }
    if (newest && !at_rest(*newest) && !closed) {
      GRAVURE_CHECK(link.write_register(fpga::kControlRegister.address, 0));
      closed = true;
    }
  }
  return Error{ErrorCode::timeout, link.identity().place +
                                       ": the board does not say what state it is in: check cable "
                                       "and power, switch it off and on"};
}

/// What the operator has to see to before a run of the board.
std::string to_do_before(const Plan& plan, const BoardRun& run, const BoardRun& before) {
  return run.band == before.band
             ? std::string()
             : fmt::format("band {} of {}: move the stage along the axis to {:.6f} mm from the place of band 0",
                           run.band, plan.bands->count, to_double(run.axial_mm));
}

class Run {
 public:
  Run(LineSource& program, DeviceLink& link, Journal& journal, const RunOptions& options, RunObserver& observer,
      const CancelToken& cancel)
      : program_(program),
        link_(link),
        journal_(journal),
        options_(options),
        observer_(observer),
        cancel_(cancel),
        plan_(program.header().plan) {}

  Result<RunReport> run() {
    GRAVURE_CHECK(look_at_board());
    GRAVURE_CHECK(find_beginning());
    GRAVURE_CHECK(run_parts());
    report_.skipped = journal_.skipped();
    return report_;
  }

 private:
  std::int64_t total() const { return plan_.job.revolutions * plan_.rotary.lines_per_revolution; }

  Result<void> look_at_board() {
    GRAVURE_CHECK(check_options(journal_, options_.resume));
    GRAVURE_TRY(report_.board, shake_hands(link_));
    GRAVURE_CHECK(check_board(report_.board, device_setup(plan_, 0, 0)));
    report_.demand = link_demand(program_.header());
    GRAVURE_CHECK(check_link_rate(report_.demand, link_.identity()));
    GRAVURE_TRY(status_, settled_status(link_));
    GRAVURE_TRY(report_.reserve_bytes,
                reserve_bytes(options_.reserve_bytes, report_.demand, std::int64_t{status_.capacity_bytes}, total()));
    return {};
  }

  Result<void> find_beginning() {
    GRAVURE_TRY(mark_, link_.read_register(fpga::kScheduleIncrementRegister.address));
    BoardMemory memory{.serial = link_.identity().serial,
                       .power_up = status_.power_up,
                       .mark = mark_,
                       .executed_lines = status_.executed_lines,
                       .closed_slot = {}};
    if (status_.partial_line) {
      memory.closed_slot = status_.closed_slot;
    }
    GRAVURE_TRY(report_.begun, where_to_begin(journal_, memory, options_.resume));
    if (options_.resume.again && journal_.last()) {
      GRAVURE_CHECK(journal_.begin_exposure());
    }
    if (status_.fault != DeviceFault::none) {
      note("fault", "the board stood with the fault " + to_string(status_.fault) + ", which is acknowledged now");
    }
    const std::optional<Attempt>& last = journal_.last_started();
    const bool open = last && (last->state == AttemptState::started || last->state == AttemptState::lost);
    if (open && !report_.begun.uncertain) {  // the board forgets it when lines are prepared
      GRAVURE_CHECK(journal_.found(report_.begun.place));
    }
    if (report_.begun.uncertain) {
      say_uncertain(*report_.begun.uncertain);
      if (report_.begun.place.line == total()) {
        GRAVURE_CHECK(note_uncertain(true));
      }
    }
    report_.executed = report_.begun.place;
    const std::int64_t line = report_.begun.place.line;
    report_.counts = {line, line, line - skipped_before(line), total()};
    return {};
  }

  void say_uncertain(const Uncertain& lines) {
    const bool skip = options_.resume.uncertain == UncertainPolicy::skip;
    observer_.on_note(fmt::format("uncertain: {} to {} may have been fired or not ({} lines): {}",
                                  line_text(plan_, lines.from.line), line_text(plan_, lines.end_line - 1),
                                  lines.end_line - lines.from.line,
                                  skip ? "skipped, nothing is fired twice and some of them may stay dark"
                                       : "repeated, all are fired and some of them may be fired twice"));
  }

  Result<void> note_uncertain(bool now) {
    return journal_.uncertain(*report_.begun.uncertain, options_.resume.uncertain == UncertainPolicy::skip, now);
  }

  /// Those that are about to be, too: a decision counts in the journal once lines are started.
  std::int64_t skipped_before(std::int64_t line) const {
    std::vector<Uncertain> all = journal_.skipped();
    const std::optional<Uncertain>& now = report_.begun.uncertain;
    const bool skip = now && options_.resume.uncertain == UncertainPolicy::skip;
    const auto same = [&now](const Uncertain& one) { return one.from == now->from && one.end_line == now->end_line; };
    if (skip && std::none_of(all.begin(), all.end(), same)) {
      all.push_back(*now);
    }
    all.erase(std::remove_if(all.begin(), all.end(), [line](const Uncertain& one) { return one.from.line >= line; }),
              all.end());
    return count_lines(all);
  }

  void note(const std::string& kind, const std::string& text) {
    observer_.on_note(text);
    static_cast<void>(journal_.event(kind, text));
  }

  BoardRun run_of(std::int64_t line) const { return run_with(plan_, line / plan_.rotary.lines_per_revolution); }
  std::int64_t end_of(const BoardRun& run) const { return run.end_revolution() * plan_.rotary.lines_per_revolution; }

  Result<void> run_parts() {
    Place place = report_.begun.place;
    while (place.line < total()) {
      const BoardRun part = run_of(place.line);
      GRAVURE_CHECK(run_part(part, place));
      if (report_.error) {
        report_.end = report_.error->code == ErrorCode::cancelled ? RunEnd::stopped : RunEnd::failed;
        return {};
      }
      place = {end_of(part), 0};
      report_.to_do = place.line < total() ? to_do_before(plan_, run_of(place.line), part) : std::string();
      if (!report_.to_do.empty()) {
        note("part", "next: " + report_.to_do);
        if (!options_.through) {
          report_.end = RunEnd::part_end;
          return {};
        }
      }
    }
    return journal_.finish();
  }

  Result<void> run_part(const BoardRun& part, const Place& place) {
    GRAVURE_TRY(PartSettings settings, settings_for(part, place));
    if (place.line != part.first_revolution * plan_.rotary.lines_per_revolution) {
      say_offset(place.line);
    }
    GRAVURE_CHECK(journal_.begin({.number = 0,
                                  .device = link_.identity().place,
                                  .serial = link_.identity().serial,
                                  .power_up = status_.power_up,
                                  .mark = settings.timing.mark,
                                  .first = place,
                                  .end_line = end_of(part),
                                  .state = AttemptState::prepared,
                                  .executed = place,
                                  .sent_limit = place.line}));
    if (report_.begun.uncertain && place == report_.begun.place) {
      GRAVURE_CHECK(note_uncertain(false));
    }
    PartOutcome outcome = PartRun(program_, link_, journal_, std::move(settings), options_, observer_, cancel_).run();
    report_.counts = outcome.counts;
    report_.executed = outcome.executed;
    report_.exact = outcome.exact;
    report_.sent_limit = outcome.sent_limit;
    report_.fault = outcome.fault;
    if (!outcome.ran) {
      report_.error = outcome.ran.error();
    }
    return {};
  }

  /// Of the next attempt: another than the board holds. Made of nothing but what the board says, so that what was
  /// recorded of a run plays back.
  std::uint32_t next_mark() {
    std::array<std::byte, sizeof(mark_) + sizeof(status_.power_up)> seen{};
    std::memcpy(seen.data(), &mark_, sizeof(mark_));
    std::memcpy(seen.data() + sizeof(mark_), &status_.power_up, sizeof(status_.power_up));
    const std::uint32_t made = crc32c_continue(kCrc32cStart, seen) | 1U;
    mark_ = made == mark_ ? made + 2 : made;
    return mark_;
  }

  Result<PartSettings> settings_for(const BoardRun& part, const Place& place) {
    report_.offset = resume_offset(plan_, part, place.line);
    PartSettings settings;
    settings.first = place;
    settings.end_line = end_of(part);
    settings.total_lines = total();
    settings.skipped_lines = skipped_before(place.line);
    settings.seed_hz = plan_.clock.seed_hz;
    settings.timing = {.slots_per_microvector = plan_.line.slots_per_microvector,
                       .backward_later_ticks = plan_.line.offset_remainder_ticks,
                       .lines_before = static_cast<std::uint64_t>(report_.offset.lines_before),
                       .silence_seeds = static_cast<std::uint64_t>(plan_.clock.seed_hz / kSilenceParts),
                       .mark = next_mark()};
    settings.timing.stop_at_end = plan_.mode == Mode::flat;
    const std::int64_t per_revolution = plan_.rotary.lines_per_revolution;
    const DeviceSetup setup = device_setup(plan_, place.line / per_revolution, place.line % per_revolution);
    GRAVURE_TRY(settings.sequence, protocol::start_sequence(setup, settings.timing));
    settings.stop = protocol::stop_sequence(setup.spin_down, setup.carriage.spin_down);
    settings.stop_time = stop_time(setup.spin_down, setup.carriage.spin_down);
    settings.ticks_per_seed = setup.clock_multiplier;
    const std::uint64_t line_seeds = static_cast<std::uint64_t>(setup.slots_per_line) *
                                     static_cast<std::uint64_t>(setup.ticks_per_slot / setup.clock_multiplier);
    settings.ramp_seeds = settings.sequence.first_tick - settings.timing.lines_before * line_seeds;
    settings.marking_end_seeds =
        settings.sequence.first_tick + static_cast<std::uint64_t>(settings.end_line - place.line) * line_seeds;
    settings.frame_bytes = report_.demand.frame_bytes;
    settings.capacity_bytes = std::int64_t{status_.capacity_bytes};
    settings.reserve_bytes =
        std::min(report_.reserve_bytes, (settings.end_line - place.line) * report_.demand.frame_bytes);
    settings.power_up = status_.power_up;
    return settings;
  }

  std::chrono::nanoseconds stop_time(const std::vector<ScheduleSegment>& axis,
                                     const std::vector<ScheduleSegment>& carriage) const {
    std::uint64_t longest = 0;
    for (const std::vector<ScheduleSegment>* segments : {&axis, &carriage}) {
      std::uint64_t seeds = 0;
      for (const ScheduleSegment& segment : *segments) {
        seeds += segment.seeds;
      }
      longest = std::max(longest, seeds);
    }
    const double seconds = static_cast<double>(longest) / static_cast<double>(plan_.clock.seed_hz);
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
  }

  void say_offset(std::int64_t line) {
    if (plan_.path) {
      note("resume", fmt::format("going on at {} ({}): the stages and the galvo begin their motion at its start again, "
                                 "and the gate stays closed until that period",
                                 line_text(plan_, line), report_.begun.why));
      return;
    }
    std::string text = fmt::format(
        "going on at {} ({}): the axis is at its reference again and comes to that line; its drift until there, {:.6f} "
        "um, is not made up for",
        line_text(plan_, line), report_.begun.why, to_double(report_.offset.axis_um));
    if (plan_.carriage) {
      text += fmt::format("; the carriage begins {:.6f} mm from its start (drift {:.6f} um)",
                          to_double(report_.offset.carriage_start_mm), to_double(report_.offset.carriage_um));
    }
    note("resume", text);
  }

  LineSource& program_;
  DeviceLink& link_;
  Journal& journal_;
  const RunOptions& options_;
  RunObserver& observer_;
  const CancelToken& cancel_;
  const Plan& plan_;
  BoardStatus status_;
  std::uint32_t mark_ = 0;  ///< that the board holds
  RunReport report_;
};

}  // namespace

Result<RunReport> run_program(LineSource& program, DeviceLink& link, Journal& journal, const RunOptions& options,
                              RunObserver& observer, const CancelToken& cancel) {
  return Run(program, link, journal, options, observer, cancel).run();
}

}  // namespace gravure::session
