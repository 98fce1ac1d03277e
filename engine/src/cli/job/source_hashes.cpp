#include "job/source_hashes.hpp"

#include <chrono>
#include <map>
#include <utility>

#include "gravure/formats/image_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

Result<std::vector<std::string>> hash_all(const std::vector<std::string>& files, const CancelToken& cancel) {
  std::map<std::string, std::string> known;
  std::vector<std::string> hashes;
  for (const std::string& file : files) {
    std::string& hash = known[file];
    if (hash.empty()) {
      GRAVURE_TRY(hash, sha256_file(file, &cancel));
    }
    hashes.push_back(hash);
  }
  return hashes;
}

}  // namespace

SourceHashes::SourceHashes(std::vector<std::string> files, bool own_thread)
    : found_(std::async(own_thread ? std::launch::async : std::launch::deferred,
                        [files = std::move(files), cancel = own_thread ? &stop_ : &cancel_token()] {
                          return hash_all(files, *cancel);
                        })) {}

Result<std::vector<std::string>> SourceHashes::wait() {
  constexpr auto kLook = std::chrono::milliseconds(50);
  while (found_.wait_for(kLook) == std::future_status::timeout) {
    if (cancel_token().cancelled()) {
      stop_.cancel();
    }
  }
  return found_.get();
}

}  // namespace gravure::cli
