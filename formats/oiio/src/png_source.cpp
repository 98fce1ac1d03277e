#include "png_source.hpp"

#include <png.h>

#include <array>
#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <utility>

#include "gravure/core/file_output.hpp"
#include "header_facts.hpp"
#include "row_request.hpp"

namespace gravure::oiio {
namespace {

using Reason = std::array<char, 200>;

/// libpng would print the message if this returned.
[[noreturn]] void keep_reason(png_structp png, png_const_charp message) {
  Reason& reason = *static_cast<Reason*>(png_get_error_ptr(png));
  std::snprintf(reason.data(), reason.size(), "%s", message);
  png_longjmp(png, 1);
}

/// Of chunks that are of no use here: profiles, gamma, texts.
void ignore_warning(png_structp, png_const_charp) {}

// libpng leaves a call that fails by longjmp(): nothing with a destructor may live in the two functions below.

bool read_start(png_structp png, png_infop info, std::FILE* file) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  png_init_io(png, file);
  png_read_info(png, info);
  if (std::endian::native == std::endian::little) {
    png_set_swap(png);
  }
  return true;
}

bool read_row(png_structp png, std::byte* out) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  png_read_row(png, reinterpret_cast<png_bytep>(out), nullptr);
  return true;
}

}  // namespace

class PngDecoder {
 public:
  explicit PngDecoder(const std::string& path)
      : file_(std::fopen(path.c_str(), "rb")),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &reason_, keep_reason, ignore_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ == nullptr) {
      release();
      throw std::bad_alloc();
    }
  }
  ~PngDecoder() { release(); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  bool is_open() const { return file_ != nullptr; }
  bool start() { return read_start(png_, info_, file_); }
  bool row(std::byte* out) { return read_row(png_, out); }
  std::string reason() const { return reason_.data(); }

 private:
  void release() {
    png_destroy_read_struct(&png_, &info_, nullptr);
    if (file_ != nullptr) {
      std::fclose(file_);
    }
  }

  Reason reason_ = {};
  std::FILE* file_;
  png_structp png_;
  png_infop info_;
};

namespace {

Result<std::unique_ptr<PngDecoder>> start_decoder(const std::string& path) {
  auto decoder = std::make_unique<PngDecoder>(path);
  if (!decoder->is_open()) {
    return Error{ErrorCode::io, path + ": cannot be opened any more: was it moved, or are too many files open?"};
  }
  errno = 0;
  if (!decoder->start()) {
    if (const int reason = errno; is_device_failure(reason)) {
      return read_error(path, reason);
    }
    return bad_file(path, "cannot be opened: the file is damaged: " + decoder->reason() + "; copy or export it again");
  }
  return decoder;
}

}  // namespace

Result<void> check_png_start(const std::string& path) {
  GRAVURE_TRY(const auto decoder, start_decoder(path));
  return {};
}

PngSource::PngSource(ImageInfo info) : info_(std::move(info)) {}
PngSource::~PngSource() = default;

Result<void> PngSource::begin() {
  GRAVURE_TRY(decoder_, start_decoder(info_.path));
  next_row_ = 0;
  return {};
}

Result<void> PngSource::read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) {
  GRAVURE_CHECK(check_rows(info_, first_row, row_count, out.size()));
  errno = 0;
  const auto bytes = static_cast<std::size_t>(row_bytes(info_.samples, info_.width));
  skipped_.resize(bytes);
  try {
    if (row_count > 0 && (decoder_ == nullptr || next_row_ > first_row)) {
      GRAVURE_CHECK(begin());
    }
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::io, place_of(info_) + "out of memory while reading: lower --memory or --threads"};
  }
  for (; next_row_ < first_row + row_count; ++next_row_) {
    const bool wanted = next_row_ >= first_row;
    if (!decoder_->row(wanted ? out.data() + static_cast<std::size_t>(next_row_ - first_row) * bytes
                              : skipped_.data())) {
      const std::string reason = decoder_->reason();
      decoder_.reset();
      return damaged_rows(info_, next_row_, 1, reason);
    }
  }
  return {};
}

}  // namespace gravure::oiio
