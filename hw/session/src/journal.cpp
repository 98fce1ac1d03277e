#include "gravure/session/journal.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <ctime>
#include <utility>

#include "sqlite.hpp"

namespace gravure::session {
namespace {

constexpr std::int64_t kApplicationId = 0x4752'564A;  // "GRVJ"

constexpr const char* kSchema =
    "CREATE TABLE job (id INTEGER PRIMARY KEY CHECK (id = 1), program TEXT NOT NULL, hash TEXT NOT NULL, lines INTEGER "
    "NOT NULL, lines_per_revolution INTEGER NOT NULL, began TEXT NOT NULL);"
    "CREATE TABLE exposure (number INTEGER PRIMARY KEY, began TEXT NOT NULL, finished TEXT);"
    "CREATE TABLE attempt (number INTEGER PRIMARY KEY, exposure INTEGER NOT NULL REFERENCES exposure, device TEXT NOT "
    "NULL, serial TEXT NOT NULL, power_up INTEGER NOT NULL, mark INTEGER NOT NULL, began TEXT NOT NULL, first_line "
    "INTEGER NOT NULL, first_slots INTEGER NOT NULL, end_line INTEGER NOT NULL, state INTEGER NOT NULL CHECK (state "
    "BETWEEN 0 AND 3), executed_line INTEGER NOT NULL, executed_slots INTEGER NOT NULL, sent_limit INTEGER NOT NULL, "
    "ended TEXT, why TEXT, CHECK (0 <= first_line AND first_line <= executed_line AND executed_line <= sent_limit AND "
    "sent_limit <= end_line AND first_slots >= 0 AND executed_slots >= 0));"
    "CREATE TABLE progress (id INTEGER PRIMARY KEY, attempt INTEGER NOT NULL REFERENCES attempt, at TEXT NOT NULL, "
    "executed_line INTEGER NOT NULL, accepted_line INTEGER NOT NULL, sent_line INTEGER NOT NULL, sent_limit INTEGER "
    "NOT NULL);"
    "CREATE TABLE uncertain (id INTEGER PRIMARY KEY, attempt INTEGER NOT NULL REFERENCES attempt, at TEXT NOT NULL, "
    "first_line INTEGER NOT NULL, first_slots INTEGER NOT NULL, end_line INTEGER NOT NULL, policy TEXT NOT NULL);"
    "CREATE TABLE event (id INTEGER PRIMARY KEY, attempt INTEGER, at TEXT NOT NULL, kind TEXT NOT NULL, text TEXT NOT "
    "NULL);";

/// UTC, to the millisecond.
std::string now_text() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const std::int64_t ms = std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
  const auto seconds = static_cast<std::time_t>(ms / 1000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  return fmt::format("{}.{:03}Z", std::string(text.data(), length), ms % 1000);
}

}  // namespace

std::int64_t count_lines(const std::vector<Uncertain>& stretches) {
  std::int64_t lines = 0;
  for (const Uncertain& one : stretches) {
    lines += one.end_line - one.from.line;
  }
  return lines;
}

class Journal::Store {
 public:
  explicit Store(std::unique_ptr<Database> database) : database_(std::move(database)) {}

  Result<void> make_ready(const JobIdentity& job, bool must_hold_one);
  /// All of `write` or nothing, on disk.
  template <class Write>
  Result<void> commit(Write&& write) {
    GRAVURE_CHECK(database_->execute("BEGIN IMMEDIATE"));
    if (Result<void> written = write(); !written) {
      static_cast<void>(database_->execute("ROLLBACK"));
      return written;
    }
    return database_->execute("COMMIT");
  }
  template <class... Values>
  Result<void> run(const char* sql, const Values&... values) {
    GRAVURE_TRY(Statement statement, database_->prepare(sql));
    static_cast<void>((statement.bind(values), ...));
    return statement.run();
  }
  Result<void> add_event(const std::string& kind, const std::string& text) {
    return run("INSERT INTO event (attempt, at, kind, text) VALUES (?, ?, ?, ?)",
               last_ ? last_->number : std::int64_t{0}, now_text(), kind, text);
  }
  Result<void> update(const Attempt& attempt);
  Result<void> read_skipped();

