#pragma once

#include <filesystem>
#include <string>

#include "gravure/core/error.hpp"

namespace gravure::cli {

/// A folder that appears whole or not at all, where there was none or an empty one.
class FolderOutput {
 public:
  static Result<FolderOutput> create(const std::string& path);
  FolderOutput(FolderOutput&& other) noexcept;
  FolderOutput(const FolderOutput&) = delete;
  FolderOutput& operator=(const FolderOutput&) = delete;
  FolderOutput& operator=(FolderOutput&&) = delete;
  ~FolderOutput();

  /// Where a file of the folder is written until commit().
  std::filesystem::path file(const std::string& name) const { return temporary_ / name; }
  /// Puts it in its place; cancelled, without a trace, where the user has stopped before.
  Result<void> commit();

 private:
  FolderOutput(std::filesystem::path path, std::filesystem::path temporary);
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

}  // namespace gravure::cli
