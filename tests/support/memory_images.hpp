#pragma once

#include <atomic>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/image_source.hpp"

namespace gravure::test {

/// One sample of an image by row and column; bits are 0 and 1 as they lie in the file.
using Samples = std::function<double(std::int64_t row, std::int64_t column)>;

/// Images that are computed instead of read, behind the interface of the readers, with books kept on how they are read.
class MemoryImages final : public ImageOpener {
 public:
  struct Image {
    ImageInfo info;
    Samples samples;
    std::optional<std::int64_t> damaged_row;  ///< reading it fails
    /// Fills a packed row at once instead of `samples`, for pictures of many pixels.
    std::function<void(std::int64_t row, std::span<std::byte> out)> packed_row;
    ErrorCode damage = ErrorCode::bad_file;  ///< what reading the damaged row fails with
  };

  void add(Image image) {
    const auto key = std::pair(image.info.path, image.info.page);
    images_.insert_or_assign(key, std::move(image));
  }
  Image& at(const std::string& path, std::int64_t page = 0) { return images_.at({path, page}); }

  Result<std::int64_t> count_pages(const std::string& path) const override {
    std::int64_t pages = 0;
    for (const auto& each : images_) {
      pages += each.first.first == path ? 1 : 0;
    }
    return pages;
  }

  Result<std::unique_ptr<ImageSource>> open(const std::string& path, std::int64_t page) const override {
    const auto found = images_.find({path, page});
    if (found == images_.end()) {
      return Error{ErrorCode::bad_file, path + ": page " + std::to_string(page) + " is not there"};
    }
    ++opened_;
    return std::unique_ptr<ImageSource>(std::make_unique<Source>(*this, found->second));
  }

  std::int64_t opened() const { return opened_; }
  std::int64_t rows_read() const { return rows_read_; }
  /// Strips that readers which keep their latest one would have decoded.
  std::int64_t blocks_decoded() const { return blocks_decoded_; }

 private:
  class Source final : public ImageSource {
   public:
    Source(const MemoryImages& parent, const Image& image) : parent_(parent), image_(image) {}
    const ImageInfo& info() const noexcept override { return image_.info; }

    Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) override {
      const std::int64_t bytes = row_bytes(image_.info.samples, image_.info.width);
      const std::string where = image_.info.path + ": rows from " + std::to_string(first_row);
      if (first_row < 0 || row_count < 1 || first_row + row_count > image_.info.height ||
          out.size() != static_cast<std::size_t>(row_count * bytes)) {
        return Error{ErrorCode::bad_argument, where + " or their buffer do not fit the image"};
      }
      if (!image_.info.random_access && first_row < next_row_) {
        return Error{ErrorCode::bad_file, where + ": this file is only read upwards"};
      }
      const std::int64_t damaged = image_.damaged_row.value_or(-1);
      if (damaged >= first_row && damaged < first_row + row_count) {
        return Error{image_.damage, image_.info.path + ": row " + std::to_string(damaged) + " is damaged"};
      }
      next_row_ = first_row + row_count;
      parent_.rows_read_ += row_count;
      for (std::int64_t row = first_row; row < first_row + row_count; ++row) {
        parent_.blocks_decoded_ += row / image_.info.rows_per_block != kept_block_ ? 1 : 0;
        kept_block_ = row / image_.info.rows_per_block;
      }
      for (std::int64_t row = 0; row < row_count; ++row) {
        fill(first_row + row, out.subspan(static_cast<std::size_t>(row * bytes), static_cast<std::size_t>(bytes)));
      }
      return {};
    }

   private:
    template <class T>
    void fill_as(std::int64_t row, std::span<std::byte> out) const {
      for (std::int64_t column = 0; column < image_.info.width; ++column) {
        const T sample = static_cast<T>(image_.samples(row, column));
        std::memcpy(out.data() + static_cast<std::size_t>(column) * sizeof(T), &sample, sizeof(T));
      }
    }
    void fill(std::int64_t row, std::span<std::byte> out) const {
      if (image_.packed_row) {
        return image_.packed_row(row, out);
      }
      switch (image_.info.samples) {
        case SampleType::bit:
          std::memset(out.data(), 0xFF, out.size());  // bits beyond the width may hold anything
          for (std::int64_t column = 0; column < image_.info.width; ++column) {
            if (image_.samples(row, column) == 0) {
              out[static_cast<std::size_t>(column / 8)] &= static_cast<std::byte>(~(0x80U >> (column % 8)));
            }
          }
          break;
        case SampleType::u8:
          return fill_as<std::uint8_t>(row, out);
        case SampleType::u16:
          return fill_as<std::uint16_t>(row, out);
        case SampleType::f32:
          return fill_as<float>(row, out);
      }
    }

    const MemoryImages& parent_;
    const Image& image_;
    std::int64_t next_row_ = 0;
    std::int64_t kept_block_ = -1;
  };

  std::map<std::pair<std::string, std::int64_t>, Image> images_;
  mutable std::atomic<std::int64_t> opened_{0};
  mutable std::atomic<std::int64_t> rows_read_{0};
  mutable std::atomic<std::int64_t> blocks_decoded_{0};
};

}  // namespace gravure::test
