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

bool TextOutput::flush(bool all) {
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  if (text_.size() >= kPiece || all) {
    good_ = std::fwrite(text_.data(), 1, text_.size(), file_.get()) == text_.size() && good_;
    text_.clear();
  }
  return good_;
}

Result<void> TextOutput::finish() {
  if (file_ == nullptr) {
    return {};
  }
  flush(true);
  good_ = std::fclose(file_.release()) == 0 && good_;
  if (!good_) {
    return Error{ErrorCode::io, output_.path() + ": cannot write: is the disk full?"};
  }
  return output_.sync();
}

Result<void> TextOutput::commit() {
  GRAVURE_CHECK(finish());
  return output_.commit();
}

Result<void> commit_together(std::vector<TextOutput> files) {
  for (TextOutput& file : files) {
    GRAVURE_CHECK(file.finish());
  }
  GRAVURE_CHECK(check_not_stopped());
  for (TextOutput& file : files) {
    GRAVURE_CHECK(file.commit());
  }
  return {};
}

Result<void> write_texts(const std::vector<TextFile>& files) {
  std::vector<FileOutput> written;
  for (const TextFile& file : files) {
    if (!file.path.empty()) {
      GRAVURE_TRY(FileOutput output, stage_file(file.path, file.text));
      written.push_back(std::move(output));
    }
  }
  GRAVURE_CHECK(check_not_stopped());
  for (FileOutput& file : written) {
    GRAVURE_CHECK(file.commit());
  }
  return {};
}

}  // namespace gravure::cli
