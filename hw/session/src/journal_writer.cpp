#include "journal_writer.hpp"

#include <algorithm>

namespace gravure::session {

JournalWriter::JournalWriter(Journal& journal, const Acknowledged& start, std::int64_t ahead_lines,
                             std::int64_t end_line)
    : journal_(journal),
      ahead_lines_(ahead_lines),
      end_line_(end_line),
      posted_(start),
      written_(start),
      thread_([this] { write(); }) {}

JournalWriter::~JournalWriter() {
  stop();
}

void JournalWriter::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void JournalWriter::post(const Acknowledged& now) {
  bool wake = false;
  {
    const std::lock_guard lock(mutex_);
    posted_ = now;
    wake = due();
  }
  if (wake) {
    changed_.notify_all();
  }
}

std::int64_t JournalWriter::sent_limit() const {
  const std::lock_guard lock(mutex_);
  return written_.sent_limit;
}

std::optional<Error> JournalWriter::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

/// Too much is unwritten, or half of what may be sent is used up.
bool JournalWriter::due() const {
  return posted_.executed_line - written_.executed_line >= kMostLines ||
         (written_.sent_limit < end_line_ && posted_.sent_line + ahead_lines_ / 2 > written_.sent_limit);
}

void JournalWriter::write() {
  std::unique_lock lock(mutex_);
  while (!stop_ && !error_) {
    changed_.wait_for(lock, kMostWait, [this] { return stop_ || due(); });
    const bool news = posted_.executed_line != written_.executed_line || due();
    if (stop_ || !news) {
      continue;
    }
    Acknowledged now = posted_;
    now.sent_limit = std::max(written_.sent_limit, std::min(end_line_, now.sent_line + ahead_lines_));
    lock.unlock();
    Result<void> on_disk = journal_.acknowledged(now);
    lock.lock();
    if (on_disk) {
      written_ = now;
    } else {
      error_ = on_disk.error();
    }
  }
}

}  // namespace gravure::session
