#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/file_output.hpp"

namespace gravure::cli {

/// A text file written piece by piece, whole or not at all.
class TextOutput {
 public:
  static Result<TextOutput> create(const std::string& path);
  std::string& text() { return text_; }
  /// Writes away what has gathered, when it is worth it; false once a write has failed.
  bool flush(bool all);
  /// All of it on the disk, but not in its place yet: what is left of commit() then seldom fails.
  Result<void> finish();
  Result<void> commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
  };
  TextOutput(FileOutput output, std::FILE* file) : output_(std::move(output)), file_(file) {}
  FileOutput output_;
  std::unique_ptr<std::FILE, Close> file_;
  std::string text_;
  bool good_ = true;
};

/// Puts files that were written in their places: all of them, or none where one cannot be written to its end or the
/// user has stopped before. From the first on Ctrl-C changes nothing any more.
Result<void> commit_together(std::vector<TextOutput> files);

struct TextFile {
  std::string path;  ///< empty: not asked for
  std::string text;
};

/// Writes the files of one run that were asked for: all of them, or none where the user has stopped before.
Result<void> write_texts(const std::vector<TextFile>& files);

}  // namespace gravure::cli
