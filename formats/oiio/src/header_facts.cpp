#include "header_facts.hpp"

namespace gravure::oiio {

HeaderFile::HeaderFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  file_.seekg(0, std::ios::end);
  size_ = file_ ? static_cast<std::int64_t>(file_.tellg()) : 0;
}

std::string HeaderFile::bytes(std::int64_t offset, std::int64_t count) {
  if (offset < 0 || offset >= size_ || count <= 0) {
    return {};
  }
  std::string read(static_cast<std::size_t>(std::min(count, size_ - offset)), '\0');
  file_.clear();
  file_.seekg(offset);
  file_.read(read.data(), static_cast<std::streamsize>(read.size()));
  read.resize(static_cast<std::size_t>(file_.gcount()));
  return read;
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) {
    value = value << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
  }
  return value;
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value = value << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
  }
  return value;
}

Error bad_file(const std::string& path, const std::string& what) {
  return {ErrorCode::bad_file, path + ": " + what};
}

Error not_one_channel(const std::string& path, const std::string& what) {
  return bad_file(path, what +
                            ": only one grey or 1-bit channel is read, since how colours become pulses would be "
                            "guessed; save it as greyscale or 1 bit without transparency");
}

Result<void> check_size(const std::string& path, std::int64_t width, std::int64_t height, int bits) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width < 1 || height < 1) {
    return bad_file(path, "is " + size + ": both must be 1 or more");
  }
  if (width > kMaxRowBytes * 8 / bits) {
    return bad_file(path, "is " + size + ": a row is larger than the " + std::to_string(kMaxRowBytes) +
                              " bytes allowed; cut the picture into bands");
  }
  return {};
}

namespace {

/// What OpenImageIO or libtiff copy beside the codec's own memory.
std::int64_t tiff_scratch_bytes(const TiffPageInfo& info, std::int64_t row_bytes) {
  const std::int64_t block = info.rows_per_block * row_bytes;
  if (info.tiled || block <= kMaxStripBytes) {
    return block + info.largest_block_bytes;
  }
  // Larger strips run row by row. libtiff holds a strip as it is stored; one that is not compressed it takes in pieces
  // if there is no other.
  return row_bytes + (info.compressed() || info.blocks == 1 ? 0 : info.largest_block_bytes);
}

}  // namespace

Result<HeaderFacts> read_tiff_header(const BilevelTiffOpener& tiff, const std::string& path, std::int64_t page) {
  GRAVURE_TRY(const TiffPageInfo info, tiff.read_page_info(path, page));
  const std::string place = path + ": page " + std::to_string(page);
  if (info.palette) {
    return not_one_channel(place, "has a palette");
  }
  if (info.samples_per_pixel != 1) {
    return not_one_channel(place, std::to_string(info.samples_per_pixel) + " channels (colour or transparency)");
  }
  if (info.bits_per_sample != 8 && info.bits_per_sample != 16 && info.bits_per_sample != 32) {
    return bad_file(place, std::to_string(info.bits_per_sample) +
                               " bits a sample: 8, 16 or 32-bit floating-point samples are imported; save it so");
  }
  if (info.zero_is_white && info.bits_per_sample != 8) {
    return bad_file(place, "0 is white (PhotometricInterpretation MinIsWhite) with " +
                               std::to_string(info.bits_per_sample) +
                               " bits a sample: only 8-bit samples are turned round reliably; save it with 0 as black");
  }
  HeaderFacts facts;
  facts.width = info.width;
  facts.height = info.height;
  facts.bits = info.bits_per_sample;
  facts.tiled = info.tiled;
  const std::int64_t row_bytes = (info.width * info.bits_per_sample + 7) / 8;
  if (info.tiled && info.rows_per_block > kMaxBlockBytes / row_bytes) {
    return bad_file(place, "one row of tiles is larger than the " + std::to_string(kMaxBlockBytes) +
                               " bytes allowed; rewrite it in strips with `tiffcp -s -r 64`");
  }
  const bool small = info.rows_per_block <= kMaxStripBytes / row_bytes && info.largest_block_bytes <= kMaxStripBytes;
  facts.rows_per_block = small || info.tiled ? info.rows_per_block : 1;
  facts.stored_in_strips = small && !info.tiled;
  facts.random_access = small || info.tiled || !info.compressed();
  facts.decoder_bytes = kLibraryBytes + info.codec_bytes() + tiff_scratch_bytes(info, row_bytes);
  facts.x_dots_per_mm = info.x_dots_per_mm;
  facts.y_dots_per_mm = info.y_dots_per_mm;
  return facts;
}

}  // namespace gravure::oiio
