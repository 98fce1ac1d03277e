#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "gravure/core/program.hpp"

namespace gravure {

/// Brings the chunks that several workers finish into one order: that of the tickets, so that the bytes of a program do
/// not depend on how many workers there were. A worker that is ahead of its turn may leave `ahead_bytes` here, then
/// waits.
class OrderedWriter {
 public:
  OrderedWriter(LineSink& sink, std::int64_t ahead_bytes) : sink_(sink), ahead_bytes_(ahead_bytes) {}

  /// Hands over the next chunk of a ticket. False: somebody failed, stop.
  bool put(std::int64_t ticket, StoredChunk chunk);
  /// The ticket has no more chunks.
  bool close(std::int64_t ticket);
  /// Stops everybody; the first error is kept.
  void fail(Error error);
  /// Has anybody? Does not wait for the one who writes.
  bool failed() const noexcept { return failed_; }
  /// What went wrong, if anything.
  std::optional<Error> error() const;

 private:
  struct Waiting {
    std::vector<StoredChunk> chunks;
    bool closed = false;
  };
  void keep(Error error);
  void write(const StoredChunk& chunk);
  void advance();

  LineSink& sink_;
  const std::int64_t ahead_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable turn_;
  std::int64_t current_ = 0;
  std::int64_t waiting_bytes_ = 0;
  std::map<std::int64_t, Waiting> waiting_;
  std::optional<Error> error_;
  std::atomic<bool> failed_{false};  ///< error_ is there
};

}  // namespace gravure
