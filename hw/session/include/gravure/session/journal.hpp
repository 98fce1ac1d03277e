#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/device_link.hpp"
#include "gravure/core/error.hpp"

namespace gravure::session {

/// Where a job stands, lines counted over the whole job: all lines before `line` are done, and the first `slots` slots
/// of it.
struct Place {
  std::int64_t line = 0;
  std::int64_t slots = 0;
  friend bool operator==(const Place&, const Place&) = default;
};

/// Which program a journal is of.
struct JobIdentity {
  std::string program;  ///< path, for people
  std::string hash;     ///< what decides
  std::int64_t lines = 0;
  std::int64_t lines_per_revolution = 0;
  std::int64_t slots_per_line = 0;  ///< not kept: what a journal says is held against it
};

enum class AttemptState : std::uint8_t {
  prepared,  ///< nothing of it can have fired
  started,   ///< lines may have run beyond `executed`, up to sent_limit
  ended,     ///< `executed` is exact
  lost,      ///< the board was out of reach: as started
};

/// One stretch of lines on one board.
struct Attempt {
  std::int64_t number = 0;
  std::string device;
  std::string serial;
  std::uint64_t power_up = 0;
  std::uint32_t mark = 0;  ///< left in the board (LineTiming::mark)
  Place first;
  std::int64_t end_line = 0;  ///< behind its last line
  AttemptState state = AttemptState::prepared;
  Place executed;
  std::int64_t sent_limit = 0;  ///< no line from here on was sent
};

/// What a status of the board told.
struct Acknowledged {
  std::int64_t executed_line = 0;
  std::int64_t accepted_line = 0;
  std::int64_t sent_line = 0;
  std::int64_t sent_limit = 0;  ///< lines before it may be sent once this is on disk
};

/// Lines that may have fired or not.
struct Uncertain {
  Place from;
  std::int64_t end_line = 0;
};
std::int64_t count_lines(const std::vector<Uncertain>& stretches);

/// What a job has done, on disk before it is relied on: an SQLite file (docs/formats/journal.md), one user at a time.
/// Whatever returns without an error is on disk, power failures included.
///
/// Errors: io where the file cannot be read or written, the disk is full, or another run has it; bad_file where it is
/// damaged or none of ours; version_mismatch, naming both versions. One thread at a time.
class Journal {
 public:
  static constexpr std::int64_t kSchemaVersion = 1;

  /// Opens the journal of a job, or begins one. bad_argument where it is of another program.
  /// `must_hold_one`: bad_argument where the file holds nothing.
  static Result<Journal> open(const std::string& path, const JobIdentity& job, bool must_hold_one = false);
  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&& other) noexcept;
  ~Journal();

  const std::string& path() const noexcept;
  /// The last one of this exposure, if there is any.
  const std::optional<Attempt>& last() const noexcept;
  /// The last one of this exposure that was started: those behind it have fired nothing, nor decided anything.
  const std::optional<Attempt>& last_started() const noexcept;
  /// Lines of this exposure that were skipped without anybody knowing whether they were fired.
  const std::vector<Uncertain>& skipped() const noexcept;
  /// The exposure that is under way, from 1; another one begins with begin_exposure().
  std::int64_t exposure() const noexcept;
  bool finished() const noexcept;

  Result<void> begin_exposure();
  /// Gives it its number.
  Result<void> begin(Attempt attempt);
  Result<void> started(std::int64_t sent_limit);
  Result<void> acknowledged(const Acknowledged& now);
  Result<void> ended(AttemptState state, Place executed, std::int64_t sent_limit, const std::string& why);
  /// What the board said of last_started() when it was asked again: where it ended, exactly.
  Result<void> found(Place executed);
  /// A decision, which counts once the last attempt is started; with `now` at once, where there is nothing to start.
  Result<void> uncertain(const Uncertain& lines, bool skip, bool now);
  /// A line for people: faults, what was acknowledged, what was skipped.
  Result<void> event(const std::string& kind, const std::string& text);
  /// The end of the job is reached.
  Result<void> finish();

 private:
  class Store;
  explicit Journal(std::unique_ptr<Store> store);
  std::unique_ptr<Store> store_;
};

}  // namespace gravure::session
