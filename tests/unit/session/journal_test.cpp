#include "gravure/session/journal.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <fstream>

#include "session_bench.hpp"

namespace gravure::session::test {
namespace {

const JobIdentity kJob{"job.grv", "0123", 100, 10};

void expect_refused(const Result<Journal>& journal, ErrorCode code, const char* part) {
  ASSERT_FALSE(journal);
  EXPECT_EQ(journal.error().code, code) << journal.error().message;
  EXPECT_NE(journal.error().message.find(part), std::string::npos) << journal.error().message;
}

Attempt attempt_from(std::int64_t line) {
  Attempt attempt;
  attempt.device = "a folder";
  attempt.serial = "S1";
  attempt.power_up = ~std::uint64_t{0};
  attempt.mark = 0xFFFF'FFFF;
  attempt.first = {line, 3};
  attempt.end_line = 100;
  return attempt;
}

void change(const std::string& path, const std::string& sql) {
  sqlite3* file = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &file), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(file, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(file);
  sqlite3_close(file);
}

TEST(Journal, KeepsWhatItWasTold) {
  Folder folder;
  const std::string path = folder / "j";
  {
    Result<Journal> journal = Journal::open(path, kJob);
    ASSERT_TRUE(journal) << journal.error().message;
    EXPECT_FALSE(journal.value().last());
    EXPECT_FALSE(journal.value().finished());
    ASSERT_TRUE(journal.value().begin(attempt_from(10)));
    ASSERT_TRUE(journal.value().started(50));
    ASSERT_TRUE(journal.value().acknowledged({20, 30, 40, 60}));
  }
  {
    Result<Journal> journal = Journal::open(path, kJob);
    ASSERT_TRUE(journal);
    ASSERT_TRUE(journal.value().last());
    const Attempt& last = *journal.value().last();
    EXPECT_EQ(last.number, 1);
    EXPECT_EQ(last.serial, "S1");
    EXPECT_EQ(last.power_up, ~std::uint64_t{0});
    EXPECT_EQ(last.mark, 0xFFFF'FFFFU);
    EXPECT_EQ(last.first, (Place{10, 3}));
    EXPECT_EQ(last.state, AttemptState::started);
    EXPECT_EQ(last.executed, (Place{20, 0}));
    EXPECT_EQ(last.sent_limit, 60);
    ASSERT_TRUE(journal.value().ended(AttemptState::ended, {33, 7}, 33, "because"));
    ASSERT_TRUE(journal.value().begin(attempt_from(33)));
    ASSERT_TRUE(journal.value().ended(AttemptState::ended, {100, 0}, 100, "done"));
    ASSERT_TRUE(journal.value().finish());
  }
  Result<Journal> journal = Journal::open(path, kJob);
  ASSERT_TRUE(journal);
  EXPECT_TRUE(journal.value().finished());
  EXPECT_EQ(journal.value().last()->number, 2);
  ASSERT_TRUE(journal.value().begin_exposure());
  EXPECT_EQ(journal.value().exposure(), 2);
  EXPECT_FALSE(journal.value().last());
  EXPECT_FALSE(journal.value().finished());
}

TEST(Journal, HasOneUserAtATime) {
  Folder folder;
  const Result<Journal> journal = Journal::open(folder / "j", kJob);
  ASSERT_TRUE(journal);
  expect_refused(Journal::open(folder / "j", kJob), ErrorCode::io, "another run has it");
}

TEST(Journal, RefusesAnotherProgram) {
  Folder folder;
  ASSERT_TRUE(Journal::open(folder / "j", kJob));
  JobIdentity other = kJob;
  other.hash = "4567";
  expect_refused(Journal::open(folder / "j", other), ErrorCode::bad_argument, "hash 0123, this one has 4567");
}

TEST(Journal, RefusesNumbersThatTheJobDoesNotHave) {
  const auto refused = [](const std::string& damage, const char* part) {
    Folder folder;
    JobIdentity job = kJob;
    job.slots_per_line = 500;
    {
      Result<Journal> journal = Journal::open(folder / "j", job);
      ASSERT_TRUE(journal);
      ASSERT_TRUE(journal.value().begin(attempt_from(10)));
      ASSERT_TRUE(journal.value().started(50));
      ASSERT_TRUE(journal.value().acknowledged({20, 30, 40, 60}));
    }
    change(folder / "j", damage);
    expect_refused(Journal::open(folder / "j", job), ErrorCode::bad_file, part);
  };
  refused("UPDATE attempt SET executed_slots = 501", "a line or slot that the job does not have");
  refused("UPDATE attempt SET first_slots = 501", "a line or slot that the job does not have");
  refused("UPDATE attempt SET end_line = 101", "a line or slot that the job does not have");
  refused("UPDATE job SET lines = 99",
          "it has 99 lines, 10 a revolution, where this program, of the same hash, has 100");
  refused("DELETE FROM attempt", "attempts whose rows are gone");
  refused("DELETE FROM progress; INSERT INTO event VALUES (99, 1, '', 'end', ''); DELETE FROM attempt",
          "attempts whose rows are gone");
}

TEST(Journal, RefusesAnEmptyFileWhereOneIsToBe) {
  for (const std::size_t bytes : {0U, 1U}) {
    Folder folder;
    std::ofstream(folder / "j") << std::string(bytes, 'x');
    const Result<Journal> journal = Journal::open(folder / "j", kJob, true);
    ASSERT_FALSE(journal) << bytes;
    EXPECT_EQ(exit_status(journal.error().code), 2) << journal.error().message;
  }
}

TEST(Journal, RefusesAnotherVersionNamingBoth) {
  Folder folder;
  ASSERT_TRUE(Journal::open(folder / "j", kJob));
  change(folder / "j", "PRAGMA user_version = 7");
  expect_refused(Journal::open(folder / "j", kJob), ErrorCode::version_mismatch,
                 "has version 7, this program knows "
                 "version 1");
}

TEST(Journal, RefusesAnotherSqliteFile) {
  Folder folder;
  change(folder / "j", "CREATE TABLE x (y)");
  expect_refused(Journal::open(folder / "j", kJob), ErrorCode::bad_file, "no journal of gravure");
}

TEST(Journal, RefusesWhatIsNoDatabase) {
  Folder folder;
  std::ofstream(folder / "j") << std::string(5000, 'x');
  expect_refused(Journal::open(folder / "j", kJob), ErrorCode::bad_file, "damaged or no journal");
}

TEST(Journal, RefusesADamagedOne) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  Folder folder;
  int refused = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const std::string path = folder / std::to_string(trial);
    {
      Result<Journal> journal = Journal::open(path, kJob);
      ASSERT_TRUE(journal);
      ASSERT_TRUE(journal.value().begin(attempt_from(10)));
      ASSERT_TRUE(journal.value().started(50));
    }
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(0, std::ios::end);
    const std::int64_t size = file.tellg();
    for (int byte = 0; byte < 600; ++byte) {
      file.seekp(dice.between(0, size - 1));
      file.put(static_cast<char>(dice.word()));
    }
    file.close();
    const Result<Journal> journal = Journal::open(path, kJob);  // never a crash
    refused += journal ? 0 : 1;
  }
  EXPECT_GE(refused, 35);
}

TEST(Journal, RefusesAFolderThatIsReadOnly) {
  if (::geteuid() == 0) {
    GTEST_SKIP() << "root writes into any folder";
  }
  Folder folder;
  ASSERT_EQ(::mkdir((folder / "d").c_str(), 0500), 0);
  expect_refused(Journal::open(folder / "d/j", kJob), ErrorCode::io, "cannot be written");
}

TEST(Journal, RefusesAFolderThatIsNotThere) {
  Folder folder;
  expect_refused(Journal::open(folder / "d/j", kJob), ErrorCode::io, "--journal");
}

}  // namespace
}  // namespace gravure::session::test
