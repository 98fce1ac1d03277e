#include "job/source_hashes.hpp"

#include <chrono>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "gravure/formats/image_files.hpp"
#include "verb.hpp"

namespace gravure::cli {

/// The files one after the other, each once.
class SourceHashes::Run {
 public:
  explicit Run(std::vector<std::string> files) : files_(std::move(files)) {
    for (const std::string& file : files_) {
      std::error_code unknown;
      if (known_.emplace(file, "").second) {
        const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
        all_bytes_ += unknown ? 0 : static_cast<double>(bytes);
      }
    }
  }

  double all_bytes() const { return all_bytes_; }

  /// Until that many of their bytes are taken in, or to their ends.
  Result<void> go_on(double bytes, const CancelToken& cancel) {
    while (!failure_ && at_ < files_.size() && taken_ < bytes) {
      if (cancel.cancelled()) {
        return Error{ErrorCode::cancelled, files_[at_] + ": stopped before its SHA-256 was known"};
      }
      if (const Result<void> stepped = step(); !stepped) {
        failure_ = stepped.error();
      }
    }
    return failure_ ? Result<void>(*failure_) : Result<void>();
  }

  Result<std::vector<std::string>> finish(const CancelToken& cancel) {
    GRAVURE_CHECK(go_on(std::numeric_limits<double>::infinity(), cancel));
    std::vector<std::string> hashes;
    for (const std::string& file : files_) {
      hashes.push_back(known_[file]);
    }
    return hashes;
  }

 private:
  Result<void> step() {
    std::string& hash = known_[files_[at_]];
    if (!hash.empty()) {
      ++at_;
      return {};
    }
    if (!open_) {
      GRAVURE_TRY(open_, Sha256File::open(files_[at_]));
    }
    GRAVURE_TRY(const std::size_t got, open_->next());
    taken_ += static_cast<double>(got);
    if (got == 0) {
      hash = open_->finish();
      open_.reset();
    }
    return {};
  }

  std::vector<std::string> files_;
  std::map<std::string, std::string> known_;
  std::size_t at_ = 0;
  std::optional<Sha256File> open_;
  double all_bytes_ = 0;
  double taken_ = 0;
  std::optional<Error> failure_;
};

SourceHashes::SourceHashes(std::vector<std::string> files, bool own_thread)
    : run_(std::make_unique<Run>(std::move(files))) {
  if (own_thread) {
    found_ = std::async(std::launch::async, [this] { return run_->finish(stop_); });
  }
}

SourceHashes::~SourceHashes() {
  stop_.cancel();
}

void SourceHashes::go_on(std::int64_t done, std::int64_t total) {
  if (!found_.valid()) {
    const double share = static_cast<double>(done) / static_cast<double>(total);
    static_cast<void>(run_->go_on(share * run_->all_bytes(), cancel_token()));
  }
}

Result<std::vector<std::string>> SourceHashes::wait() {
  if (!found_.valid()) {
    return run_->finish(cancel_token());
  }
  constexpr auto kLook = std::chrono::milliseconds(50);
  while (found_.wait_for(kLook) == std::future_status::timeout) {
    if (cancel_token().cancelled()) {
      stop_.cancel();
    }
  }
  return found_.get();
}

}  // namespace gravure::cli
