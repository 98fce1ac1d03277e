#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/progress.hpp"

namespace gravure::cli {

/// SHA-256 of files that other work reads meanwhile: found by a thread of its own from now on, or, where one thread is
/// to do everything or no thread is to be had, in step with that work. Giving up stops it.
class SourceHashes {
 public:
  enum class Begin : std::uint8_t { now, in_step };
  SourceHashes(std::vector<std::string> files, Begin begin, const CancelToken& cancel);
  SourceHashes(const SourceHashes&) = delete;
  SourceHashes& operator=(const SourceHashes&) = delete;
  ~SourceHashes();

  /// Without a thread: goes on to that share of the files. What the work has just read of them is still in the caches:
  /// large files are fetched from the disk once, small ones copied in half the time. Failures wait for wait().
  void go_on(std::int64_t done, std::int64_t total);
  /// Those of the files, in their order, once; waits for them, and tells how many MB of those still to be read are.
  /// Fails as Sha256File and check_unchanged() do, and with cancelled when asked to stop.
  Result<std::vector<std::string>> wait(Progress& progress);
  /// bad_file where a file is not the one that was there at the beginning: what was made of it need not be what its
  /// hash says.
  Result<void> check_unchanged() const;

 private:
  class Run;
  const CancelToken& cancel_;
  CancelToken stop_;
  std::unique_ptr<Run> run_;
  std::future<Result<std::vector<std::string>>> found_;  ///< with a thread; its end waits for it
};

}  // namespace gravure::cli
