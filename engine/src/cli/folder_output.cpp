#include "folder_output.hpp"

#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp

#include <utility>

#include "verb.hpp"

namespace gravure::cli {

namespace fs = std::filesystem;

FolderOutput::FolderOutput(fs::path path, fs::path temporary)
    : path_(std::move(path)), temporary_(std::move(temporary)) {}

FolderOutput::FolderOutput(FolderOutput&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}

FolderOutput::~FolderOutput() {
  std::error_code ignored;
  if (!temporary_.empty()) {
    fs::remove_all(temporary_, ignored);
  }
}

Result<FolderOutput> FolderOutput::create(const std::string& path) {
  std::error_code failed;
  const fs::file_status there = fs::symlink_status(path, failed);
  if (fs::exists(there) && (!fs::is_directory(there) || !fs::is_empty(path, failed))) {
    return Error{ErrorCode::bad_argument, path + ": is there already, and is no empty folder; give another"};
  }
  const fs::path whole = fs::path(path).has_filename() ? fs::path(path) : fs::path(path).parent_path();
  if (whole.filename() == "." || whole.filename() == ".." || whole == whole.root_path()) {
    return Error{ErrorCode::bad_argument, path +
                                              ": a folder of another name takes its place when it is whole; give "
                                              "the name of a new or empty folder"};
  }
  std::string temporary = whole.string() + ".XXXXXX";
  if (::mkdtemp(temporary.data()) == nullptr) {
    return Error{ErrorCode::io, path + ": cannot make a folder beside it; is its parent there and writable?"};
  }
  constexpr fs::perms kUsual = fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                               fs::perms::others_read | fs::perms::others_exec;
  fs::permissions(temporary, fs::exists(there) ? there.permissions() : kUsual, failed);
  return FolderOutput(whole, temporary);
}

Result<void> FolderOutput::commit() {
  GRAVURE_CHECK(check_not_stopped());
  std::error_code failed;
  fs::rename(temporary_, path_, failed);
  if (failed) {
    return Error{ErrorCode::io, path_.string() + ": cannot put the folder in its place: " + failed.message()};
  }
  temporary_.clear();
  return {};
}

}  // namespace gravure::cli
