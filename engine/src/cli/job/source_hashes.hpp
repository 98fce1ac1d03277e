#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/progress.hpp"

namespace gravure::cli {

/// SHA-256 of files, found while other work goes on: by a thread of its own, or, where one thread is to do everything,
/// in step with that work. Giving up stops it.
class SourceHashes {
 public:
  SourceHashes(std::vector<std::string> files, bool own_thread);
  SourceHashes(const SourceHashes&) = delete;
  SourceHashes& operator=(const SourceHashes&) = delete;
  ~SourceHashes();

  /// Without a thread: goes on to that share of the files. What the work has just read of them is still in the caches:
  /// large files are fetched from the disk once, small ones copied in half the time. Failures wait for wait().
  void go_on(std::int64_t done, std::int64_t total);
  /// Those of the files, in their order, once; waits for them. Fails as sha256_file() does.
  Result<std::vector<std::string>> wait();

 private:
  class Run;
  CancelToken stop_;
  std::unique_ptr<Run> run_;
  std::future<Result<std::vector<std::string>>> found_;  ///< with a thread; its end waits for it
};

}  // namespace gravure::cli
