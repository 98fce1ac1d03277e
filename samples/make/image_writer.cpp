#include "image_writer.hpp"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/tiff_writer.hpp"

namespace gravure::samples {
namespace {

constexpr int kTile = 64;

OIIO::TypeDesc stored_type(Samples samples) {
  switch (samples) {
    case Samples::u16:
      return OIIO::TypeUInt16;
    case Samples::half:
      return OIIO::TypeHalf;
    case Samples::f32:
      return OIIO::TypeFloat;
    case Samples::bit:
    case Samples::u8:
      break;
  }
  return OIIO::TypeUInt8;
}

OIIO::ImageSpec make_spec(std::int64_t width, std::int64_t height, const FileOptions& options) {
  OIIO::ImageSpec spec(static_cast<int>(width), static_cast<int>(height), 1, stored_type(options.samples));
  spec.channelnames = {"Y"};
  spec.attribute("compression", options.compression);
  spec.attribute("DateTime", "2000:01:01 00:00:00");  // else the present moment is written
  if (options.samples == Samples::bit) {
    spec.attribute("oiio:BitsPerSample", 1);
  }
  if (options.tiled) {
    spec.tile_width = kTile;
    spec.tile_height = kTile;
  } else {
    spec.attribute("tiff:RowsPerStrip", options.rows_per_strip);
  }
  if (options.big_tiff) {
    spec.attribute("tiff:bigtiff", 1);
  }
  if (options.x_dots_per_mm > 0) {
    spec.attribute("XResolution", static_cast<float>(options.x_dots_per_mm * 10));
    spec.attribute("YResolution", static_cast<float>(options.y_dots_per_mm * 10));
    spec.attribute("ResolutionUnit", "cm");
    // The TIFF writer takes the vertical resolution from this.
    spec.attribute("PixelAspectRatio", static_cast<float>(options.y_dots_per_mm / options.x_dots_per_mm));
  }
  return spec;
}

/// kTile rows of levels as what the writer is fed with: bytes, words, or floats from 0 to 1. As wide as whole tiles:
/// what lies beyond the picture in the last ones is written as 0, where OpenImageIO would write what memory held.
class Band {
 public:
  Band(std::int64_t width, Samples samples)
      : type_(samples == Samples::half || samples == Samples::f32 ? OIIO::TypeDesc(OIIO::TypeFloat)
                                                                  : stored_type(samples)),
        samples_(samples),
        row_bytes_((width + kTile - 1) / kTile * kTile * static_cast<std::int64_t>(type_.size())),
        bytes_(static_cast<std::size_t>(row_bytes_ * kTile)) {}

  void put_row(std::int64_t row, const std::vector<std::uint16_t>& levels) {
    std::byte* out = bytes_.data() + row * row_bytes_;
    for (const std::uint16_t level : levels) {
      if (type_ == OIIO::TypeUInt16) {
        std::memcpy(out, &level, 2);
      } else if (type_ == OIIO::TypeFloat) {
        const float share = static_cast<float>(level) / 65535.0F;
        std::memcpy(out, &share, 4);
      } else {
        *out = static_cast<std::byte>(samples_ == Samples::u8 ? level / 257 : level >= 32768 ? 255 : 0);
      }
      out += type_.size();
    }
  }

  const std::byte* pixel(std::int64_t x) const { return bytes_.data() + x * static_cast<std::int64_t>(type_.size()); }
  OIIO::TypeDesc type() const { return type_; }
  std::int64_t row_bytes() const { return row_bytes_; }

