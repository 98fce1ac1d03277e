#pragma once

#include <atomic>
#include <cstdint>

namespace gravure {

/// Asked to stop? Set from a signal handler or another thread, looked at between units of work.
class CancelToken {
 public:
  void cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> cancelled_{false};
};
static_assert(std::atomic<bool>::is_always_lock_free);

/// Told how far a long job is. Calls may come from any thread, one at a time.
class Progress {
 public:
  virtual ~Progress() = default;
  /// `done` of `total` units (lines); `done` never falls.
  virtual void update(std::int64_t done, std::int64_t total) = 0;
};

}  // namespace gravure
