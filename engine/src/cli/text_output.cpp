#include "text_output.hpp"

#include <utility>

#include "verb.hpp"

namespace gravure::cli {

Result<TextOutput> TextOutput::create(const std::string& path) {
  GRAVURE_TRY(FileOutput output, FileOutput::create(path));
  std::FILE* file = std::fopen(output.temporary_path().c_str(), "w");
  if (file == nullptr) {
    return Error{ErrorCode::io, path + ": cannot open the output"};
  }
  return TextOutput(std::move(output), file);
}

Result<TextOutput> TextOutput::staged(const std::string& path, std::string text) {
  GRAVURE_TRY(TextOutput output, create(path));
  output.text_ = std::move(text);
  if (!output.flush(true) || std::fflush(output.file_.get()) != 0) {
    return Error{ErrorCode::io, path + ": cannot be written: is the disk full?"};
  }
  return output;
}

bool TextOutput::flush(bool all) {
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  if (text_.size() >= kPiece || all) {
    good_ = std::fwrite(text_.data(), 1, text_.size(), file_.get()) == text_.size() && good_;
    text_.clear();
  }
  return good_;
}

Result<void> TextOutput::commit() {
  flush(true);
  good_ = std::fclose(file_.release()) == 0 && good_;
  if (!good_) {
    return Error{ErrorCode::io, output_.path() + ": cannot write: is the disk full?"};
  }
  return output_.commit();
}

Result<void> commit_together(std::vector<TextOutput> files) {
  for (TextOutput& file : files) {
    if (!file.flush(true) || std::fflush(file.file_.get()) != 0) {
      return Error{ErrorCode::io, file.output_.path() + ": cannot be written: is the disk full?"};
    }
  }
  if (cancel_token().cancelled()) {
    return Error{ErrorCode::cancelled, "stopped; nothing was written"};
  }
  for (TextOutput& file : files) {
    GRAVURE_CHECK(file.commit());
  }
  return {};
}

}  // namespace gravure::cli