  void keep(Attempt attempt) {
    if (attempt.state != AttemptState::prepared) {
      last_started_ = attempt;
    }
    last_ = std::move(attempt);
  }

  Database& database() { return *database_; }

  std::optional<Attempt> last_;
  std::optional<Attempt> last_started_;
  std::vector<Uncertain> skipped_;
  std::int64_t exposure_ = 1;
  bool finished_ = false;

 private:
  Error damaged(const std::string& what) const;
  Result<void> create(const JobIdentity& job);
  Result<void> check_kind();
  Result<void> check_job(const JobIdentity& job);
  Result<void> check_numbers(const JobIdentity& job);
  Result<void> read();
  Result<std::optional<Attempt>> read_attempt(const char* which);

  std::unique_ptr<Database> database_;
};

Error Journal::Store::damaged(const std::string& what) const {
  return {ErrorCode::bad_file, "journal " + database_->path() + " is damaged: " + what +
                                   ": keep it for inspection under another name; what the workpiece has got is then "
                                   "known only to the board and to you"};
}

Result<void> Journal::Store::create(const JobIdentity& job) {
  return commit([&]() -> Result<void> {
    GRAVURE_CHECK(database_->execute(kSchema));
    GRAVURE_CHECK(database_->execute(fmt::format("PRAGMA application_id = {}", kApplicationId)));
    GRAVURE_CHECK(database_->execute(fmt::format("PRAGMA user_version = {}", kSchemaVersion)));
    GRAVURE_CHECK(run("INSERT INTO job VALUES (1, ?, ?, ?, ?, ?)", job.program, job.hash, job.lines,
                      job.lines_per_revolution, now_text()));
    return run("INSERT INTO exposure VALUES (1, ?, NULL)", now_text());
  });
}

Result<void> Journal::Store::check_kind() {
  GRAVURE_TRY(const std::int64_t id, database_->query("PRAGMA application_id"));
  GRAVURE_TRY(const std::int64_t version, database_->query("PRAGMA user_version"));
  if (id != kApplicationId) {
    return Error{ErrorCode::bad_file, "journal " + database_->path() +
                                          ": this is an SQLite file, but no journal of gravure: give another name "
                                          "with --journal"};
  }
  if (version != kSchemaVersion) {
    return Error{ErrorCode::version_mismatch,
                 fmt::format("journal {} has version {}, this program knows version {}: end the job with the gravure "
                             "that began it",
                             database_->path(), version, kSchemaVersion)};
  }
  GRAVURE_TRY(Statement check, database_->prepare("PRAGMA quick_check(1)"));
  GRAVURE_TRY(const bool row, check.step());
  return row && check.text(0) == "ok" ? Result<void>() : damaged(row ? check.text(0) : "it cannot be checked");
}

Result<void> Journal::Store::check_job(const JobIdentity& job) {
  GRAVURE_TRY(Statement stored,
              database_->prepare("SELECT program, hash, lines, lines_per_revolution FROM job WHERE id = 1"));
  GRAVURE_TRY(const bool row, stored.step());
  if (!row) {
    return damaged("it names no job");
  }
  if (stored.text(1) != job.hash) {
    return Error{ErrorCode::bad_argument,
                 fmt::format("journal {} is of another program: {} with hash {}, this one has {}: give that program, "
                             "or another journal with --journal",
                             database_->path(), stored.text(0), stored.text(1), job.hash)};
  }
  if (stored.integer(2) != job.lines || stored.integer(3) != job.lines_per_revolution) {
    return damaged(fmt::format("it has {} lines, {} a revolution, where this program, of the same hash, has {} and {}",
                               stored.integer(2), stored.integer(3), job.lines, job.lines_per_revolution));
  }
  return {};
}

/// Rows that are gone, and places that the job does not have.
Result<void> Journal::Store::check_numbers(const JobIdentity& job) {
  GRAVURE_TRY(const std::int64_t orphans,
              database_->query("SELECT (SELECT count(*) FROM progress WHERE attempt NOT IN (SELECT number FROM "
                               "attempt)) + (SELECT count(*) FROM event WHERE attempt > 0 AND attempt NOT IN (SELECT "
                               "number FROM attempt)) + (SELECT coalesce(max(number), 0) - count(*) FROM attempt)"));
  if (orphans != 0) {
    return damaged("it tells of attempts whose rows are gone");
  }
  GRAVURE_TRY(const std::int64_t outside,
              database_->query(fmt::format("SELECT count(*) FROM attempt WHERE end_line > {} OR ({} > 0 AND "
                                           "(first_slots > {} OR executed_slots > {}))",
                                           job.lines, job.slots_per_line, job.slots_per_line, job.slots_per_line)));
  return outside == 0 ? Result<void>() : damaged("an attempt ends at a line or slot that the job does not have");
}

Result<void> Journal::Store::read() {
  GRAVURE_TRY(Statement exposure,
              database_->prepare("SELECT number, finished IS NOT NULL FROM exposure ORDER BY number "
                                 "DESC LIMIT 1"));
  GRAVURE_TRY(const bool has_exposure, exposure.step());
  if (!has_exposure) {
    return damaged("it has no exposure");
  }
  exposure_ = exposure.integer(0);
  finished_ = exposure.integer(1) != 0;
  GRAVURE_TRY(last_, read_attempt("state >= 0"));
  GRAVURE_TRY(last_started_, read_attempt("state > 0"));
  return read_skipped();
}

/// The last one of the exposure that is so.
Result<std::optional<Attempt>> Journal::Store::read_attempt(const char* which) {
  GRAVURE_TRY(Statement attempt,
              database_->prepare(fmt::format("SELECT number, device, serial, power_up, mark, first_line, first_slots, "
                                             "end_line, state, executed_line, executed_slots, sent_limit FROM attempt "
                                             "WHERE exposure = ? AND {} ORDER BY number DESC LIMIT 1",
                                             which)
                                     .c_str()));
  GRAVURE_TRY(const bool row, attempt.bind(exposure_).step());
  if (!row) {
    return std::optional<Attempt>();
  }
  return std::optional(Attempt{.number = attempt.integer(0),
                               .device = attempt.text(1),
                               .serial = attempt.text(2),
                               .power_up = static_cast<std::uint64_t>(attempt.integer(3)),
                               .mark = static_cast<std::uint32_t>(attempt.integer(4)),
                               .first = {attempt.integer(5), attempt.integer(6)},
                               .end_line = attempt.integer(7),
                               .state = static_cast<AttemptState>(attempt.integer(8)),
                               .executed = {attempt.integer(9), attempt.integer(10)},
                               .sent_limit = attempt.integer(11)});
}

/// A decision of an attempt that was not started is void: the next one decides anew.
Result<void> Journal::Store::read_skipped() {
  GRAVURE_TRY(Statement rows, database_->prepare("SELECT u.first_line, u.first_slots, u.end_line FROM uncertain u JOIN "
                                                 "attempt a ON a.number = u.attempt WHERE a.exposure = ? AND a.state > "
                                                 "0 AND u.policy = 'skip' ORDER BY u.first_line"));
  static_cast<void>(rows.bind(exposure_));
  skipped_.clear();
  for (;;) {
    GRAVURE_TRY(const bool row, rows.step());
    if (!row) {
      return {};
    }
    skipped_.push_back({{rows.integer(0), rows.integer(1)}, rows.integer(2)});
  }
}

Result<void> Journal::Store::make_ready(const JobIdentity& job, bool must_hold_one) {
  GRAVURE_CHECK(database_->execute("PRAGMA locking_mode = EXCLUSIVE"));
  GRAVURE_CHECK(database_->execute("PRAGMA journal_mode = WAL"));
  GRAVURE_CHECK(database_->execute("PRAGMA synchronous = FULL"));
  GRAVURE_TRY(const std::int64_t things, database_->query("SELECT count(*) FROM sqlite_schema"));
  if (things == 0 && must_hold_one) {
    return Error{ErrorCode::bad_argument,
                 "journal " + database_->path() +
                     ": it is empty, so what the workpiece has got is known only to the board and to you: begin anew "
                     "with --again, or give the journal of the run with --journal"};
  }
  if (things == 0) {
    GRAVURE_CHECK(create(job));
  } else {
    GRAVURE_CHECK(check_kind());
    GRAVURE_CHECK(check_job(job));
    GRAVURE_CHECK(check_numbers(job));
  }
  GRAVURE_CHECK(read());
  // Written at once, so that a journal that cannot be is found before anything runs.
  return commit([&] { return add_event("open", "opened by a run"); });
}

Result<void> Journal::Store::update(const Attempt& attempt) {
  return run("UPDATE attempt SET state = ?, executed_line = ?, executed_slots = ?, sent_limit = ? WHERE number = ?",
             static_cast<std::int64_t>(attempt.state), attempt.executed.line, attempt.executed.slots,
             attempt.sent_limit, attempt.number);
}

Journal::Journal(std::unique_ptr<Store> store) : store_(std::move(store)) {}
Journal::Journal(Journal&& other) noexcept = default;
Journal& Journal::operator=(Journal&& other) noexcept = default;
Journal::~Journal() = default;

Result<Journal> Journal::open(const std::string& path, const JobIdentity& job, bool must_hold_one) {
  GRAVURE_TRY(std::unique_ptr<Database> database, Database::open(path));
  auto store = std::make_unique<Store>(std::move(database));
  GRAVURE_CHECK(store->make_ready(job, must_hold_one));
  return Journal(std::move(store));
}

const std::string& Journal::path() const noexcept {
  return store_->database().path();
}
const std::optional<Attempt>& Journal::last() const noexcept {
  return store_->last_;
}
const std::optional<Attempt>& Journal::last_started() const noexcept {
  return store_->last_started_;
}
const std::vector<Uncertain>& Journal::skipped() const noexcept {
  return store_->skipped_;
}
std::int64_t Journal::exposure() const noexcept {
  return store_->exposure_;
}
bool Journal::finished() const noexcept {
  return store_->finished_;
}

Result<void> Journal::begin_exposure() {
  GRAVURE_CHECK(store_->commit(
      [&] { return store_->run("INSERT INTO exposure VALUES (?, ?, NULL)", store_->exposure_ + 1, now_text()); }));
  ++store_->exposure_;
  store_->finished_ = false;
  store_->last_.reset();
  store_->last_started_.reset();
  store_->skipped_.clear();
  return {};
}

Result<void> Journal::begin(Attempt attempt) {
  GRAVURE_TRY(const std::int64_t count, store_->database().query("SELECT coalesce(max(number), 0) FROM attempt"));
  attempt.number = count + 1;
  attempt.state = AttemptState::prepared;
  attempt.executed = attempt.first;
  attempt.sent_limit = attempt.first.line;
  GRAVURE_CHECK(store_->commit([&] {
    return store_->run(
        "INSERT INTO attempt (number, exposure, device, serial, power_up, mark, began, first_line, first_slots, "
        "end_line, state, executed_line, executed_slots, sent_limit) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        attempt.number, store_->exposure_, attempt.device, attempt.serial, static_cast<std::int64_t>(attempt.power_up),
        std::int64_t{attempt.mark}, now_text(), attempt.first.line, attempt.first.slots, attempt.end_line,
        std::int64_t{0}, attempt.executed.line, attempt.executed.slots, attempt.sent_limit);
  }));
  store_->last_ = std::move(attempt);
  return {};
}

Result<void> Journal::started(std::int64_t sent_limit) {
  Attempt next = *store_->last_;
  next.state = AttemptState::started;
  next.sent_limit = sent_limit;
  GRAVURE_CHECK(store_->commit([&] { return store_->update(next); }));
  store_->last_ = store_->last_started_ = std::move(next);
  return store_->read_skipped();
}

Result<void> Journal::acknowledged(const Acknowledged& now) {
  Attempt next = *store_->last_;
  next.executed = {now.executed_line, now.executed_line == next.first.line ? next.first.slots : 0};
  next.sent_limit = now.sent_limit;
  const Result<void> on_disk = store_->commit([&]() -> Result<void> {
    GRAVURE_CHECK(
        store_->run("INSERT INTO progress (attempt, at, executed_line, accepted_line, sent_line, sent_limit) "
                    "VALUES (?, ?, ?, ?, ?, ?)",
                    next.number, now_text(), now.executed_line, now.accepted_line, now.sent_line, now.sent_limit));
    return store_->update(next);
  });
  if (!on_disk) {
    return on_disk.error();
  }
  store_->keep(std::move(next));
  return {};
}

Result<void> Journal::ended(AttemptState state, Place executed, std::int64_t sent_limit, const std::string& why) {
  Attempt next = *store_->last_;
  next.state = state;
  next.executed = executed;
  next.sent_limit = sent_limit;
  const Result<void> on_disk = store_->commit([&]() -> Result<void> {
    GRAVURE_CHECK(store_->update(next));
    GRAVURE_CHECK(store_->run("UPDATE attempt SET ended = ?, why = ? WHERE number = ?", now_text(), why, next.number));
    return store_->add_event("end", why);
  });
  if (!on_disk) {
    return on_disk.error();
  }
  store_->keep(std::move(next));
  return {};
}

Result<void> Journal::found(Place executed) {
  Attempt next = *store_->last_started_;
  next.state = AttemptState::ended;
  next.executed = executed;
  next.sent_limit = executed.line;
  GRAVURE_CHECK(store_->commit([&] { return store_->update(next); }));
  if (store_->last_->number == next.number) {
    store_->last_ = next;
  }
  store_->last_started_ = std::move(next);
  return {};
}

Result<void> Journal::uncertain(const Uncertain& lines, bool skip, bool now) {
  const std::int64_t attempt = now ? store_->last_started_->number : store_->last_->number;
  GRAVURE_CHECK(store_->commit([&] {
    return store_->run(
        "INSERT INTO uncertain (attempt, at, first_line, first_slots, end_line, policy) VALUES (?, ?, ?, "
        "?, ?, ?)",
        attempt, now_text(), lines.from.line, lines.from.slots, lines.end_line, std::string(skip ? "skip" : "repeat"));
  }));
  return store_->read_skipped();
}

Result<void> Journal::event(const std::string& kind, const std::string& text) {
  return store_->commit([&] { return store_->add_event(kind, text); });
}

Result<void> Journal::finish() {
  const Result<void> on_disk = store_->commit([&]() -> Result<void> {
    GRAVURE_CHECK(store_->run("UPDATE exposure SET finished = ? WHERE number = ?", now_text(), store_->exposure_));
    const std::int64_t skipped = count_lines(store_->skipped_);
    return store_->add_event("finished", skipped == 0 ? std::string("every line was executed")
                                                      : fmt::format("the end is reached; {} lines were skipped, not "
                                                                    "known to be fired",
                                                                    skipped));
  });
  if (!on_disk) {
    return on_disk.error();
  }
  store_->finished_ = true;
  return {};
}

}  // namespace gravure::session
