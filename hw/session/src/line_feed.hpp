#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "gravure/core/program.hpp"

namespace gravure::session {

/// A line in time order, as its frame takes it.
struct FeedLine {
  std::int64_t revolution = 0;
  std::int64_t line = 0;
  std::int64_t first_slot = 0;
  bool backward = false;
  std::span<const std::byte> bits;  ///< valid until the next call
};

/// Lines of a program one after the other. A thread of its own reads and unpacks ahead, so that a slow disk is felt
/// only once all that is ahead has been used up.
class LineFeed {
 public:
  /// Lines first .. end over the whole job. What is ahead takes about `memory_bytes`, two chunks at least.
  LineFeed(LineSource& program, std::int64_t first, std::int64_t end, std::int64_t memory_bytes);
  ~LineFeed();
  LineFeed(const LineFeed&) = delete;
  LineFeed& operator=(const LineFeed&) = delete;

  /// The next line; none where it is not there yet, or after the last one. An error of the program comes where its line
  /// would.
  Result<std::optional<FeedLine>> next();

 private:
  /// Lines of one chunk in one revolution.
  struct Block {
    std::int64_t first = 0;  ///< over the whole job
    std::int64_t lines = 0;
    std::vector<std::byte> bits;
  };
  void read_ahead();
  Result<void> read_blocks();
  bool put(Block block);

  LineSource& program_;
  const std::int64_t first_;
  const std::int64_t end_;
  const std::size_t most_bytes_;

  std::mutex mutex_;
  std::condition_variable room_;
  std::deque<Block> ahead_;
  std::size_t ahead_bytes_ = 0;
  bool stop_ = false;
  std::optional<Error> error_;

  std::optional<Block> current_;
  std::int64_t at_ = 0;  ///< in the current block
  std::thread reader_;
};

}  // namespace gravure::session
