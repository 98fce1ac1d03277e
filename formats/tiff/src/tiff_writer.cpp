#include "gravure/formats/tiff_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "gravure/core/file_output.hpp"
#include "gravure/core/image_source.hpp"
#include "gravure/formats/tiff.hpp"
#include "tiff_handle.hpp"
#include "tiff_page_info.hpp"

namespace gravure {
namespace {

constexpr double kClassicLimitBytes = 3.5e9;
constexpr std::int64_t kStripBytes = std::int64_t{256} << 10;

std::uint16_t libtiff_code(TiffCompression compression) {
  switch (compression) {
    case TiffCompression::none:
      return COMPRESSION_NONE;
    case TiffCompression::packbits:
      return COMPRESSION_PACKBITS;
    case TiffCompression::lzw:
      return COMPRESSION_LZW;
    case TiffCompression::deflate:
      return COMPRESSION_ADOBE_DEFLATE;
    case TiffCompression::g4:
      return COMPRESSION_CCITTFAX4;
    case TiffCompression::zstd:
      return COMPRESSION_ZSTD;
  }
  return COMPRESSION_NONE;
}

Result<void> check_page(const std::string& path, const BilevelTiffPage& page) {
  const std::int64_t most = kMaxTiffRowBytes * 8 / page.bits;
  if (page.width < 1 || page.width > most || page.height < 1 || page.height > kMaxTiffHeight) {
    return Error{ErrorCode::out_of_range, path + ": a page of " + std::to_string(page.width) + " x " +
                                              std::to_string(page.height) + " pixels: the width must be 1 to " +
                                              std::to_string(most) + ", the height 1 to " +
                                              std::to_string(kMaxTiffHeight)};
  }
  for (const auto& dots : {page.x_dots_per_mm, page.y_dots_per_mm}) {
    if (page.x_dots_per_mm.has_value() != page.y_dots_per_mm.has_value() ||
        (dots && !(std::isfinite(*dots) && *dots > 0))) {
      return Error{ErrorCode::bad_argument,
                   path + ": the dots per mm must be given for both directions or none, and be greater than 0"};
    }
  }
  return {};
}

std::int64_t page_row_bytes(const BilevelTiffPage& page) {
  return row_bytes(page.bits == 8 ? SampleType::u8 : SampleType::bit, page.width);
}

/// Fax codes of noise take up to about 2.5 times the raw bits; the other codecs stay near them at worst.
bool needs_big_tiff(const BilevelTiffPage& page, std::int64_t page_count) {
  const double raw = static_cast<double>(page_row_bytes(page)) * static_cast<double>(page.height) *
                     static_cast<double>(std::max<std::int64_t>(page_count, 1));
  return raw * (page.compression == TiffCompression::g4 ? 2.5 : 1.0) > kClassicLimitBytes;
}

}  // namespace

class BilevelTiffWriter::State {
 public:
  State(FileOutput output, bool big_tiff)
      : output_(std::move(output)), handle_(output_.temporary_path(), big_tiff ? "w8" : "w") {}

  bool opened() const { return static_cast<bool>(handle_); }
  const std::string& path() const { return output_.path(); }

  Error failure(const std::string& what) const {
    return {ErrorCode::io, path() + ": " + what + ": is the disk full?" + handle_.messages().text()};
  }

  Result<void> begin(const BilevelTiffPage& page);
  Result<void> append(std::span<const std::byte> rows);
  Result<void> end();
  Result<FileOutput> finish();

 private:
  Result<void> write_strip();

  FileOutput output_;
  TiffHandle handle_;
  BilevelTiffPage page_;
  std::int64_t row_bytes_ = 0;
  std::int64_t rows_per_strip_ = 0;
  std::int64_t rows_written_ = 0;  // in whole strips
  std::vector<std::byte> strip_;   // rows not yet written
};

Result<void> BilevelTiffWriter::State::begin(const BilevelTiffPage& page) {
  GRAVURE_CHECK(check_page(path(), page));
  page_ = page;
  row_bytes_ = page_row_bytes(page);
  rows_per_strip_ = std::clamp<std::int64_t>(kStripBytes / row_bytes_, 1, page.height);
  rows_written_ = 0;
  strip_.clear();
  strip_.reserve(static_cast<std::size_t>(rows_per_strip_ * row_bytes_));
  TIFF* const tiff = handle_.get();
  bool done = TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(page.width)) == 1;
  done = TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(page.height)) == 1 && done;
  done = TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, page.bits) == 1 && done;
  done = TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1) == 1 && done;
  done = TIFFSetField(tiff, TIFFTAG_COMPRESSION, libtiff_code(page.compression)) == 1 && done;
  done = TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
                      page.zero_is_white ? PHOTOMETRIC_MINISWHITE : PHOTOMETRIC_MINISBLACK) == 1 &&
         done;
  done = TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) == 1 && done;
  done = TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == 1 && done;
  done = TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows_per_strip_)) == 1 && done;
  if (page.x_dots_per_mm && page.y_dots_per_mm) {
    done = TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER) == 1 && done;
    done = TIFFSetField(tiff, TIFFTAG_XRESOLUTION, *page.x_dots_per_mm * 10.0) == 1 && done;
    done = TIFFSetField(tiff, TIFFTAG_YRESOLUTION, *page.y_dots_per_mm * 10.0) == 1 && done;
  }
  return done ? Result<void>() : failure("cannot write the header");
}

