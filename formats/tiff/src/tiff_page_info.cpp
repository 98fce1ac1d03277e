#include "tiff_page_info.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>

#include "gravure/core/file_output.hpp"

namespace gravure {
namespace {

template <class T>
std::optional<T> field(const TiffHandle& handle, std::uint32_t tag) {
  T value{};
  if (TIFFGetField(handle.get(), tag, &value) != 1) {
    return std::nullopt;
  }
  return value;
}

template <class T>
T field_or_default(const TiffHandle& handle, std::uint32_t tag) {
  T value{};
  TIFFGetFieldDefaulted(handle.get(), tag, &value);
  return value;
}

Error refused(const std::string& place, const std::string& what) {
  return {ErrorCode::bad_file, place + what};
}

Result<void> read_size(const TiffHandle& handle, const std::string& place, TiffPageInfo& info) {
  info.width = field<std::uint32_t>(handle, TIFFTAG_IMAGEWIDTH).value_or(0);
  info.height = field<std::uint32_t>(handle, TIFFTAG_IMAGELENGTH).value_or(0);
  info.bits_per_sample = field_or_default<std::uint16_t>(handle, TIFFTAG_BITSPERSAMPLE);
  info.samples_per_pixel = field_or_default<std::uint16_t>(handle, TIFFTAG_SAMPLESPERPIXEL);
  const std::string size = std::to_string(info.width) + " x " + std::to_string(info.height) + " pixels";
  if (info.width < 1 || info.height < 1 || info.height > kMaxTiffHeight) {
    return refused(place, "is " + size + ": both must be 1 or more and the height at most 2147483647");
  }
  if (info.bits_per_sample < 1 || info.bits_per_sample > 64 || info.samples_per_pixel < 1) {
    return refused(place, std::to_string(info.samples_per_pixel) + " samples of " +
                              std::to_string(info.bits_per_sample) + " bits a pixel: the file is damaged");
  }
  // At most 2^32 * 64 * 2^16 = 2^54 bits.
  if (info.width * info.bits_per_sample * info.samples_per_pixel > kMaxTiffRowBytes * 8) {
    return refused(place, "is " + size + ": a row is larger than the " + std::to_string(kMaxTiffRowBytes) +
                              " bytes allowed; cut the picture into bands");
  }
  return {};
}

Result<void> read_layout(const TiffHandle& handle, const std::string& place, TiffPageInfo& info) {
  info.tiled = TIFFIsTiled(handle.get()) != 0;
  const std::int64_t rows = info.tiled ? field<std::uint32_t>(handle, TIFFTAG_TILELENGTH).value_or(0)
                                       : field_or_default<std::uint32_t>(handle, TIFFTAG_ROWSPERSTRIP);
  if (rows < 1) {
    return refused(place, "strips or tiles of 0 rows: the file is damaged");
  }
  info.rows_per_block = info.tiled ? rows : std::min(rows, info.height);
  const auto compression = field_or_default<std::uint16_t>(handle, TIFFTAG_COMPRESSION);
  if (TIFFIsCODECConfigured(compression) != 1) {
    return refused(
        place, "compression " + std::to_string(compression) + " is not known here; rewrite it with `tiffcp -c zip`");
  }
  info.compression = compression;
  info.lowest_bit_first = field_or_default<std::uint16_t>(handle, TIFFTAG_FILLORDER) == FILLORDER_LSB2MSB;
  return {};
}

const char* photometric_name(std::uint64_t photometric) {
  switch (photometric) {
    case PHOTOMETRIC_RGB:
      return "colour";
    case PHOTOMETRIC_MASK:
      return "transparency mask";
    case PHOTOMETRIC_SEPARATED:
      return "amount of ink";
    case PHOTOMETRIC_YCBCR:
    case PHOTOMETRIC_CIELAB:
    case PHOTOMETRIC_ICCLAB:
    case PHOTOMETRIC_ITULAB:
      return "brightness and colour";
    case PHOTOMETRIC_CFA:
      return "colour filter of a camera";
    default:
      return "not known here";
  }
}

Result<void> read_meaning(const TiffHandle& handle, const std::string& place, TiffPageInfo& info) {
  const TiffRawTags raw = read_raw_tags(TIFFFileno(handle.get()), TIFFCurrentDirOffset(handle.get()));
  const std::uint64_t orientation =
      raw.orientation.value_or(field_or_default<std::uint16_t>(handle, TIFFTAG_ORIENTATION));
  if (orientation != ORIENTATION_TOPLEFT) {
    return refused(place, "orientation tag " + std::to_string(orientation) +
                              ": only 1 (first row on top, first pixel left) is read, since turning a picture silently "
                              "would cut it wrong; turn the pixels and save, or if they are right as they are stored "
                              "run `tiffset -s 274 1` on the file");
  }
  const auto photometric = field<std::uint16_t>(handle, TIFFTAG_PHOTOMETRIC);
  if (!photometric) {
    return refused(place,
                   "has no polarity (PhotometricInterpretation tag): run `tiffset -s 262 1` on the file if 0 is "
                   "black, `-s 262 0` if 0 is white");
  }
  info.zero_is_white = *photometric == PHOTOMETRIC_MINISWHITE;
  const std::uint64_t meaning = raw.photometric.value_or(*photometric);
  info.palette = meaning == PHOTOMETRIC_PALETTE;
  if (info.samples_per_pixel == 1 && meaning > PHOTOMETRIC_MINISBLACK && !info.palette) {
    return refused(place, "PhotometricInterpretation " + std::to_string(meaning) + " (" + photometric_name(meaning) +
                              "): only 0 (0 is white) and 1 (0 is black) say what one sample a pixel means; save it as "
                              "greyscale or 1 bit, or if it is that run `tiffset -s 262 1` on the file");
  }
  return {};
}

std::optional<double> dots_per_mm(const TiffHandle& handle, std::uint32_t tag) {
  const auto dots = field<float>(handle, tag);
  const auto unit = field_or_default<std::uint16_t>(handle, TIFFTAG_RESOLUTIONUNIT);
  if (!dots || !std::isfinite(*dots) || *dots <= 0 || (unit != RESUNIT_INCH && unit != RESUNIT_CENTIMETER)) {
    return std::nullopt;
  }
  return static_cast<double>(*dots) / (unit == RESUNIT_INCH ? 25.4 : 10.0);
}

/// The bytes that the rows of an uncompressed strip or tile of one sample take.
std::int64_t raw_block_bytes(const TiffHandle& handle, const TiffPageInfo& info, std::int64_t block) {
  if (info.tiled) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
    return static_cast<std::int64_t>(std::min(kMost, TIFFTileSize64(handle.get())));
  }
  const std::int64_t rows = std::min(info.rows_per_block, info.height - block * info.rows_per_block);
  return rows * ((info.width * info.bits_per_sample + 7) / 8);
}

/// Every strip or tile has bytes, and they lie inside the file: found here, truncation costs no half-done job.
Result<void> check_blocks(const TiffHandle& handle, const std::string& place, TiffPageInfo& info,
                          std::uint64_t file_bytes) {
  const std::uint32_t blocks = info.tiled ? TIFFNumberOfTiles(handle.get()) : TIFFNumberOfStrips(handle.get());
  const std::string name = info.tiled ? "tile " : "strip ";
  if (blocks == 0 || blocks > file_bytes) {
    return refused(place, "claims " + std::to_string(blocks) + " strips or tiles in " + std::to_string(file_bytes) +
                              " bytes: the file is damaged");
  }
  for (std::uint32_t block = 0; block < blocks; ++block) {
    int failed = 0;
    const std::uint64_t offset = TIFFGetStrileOffsetWithErr(handle.get(), block, &failed);
    const std::uint64_t bytes = failed != 0 ? 0 : TIFFGetStrileByteCountWithErr(handle.get(), block, &failed);
    const auto which = [&] { return name + std::to_string(block) + " of " + std::to_string(blocks); };
    if (failed != 0 || offset == 0 || bytes == 0) {
      return refused(place,
                     which() + " has no data: the file is damaged or was never finished" + handle.messages().text());
    }
    if (offset > file_bytes || bytes > file_bytes - offset) {
      return refused(place, which() + " (bytes " + std::to_string(offset) + " + " + std::to_string(bytes) +
                                ") ends beyond the file's " + std::to_string(file_bytes) +
                                " bytes: the file is truncated; copy it again");
    }
    const auto stored = static_cast<std::int64_t>(bytes);  // at most the length of the file
    const bool countable = !info.compressed() && info.samples_per_pixel == 1;
    const std::int64_t raw = countable ? raw_block_bytes(handle, info, block) : 0;
    if (stored < raw) {
      return refused(place, which() + " has " + std::to_string(stored) + " bytes, its rows take " +
                                std::to_string(raw) + ": the file is damaged; export it again");
    }
    info.largest_block_bytes = std::max(info.largest_block_bytes, stored);
    info.all_block_bytes += stored;
  }
  // libtiff puts a guess in the place of a length it does not believe; a guess that left the file was refused above.
  if (handle.messages().sizes_wrong || (handle.messages().sizes_missing && info.compressed())) {
    return refused(place, name + "0 of " + std::to_string(blocks) + ": its length (the " +
                              (info.tiled ? "TileByteCounts" : "StripByteCounts") + " tag) is " +
                              (handle.messages().sizes_wrong ? "not what its rows take" : "missing") +
                              ": the file is damaged; export it again");
  }
  info.blocks = blocks;
  return {};
}

/// What a codec of libtiff keeps for itself; measured with a counting allocator, and rounded up.
std::int64_t codec_state_bytes(const TiffPageInfo& info) {
  constexpr std::int64_t kKiB = 1024;
  switch (info.compression) {
    case COMPRESSION_NONE:
    case COMPRESSION_PACKBITS:
      return 0;
    case COMPRESSION_LZW:
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_DEFLATE:
      return 256 * kKiB;
    case COMPRESSION_CCITTRLE:
    case COMPRESSION_CCITTRLEW:
    case COMPRESSION_CCITTFAX3:
    case COMPRESSION_CCITTFAX4:
      return 64 * kKiB + 16 * info.width;  // where the runs of two rows begin, two numbers of 4 bytes a pixel each
    case COMPRESSION_ZSTD:
      return 9 * kKiB * kKiB;  // the window of all levels up to 19
    default:
      return 65 * kKiB * kKiB;  // the dictionary of LZMA's highest level
  }
}

}  // namespace

