#include "job/source_hashes.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "gravure/formats/image_files.hpp"

namespace gravure::cli {
namespace {

/// By what a file is known to be another one. The time of writing can be set back, that of the last change of any kind
/// cannot.
struct Stamp {
  dev_t device = 0;
  ino_t inode = 0;
  std::int64_t bytes = 0;
  std::array<std::int64_t, 2> written_s_ns = {};
  std::array<std::int64_t, 2> changed_s_ns = {};
  friend bool operator==(const Stamp&, const Stamp&) = default;
};

std::optional<Stamp> stamp_of(const std::string& file) {
  struct stat is = {};
  if (::stat(file.c_str(), &is) != 0) {
    return std::nullopt;
  }
  return Stamp{is.st_dev,
               is.st_ino,
               is.st_size,
               {is.st_mtim.tv_sec, is.st_mtim.tv_nsec},
               {is.st_ctim.tv_sec, is.st_ctim.tv_nsec}};
}

}  // namespace

/// The files one after the other, each once.
class SourceHashes::Run {
 public:
  explicit Run(std::vector<std::string> files) : files_(std::move(files)) {
    for (const std::string& file : files_) {
      const auto [known, is_new] = known_.try_emplace(file);
      if (is_new) {
        known->second.stamp = stamp_of(file);
        all_bytes_ += known->second.stamp ? static_cast<std::int64_t>(known->second.stamp->bytes) : 0;
      }
    }
  }

  std::int64_t all_bytes() const { return all_bytes_; }
  /// Any thread may ask.
  std::int64_t taken_bytes() const { return taken_bytes_; }
  bool at_end() const { return at_ == files_.size(); }

  /// Until that many of their bytes are taken in, or to their ends.
  Result<void> go_on(std::int64_t bytes, const CancelToken& cancel) {
    while (!failure_ && !at_end() && taken_bytes_ < bytes) {
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
    GRAVURE_CHECK(go_on(std::numeric_limits<std::int64_t>::max(), cancel));
    std::vector<std::string> hashes;
    for (const std::string& file : files_) {
      hashes.push_back(known_[file].hash);
    }
    return hashes;
  }

  /// Any thread may ask.
  Result<void> check_unchanged() const {
    for (const auto& [file, source] : known_) {
      if (stamp_of(file) != source.stamp) {
        return Error{ErrorCode::bad_file,
                     file +
                         ": changed while it was compiled (written to, replaced or removed): the program need not be "
                         "what its SHA-256 says; compile again when the file is done"};
      }
    }
    return {};
  }

 private:
  struct Source {
    std::optional<Stamp> stamp;
    std::string hash;
  };

  Result<void> step() {
    std::string& hash = known_[files_[at_]].hash;
    if (!hash.empty()) {
      ++at_;
      return {};
    }
    if (!open_) {
      GRAVURE_TRY(open_, Sha256File::open(files_[at_]));
    }
    GRAVURE_TRY(const std::size_t got, open_->next());
    taken_bytes_ += static_cast<std::int64_t>(got);
    if (got == 0) {
      hash = open_->finish();
      open_.reset();
    }
    return {};
  }

  std::vector<std::string> files_;
  std::map<std::string, Source> known_;
  std::int64_t all_bytes_ = 0;
  std::atomic<std::int64_t> taken_bytes_{0};
  std::size_t at_ = 0;
  std::optional<Sha256File> open_;
  std::optional<Error> failure_;
};

SourceHashes::SourceHashes(std::vector<std::string> files, Begin begin, const CancelToken& cancel)
    : cancel_(cancel), run_(std::make_unique<Run>(std::move(files))) {
  if (begin == Begin::now) {
    try {
      found_ = std::async(std::launch::async, [this] { return run_->finish(stop_); });
    } catch (const std::system_error&) {  // no thread to be had: in step, then
    }
  }
}

SourceHashes::~SourceHashes() {
  stop_.cancel();
}

void SourceHashes::go_on(std::int64_t done, std::int64_t total) {
  if (!found_.valid() && total > 0) {
    const double share = static_cast<double>(done) / static_cast<double>(total);
    static_cast<void>(run_->go_on(static_cast<std::int64_t>(share * static_cast<double>(run_->all_bytes())), cancel_));
  }
}

Result<std::vector<std::string>> SourceHashes::wait(Progress& progress) {
  constexpr auto kLook = std::chrono::milliseconds(50);
  constexpr std::int64_t kPiece = std::int64_t{16} << 20;
  constexpr std::int64_t kMb = 1'000'000;
  const std::int64_t before = run_->taken_bytes();
  const std::int64_t left_mb = (run_->all_bytes() - before) / kMb;
  const auto tell = [&] {
    if (left_mb > 0) {
      progress.update(std::min((run_->taken_bytes() - before) / kMb, left_mb), left_mb);
    }
  };
  const bool own_thread = found_.valid();
  for (std::int64_t piece = before + kPiece; !own_thread && !run_->at_end(); piece += kPiece) {
    GRAVURE_CHECK(run_->go_on(piece, cancel_));
    tell();
  }
  while (own_thread && found_.wait_for(kLook) == std::future_status::timeout) {
    tell();
    if (cancel_.cancelled()) {
      stop_.cancel();
    }
  }
  GRAVURE_TRY(std::vector<std::string> hashes, own_thread ? found_.get() : run_->finish(cancel_));
  tell();
  GRAVURE_CHECK(run_->check_unchanged());
  return hashes;
}

Result<void> SourceHashes::check_unchanged() const {
  return run_->check_unchanged();
}

}  // namespace gravure::cli