Result<void> BilevelTiffWriter::State::append(std::span<const std::byte> rows) {
  const auto waiting = static_cast<std::int64_t>(strip_.size()) / row_bytes_;
  const std::int64_t left = page_.height - rows_written_ - waiting;
  const auto bytes = static_cast<std::int64_t>(rows.size());
  if (bytes % row_bytes_ != 0 || bytes / row_bytes_ > left) {
    return Error{ErrorCode::bad_argument, path() + ": " + std::to_string(bytes) + " bytes given: rows are " +
                                              std::to_string(row_bytes_) + " bytes and " + std::to_string(left) +
                                              " of them are left on this page"};
  }
  const auto unused_bits = static_cast<unsigned>(row_bytes_ * 8 - page_.width * page_.bits);
  const auto last_mask = static_cast<std::byte>(0xFFU << unused_bits & 0xFFU);
  for (; !rows.empty(); rows = rows.subspan(static_cast<std::size_t>(row_bytes_))) {
    strip_.insert(strip_.end(), rows.begin(), rows.begin() + row_bytes_);
    strip_.back() &= last_mask;
    if (static_cast<std::int64_t>(strip_.size()) == rows_per_strip_ * row_bytes_) {
      GRAVURE_CHECK(write_strip());
    }
  }
  return {};
}

Result<void> BilevelTiffWriter::State::write_strip() {
  if (strip_.empty()) {
    return {};
  }
  const auto number = static_cast<std::uint32_t>(rows_written_ / rows_per_strip_);
  const auto bytes = static_cast<std::int64_t>(strip_.size());
  handle_.messages().clear();
  if (TIFFWriteEncodedStrip(handle_.get(), number, strip_.data(), bytes) != bytes) {
    return failure("cannot write row " + std::to_string(rows_written_));
  }
  rows_written_ += bytes / row_bytes_;
  strip_.clear();
  return {};
}

Result<void> BilevelTiffWriter::State::end() {
  GRAVURE_CHECK(write_strip());
  if (rows_written_ != page_.height) {
    return Error{ErrorCode::bad_argument, path() + ": the page has " + std::to_string(rows_written_) + " of its " +
                                              std::to_string(page_.height) + " rows: it cannot end yet"};
  }
  handle_.messages().clear();
  return TIFFWriteDirectory(handle_.get()) == 1 ? Result<void>() : failure("cannot write the directory");
}

Result<FileOutput> BilevelTiffWriter::State::finish() {
  GRAVURE_CHECK(end());
  handle_.messages().clear();
  handle_.close();
  if (handle_.messages().error[0] != '\0') {
    return failure("cannot finish the file");
  }
  GRAVURE_CHECK(output_.sync());
  return std::move(output_);
}

Result<BilevelTiffWriter> BilevelTiffWriter::create(const std::string& path, const BilevelTiffPage& first_page,
                                                    std::int64_t page_count) {
  GRAVURE_CHECK(check_page(path, first_page));
  GRAVURE_TRY(FileOutput output, FileOutput::create(path));
  auto state = std::make_unique<State>(std::move(output), needs_big_tiff(first_page, page_count));
  if (!state->opened()) {
    return state->failure("cannot begin the file");
  }
  GRAVURE_CHECK(state->begin(first_page));
  return BilevelTiffWriter(std::move(state));
}

BilevelTiffWriter::BilevelTiffWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
BilevelTiffWriter::BilevelTiffWriter(BilevelTiffWriter&&) noexcept = default;
BilevelTiffWriter& BilevelTiffWriter::operator=(BilevelTiffWriter&&) noexcept = default;
BilevelTiffWriter::~BilevelTiffWriter() = default;

Result<void> BilevelTiffWriter::append_rows(std::span<const std::byte> rows) {
  return state_->append(rows);
}

Result<void> BilevelTiffWriter::begin_page(const BilevelTiffPage& page) {
  GRAVURE_CHECK(state_->end());
  return state_->begin(page);
}

Result<FileOutput> BilevelTiffWriter::finish() {
  return state_->finish();
}

Result<void> BilevelTiffWriter::commit() {
  GRAVURE_TRY(FileOutput output, finish());
  return output.commit();
}

}  // namespace gravure
