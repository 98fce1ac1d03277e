#include "gravure/formats/png_writer.hpp"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <vector>

namespace gravure {
namespace {

using Reason = std::array<char, 200>;

Result<void> check_size(const PngPicture& picture) {
  if (picture.width < 1 || picture.width > kMostPngSide || picture.height < 1 || picture.height > kMostPngSide) {
    return Error{ErrorCode::out_of_range, "PNG of " + std::to_string(picture.width) + " x " +
                                              std::to_string(picture.height) + " pixels: each side is 1 to " +
                                              std::to_string(kMostPngSide)};
  }
  return {};
}

/// libpng would print the message if this returned.
[[noreturn]] void keep_reason(png_structp png, png_const_charp message) {
  Reason& reason = *static_cast<Reason*>(png_get_error_ptr(png));
  std::snprintf(reason.data(), reason.size(), "%s", message);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

/// No exception may pass through libpng.
bool kept(const PngBytes& bytes, std::span<const std::byte> piece) noexcept {
  try {
    return bytes(piece);
  } catch (...) {
    return false;
  }
}

void put_bytes(png_structp png, png_bytep data, std::size_t size) {
  const PngBytes& bytes = *static_cast<const PngBytes*>(png_get_io_ptr(png));
  if (!kept(bytes, {reinterpret_cast<const std::byte*>(data), size})) {
    png_error(png, "cannot be written");
  }
}

void flush_nothing(png_structp) {}

// libpng leaves a call that fails by longjmp(): nothing with a destructor may live in the three functions below.

/// As png_image_write_to_memory() begins.
bool write_start(png_structp png, png_infop info, const PngPicture& picture) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8,
               picture.samples == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  return true;
}

bool write_row(png_structp png, const std::byte* row) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  png_write_row(png, reinterpret_cast<png_const_bytep>(row));
  return true;
}

bool write_end(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  png_write_end(png, info);
  return true;
}

class PngEncoder {
 public:
  explicit PngEncoder(const PngBytes& bytes)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &reason_, keep_reason, ignore_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
    png_set_write_fn(png_, const_cast<PngBytes*>(&bytes), put_bytes, flush_nothing);
  }
  ~PngEncoder() { png_destroy_write_struct(&png_, &info_); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  Result<void> start(const PngPicture& picture) { return told(write_start(png_, info_, picture)); }
  Result<void> row(const std::byte* row) { return told(write_row(png_, row)); }
  Result<void> end() { return told(write_end(png_, info_)); }

 private:
  Result<void> told(bool good) const {
    return good ? Result<void>() : Error{ErrorCode::io, std::string("PNG: ") + reason_.data()};
  }

  Reason reason_ = {};
  png_structp png_;
  png_infop info_;
};

}  // namespace

Result<std::string> encode_png(const PngPicture& picture) {
  GRAVURE_CHECK(check_size(picture));
  const std::int64_t samples = picture.width * picture.height * picture.samples;
  if ((picture.samples != 1 && picture.samples != 3) || picture.pixels.size() != static_cast<std::size_t>(samples)) {
    return Error{ErrorCode::bad_argument,
                 "PNG: " + std::to_string(picture.pixels.size()) + " bytes, " + std::to_string(samples) + " samples"};
  }
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = picture.samples == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  std::string file(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t bytes = file.size();
  const int written = png_image_write_to_memory(&image, file.data(), &bytes, 0, picture.pixels.data(), 0, nullptr);
  const std::string reason = image.message;
  png_image_free(&image);
  if (written == 0) {
    return Error{ErrorCode::io, "PNG: " + reason};
  }
  file.resize(bytes);
  return file;
}

Result<void> write_png(const PngPicture& picture, const PngRows& rows, const PngBytes& bytes) {
  GRAVURE_CHECK(check_size(picture));
  if (picture.samples != 1 && picture.samples != 3) {
    return Error{ErrorCode::bad_argument, "PNG: " + std::to_string(picture.samples) + " samples a pixel: 1 or 3"};
  }
  PngEncoder encoder(bytes);
  GRAVURE_CHECK(encoder.start(picture));
  std::vector<std::byte> row(static_cast<std::size_t>(picture.width * picture.samples));
  for (std::int64_t y = 0; y < picture.height; ++y) {
    GRAVURE_CHECK(rows(y, row));
    GRAVURE_CHECK(encoder.row(row.data()));
  }
  return encoder.end();
}

}  // namespace gravure
