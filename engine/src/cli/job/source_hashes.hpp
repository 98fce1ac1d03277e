#pragma once

#include <future>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/progress.hpp"

namespace gravure::cli {

/// SHA-256 of files, found while other work goes on: by a thread of its own, or, where one thread is to do everything,
/// when they are asked for. Giving up stops it.
class SourceHashes {
 public:
  SourceHashes(std::vector<std::string> files, bool own_thread);
  SourceHashes(const SourceHashes&) = delete;
  SourceHashes& operator=(const SourceHashes&) = delete;
  ~SourceHashes() { stop_.cancel(); }

  /// Those of the files, in their order, once; waits for them. Fails as sha256_file() does.
  Result<std::vector<std::string>> wait();

 private:
  CancelToken stop_;
  std::future<Result<std::vector<std::string>>> found_;  // its end waits for the thread
};

}  // namespace gravure::cli
