#include "gravure/formats/png_writer.hpp"

#include <png.h>

namespace gravure {

Result<std::string> encode_png(const PngPicture& picture) {
  if (picture.width < 1 || picture.width > kMostPngSide || picture.height < 1 || picture.height > kMostPngSide) {
    return Error{ErrorCode::out_of_range, "PNG of " + std::to_string(picture.width) + " x " +
                                              std::to_string(picture.height) + " pixels: each side is 1 to " +
                                              std::to_string(kMostPngSide)};
  }
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

}  // namespace gravure
