#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gravure/core/image_source.hpp"

namespace gravure::test {

/// Headers out of a table: file name (without folder) -> pages.
class FakeImages final : public ImageOpener {
 public:
  std::map<std::string, std::vector<ImageInfo>> files;

  void add(const std::string& name, std::int64_t width, std::int64_t height, SampleType samples = SampleType::bit) {
    ImageInfo info;
    info.width = width;
    info.height = height;
    info.samples = samples;
    files[name].push_back(info);
  }

  Result<std::int64_t> count_pages(const std::string& path) const override {
    return static_cast<std::int64_t>(files.at(name_of(path)).size());
  }
  Result<std::unique_ptr<ImageSource>> open(const std::string& path, std::int64_t page) const override {
    ImageInfo info = files.at(name_of(path)).at(static_cast<std::size_t>(page));
    info.path = path;
    info.page = page;
    return std::unique_ptr<ImageSource>(new Source(info));
  }

 private:
  class Source final : public ImageSource {
   public:
    explicit Source(ImageInfo info) : info_(std::move(info)) {}
    const ImageInfo& info() const noexcept override { return info_; }
    Result<void> read_rows(std::int64_t, std::int64_t, std::span<std::byte>) override {
      return Error{ErrorCode::bad_file, "headers only: the rows must not be read here"};
    }

   private:
    ImageInfo info_;
  };
  static std::string name_of(const std::string& path) { return path.substr(path.rfind('/') + 1); }
};

}  // namespace gravure::test