 private:
  OIIO::TypeDesc type_;
  Samples samples_;
  std::int64_t row_bytes_;
  std::vector<std::byte> bytes_;
};

bool write_band(OIIO::ImageOutput& output, const Band& band, std::int64_t width, std::int64_t first, std::int64_t rows,
                bool tiled) {
  const auto y = static_cast<int>(first);
  if (!tiled) {
    return output.write_scanlines(y, static_cast<int>(first + rows), 0, band.type(), band.pixel(0), OIIO::AutoStride,
                                  band.row_bytes());
  }
  bool done = true;
  for (std::int64_t x = 0; x < width && done; x += kTile) {
    done = output.write_tile(static_cast<int>(x), y, 0, band.type(), band.pixel(x), OIIO::AutoStride, band.row_bytes());
  }
  return done;
}

bool write_page(OIIO::ImageOutput& output, std::int64_t width, std::int64_t height, const RowSource& page,
                const FileOptions& options) {
  std::vector<std::uint16_t> levels(static_cast<std::size_t>(width));
  Band band(width, options.samples);
  for (std::int64_t first = 0; first < height; first += kTile) {
    const std::int64_t rows = std::min<std::int64_t>(kTile, height - first);
    if (rows < kTile) {
      band = Band(width, options.samples);  // rows beyond the picture are 0 too
    }
    for (std::int64_t row = 0; row < rows; ++row) {
      page(first + row, levels);
      band.put_row(row, levels);
    }
    if (!write_band(output, band, width, first, rows, options.tiled)) {
      return false;
    }
  }
  return true;
}

/// OpenImageIO 2.4 writes Deflate when it is asked for G4, so these go through libtiff: 0 is white, as fax has it.
Result<void> write_g4(const std::string& path, std::int64_t width, std::int64_t height,
                      const std::vector<RowSource>& pages, const FileOptions& options) {
  BilevelTiffPage page;
  page.width = width;
  page.height = height;
  page.zero_is_white = true;
  page.compression = TiffCompression::g4;
  if (options.x_dots_per_mm > 0) {
    page.x_dots_per_mm = options.x_dots_per_mm;
    page.y_dots_per_mm = options.y_dots_per_mm;
  }
  GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(path, page));
  std::vector<std::uint16_t> levels(static_cast<std::size_t>(width));
  for (std::size_t number = 0; number < pages.size(); ++number) {
    if (number > 0) {
      GRAVURE_CHECK(writer.begin_page(page));
    }
    for (std::int64_t y = 0; y < height; ++y) {
      pages[number](y, levels);
      std::vector<std::byte> row(static_cast<std::size_t>((width + 7) / 8));
      for (std::size_t x = 0; x < levels.size(); ++x) {
        row[x / 8] |= static_cast<std::byte>(levels[x] < 32768 ? 0x80U >> (x % 8) : 0U);
      }
      GRAVURE_CHECK(writer.append_rows(row));
    }
  }
  return writer.commit();
}

}  // namespace

Result<void> write_image(const std::string& path, std::int64_t width, std::int64_t height,
                         const std::vector<RowSource>& pages, const FileOptions& options) {
  if (options.compression == "ccittfax4") {
    return write_g4(path, width, height, pages, options);
  }
  GRAVURE_TRY(FileOutput file, FileOutput::create(path));
  const auto output = OIIO::ImageOutput::create(options.format);
  const auto failed = [&](const std::string& reason) {
    return Error{ErrorCode::io, path + ": cannot write: " + reason};
  };
  if (output == nullptr) {
    return failed(OIIO::geterror());
  }
  const OIIO::ImageSpec spec = make_spec(width, height, options);
  const std::vector<OIIO::ImageSpec> specs(pages.size(), spec);
  const bool opened = pages.size() == 1
                          ? output->open(file.temporary_path(), spec)
                          : output->open(file.temporary_path(), static_cast<int>(specs.size()), specs.data());
  if (!opened) {
    return failed(output->geterror());
  }
  for (std::size_t page = 0; page < pages.size(); ++page) {
    if (page > 0 && !output->open(file.temporary_path(), spec, OIIO::ImageOutput::AppendSubimage)) {
      return failed(output->geterror());
    }
    if (!write_page(*output, width, height, pages[page], options)) {
      return failed(output->geterror());
    }
  }
  if (!output->close()) {
    return failed(output->geterror());
  }
  return file.commit();
}

}  // namespace gravure::samples