std::int64_t TiffPageInfo::codec_bytes() const {
  constexpr std::int64_t kHandle = std::int64_t{64} << 10;
  const std::int64_t stored = compressed() || tiled ? largest_block_bytes : 0;
  return kHandle + 32 * blocks + stored + codec_state_bytes(*this);
}

std::string tiff_place(const std::string& path, std::int64_t page) {
  return path + ": page " + std::to_string(page) + ": ";
}

Result<TiffHandle> open_tiff_page(const std::string& path, std::int64_t page, const TiffPageList& pages) {
  const auto count = static_cast<std::int64_t>(pages.offsets.size());
  if (page < 0 || page >= count) {
    return Error{ErrorCode::out_of_range,
                 tiff_place(path, page) + "the file has pages 0 to " + std::to_string(count - 1)};
  }
  // h: the first directory is read only if it is the wanted one; c: strips stay as the file has them
  errno = 0;
  TiffHandle handle(path, "rmhc");
  if (!handle || TIFFSetSubDirectory(handle.get(), pages.offsets[static_cast<std::size_t>(page)]) != 1) {
    if (const int reason = errno; is_device_failure(reason)) {
      return read_error(path + ": page " + std::to_string(page) + ": its directory", reason);
    }
    return refused(tiff_place(path, page),
                   "its directory cannot be read: the file is damaged" + handle.messages().text());
  }
  return handle;
}

Result<TiffPageInfo> inspect_tiff_page(const TiffHandle& handle, const std::string& path, std::int64_t page,
                                       std::uint64_t file_bytes) {
  const std::string place = tiff_place(path, page);
  TiffPageInfo info;
  GRAVURE_CHECK(read_size(handle, place, info));
  GRAVURE_CHECK(read_layout(handle, place, info));
  GRAVURE_CHECK(read_meaning(handle, place, info));
  GRAVURE_CHECK(check_blocks(handle, place, info, file_bytes));
  info.x_dots_per_mm = dots_per_mm(handle, TIFFTAG_XRESOLUTION);
  info.y_dots_per_mm = dots_per_mm(handle, TIFFTAG_YRESOLUTION);
  return info;
}

}  // namespace gravure
