#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "gravure/session/journal.hpp"

namespace gravure::session {

/// Writes what the board has acknowledged into the journal on a thread of its own: a disk that takes long to sync does
/// not keep the host from speaking to the board. What is not on disk yet is at most kMostWait or kMostLines old.
class JournalWriter {
 public:
  static constexpr std::chrono::milliseconds kMostWait{100};
  static constexpr std::int64_t kMostLines = 4096;

  /// `ahead_lines`: how many lines beyond those that were sent may be sent before the next write.
  JournalWriter(Journal& journal, const Acknowledged& start, std::int64_t ahead_lines, std::int64_t end_line);
  ~JournalWriter();
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  /// The newest of the board; its sent_limit is not looked at.
  void post(const Acknowledged& now);
  /// Lines before this one may be sent: that they may have been is on disk.
  std::int64_t sent_limit() const;
  std::optional<Error> error() const;
  /// Ends the thread; the journal is its owner's again. What was posted last may be unwritten.
  void stop();

 private:
  void write();
  bool due() const;

  Journal& journal_;
  const std::int64_t ahead_lines_;
  const std::int64_t end_line_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Acknowledged posted_;
  Acknowledged written_;
  std::optional<Error> error_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace gravure::session
