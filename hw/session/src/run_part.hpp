#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "gravure/protocol/start_sequence.hpp"
#include "gravure/session/run.hpp"
#include "journal_writer.hpp"
#include "line_feed.hpp"

namespace gravure::session {

/// What one stretch of lines needs.
struct PartSettings {
  Place first;
  std::int64_t end_line = 0;
  std::int64_t total_lines = 0;    ///< of the job
  std::int64_t skipped_lines = 0;  ///< before the first
  protocol::LineTiming timing;
  protocol::StartSequence sequence;
  std::vector<protocol::RegisterWrite> stop;
  std::chrono::nanoseconds stop_time{0};  ///< that the axes take to come to rest
  /// Seed clocks from go: until both axes have their marking speed, and until they leave it again by themselves.
  std::uint64_t ramp_seeds = 0;
  std::uint64_t marking_end_seeds = 0;
  std::int64_t seed_hz = 0;
  std::int64_t ticks_per_seed = 1;
  std::int64_t frame_bytes = 0;
  std::int64_t capacity_bytes = 0;
  std::int64_t reserve_bytes = 0;
  std::uint64_t power_up = 0;
};

/// How it ended: with an error unless every line was executed.
struct PartOutcome {
  Result<void> ran;
  Place executed;
  bool exact = true;
  std::int64_t sent_limit = 0;
  DeviceFault fault = DeviceFault::none;
  RunCounts counts;
};

/// Lines from one start to the end, a fault, or the wish to stop. The attempt has begun in the journal.
class PartRun {
 public:
  PartRun(LineSource& program, DeviceLink& link, Journal& journal, PartSettings settings, const RunOptions& options,
          RunObserver& observer, const CancelToken& cancel);
  PartOutcome run();

 private:
  using Clock = std::chrono::steady_clock;
  using Milliseconds = DeviceLink::Milliseconds;

  Result<void> run_lines();
  Result<void> load_board();
  Result<void> fill();
  Result<void> start();
  Result<void> stream();
  Result<void> pump();
  Result<void> pack();
  Result<bool> send();
  Result<void> await_status(Milliseconds patience);
  Result<void> take_status(const BoardStatus& status);
  Result<void> check_stall();
  Result<void> keep_alive();
  Result<void> write(const std::vector<protocol::RegisterWrite>& writes);
  Result<void> check_refused(std::uint32_t bits, const char* when);
  Result<void> wait_out_old_count(Clock::time_point counted_from);
  void close_gate();
  Result<void> settle();
  std::uint32_t axes_on() const;
  std::chrono::duration<double> seconds_of(std::uint64_t seeds) const;
  std::chrono::duration<double> since_go() const;
  Result<void> bring_to_rest();
  Result<void> wait_for_rest();
  PartOutcome conclude(Result<void> ran);
  Error describe(const Error& cause, const PartOutcome& outcome) const;
  std::int64_t lines() const { return settings_.end_line - settings_.first.line; }
  bool all_executed() const { return executed_ == lines(); }
  std::int64_t sent_lines() const;
  RunCounts counts() const;
  Acknowledged acknowledged() const;

  LineSource& program_;
  DeviceLink& link_;
  Journal& journal_;
  PartSettings settings_;
  const RunOptions& options_;
  RunObserver& observer_;
  const CancelToken& cancel_;
  LineFeed feed_;
  std::unique_ptr<JournalWriter> writer_;

  std::vector<std::byte> pending_;  ///< frames that are packed
  std::size_t pending_sent_ = 0;    ///< of these
  std::vector<std::byte> masked_;   ///< bits of the first line, without those that have fired already
  std::int64_t packed_lines_ = 0;
  std::int64_t sent_bytes_ = 0;
  std::int64_t taken_ = 0;     ///< lines since the position was set
  std::int64_t executed_ = 0;  ///< likewise
  std::int64_t level_bytes_ = 0;
  std::uint64_t tick_ = 0;
  std::optional<std::uint32_t> newest_;  ///< sequence of the last status
  bool started_ = false;                 ///< go was said, or may have been
  bool ran_ = false;                     ///< the board has said that lines run
  bool gate_closed_ = false;             ///< it was told to, or has done so itself
  bool out_of_reach_ = false;
  bool power_lost_ = false;
  std::optional<BoardStatus> stopped_;  ///< by a fault
  std::optional<std::uint32_t> closed_slot_;
  Clock::time_point go_;  ///< when it was said
  Clock::time_point last_spoken_;
  Clock::time_point last_moved_;
  bool waits_for_board_ = false;
};

}  // namespace gravure::session
