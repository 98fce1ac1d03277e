#include "oiio_opener.hpp"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <utility>

#include "gravure/formats/image_kind.hpp"
#include "header_facts.hpp"
#include "oiio_source.hpp"
#include "png_source.hpp"

namespace gravure::oiio {
namespace {

const char* oiio_format(ImageKind kind) {
  switch (kind) {
    case ImageKind::tiff:
      return "tiff";
    case ImageKind::png:
      return "png";
    case ImageKind::bmp:
      return "bmp";
    case ImageKind::openexr:
      return "openexr";
    case ImageKind::pnm:
      break;
  }
  return "";
}

std::string place(const std::string& path, std::int64_t page) {
  return path + ": page " + std::to_string(page);
}

/// The kinds this module is for.
Result<ImageKind> imported_kind(const std::string& path) {
  GRAVURE_TRY(const ImageKind kind, image_kind(path));
  if (*oiio_format(kind) == '\0') {
    return bad_file(path, std::string(image_kind_name(kind)) + " is not read by the import module");
  }
  return kind;
}

/// The reader of exactly this kind; OpenImageIO's own search would try every format it knows on a damaged file.
Result<std::unique_ptr<OIIO::ImageInput>> open_input(const std::string& path, ImageKind kind) {
  auto input = OIIO::ImageInput::create(oiio_format(kind));
  if (input == nullptr) {
    return Error{ErrorCode::io, path + ": OpenImageIO has no reader for " + image_kind_name(kind) + ": " +
                                    OIIO::geterror() + "; install the Debian package libopenimageio2.4"};
  }
  input->threads(1);  // the caller has its own workers
  OIIO::ImageSpec spec;
  if (!input->open(path, spec)) {
    return bad_file(path, "cannot be opened: the file is damaged: " + input->geterror());
  }
  return input;
}

std::optional<double> dots_per_mm(const OIIO::ImageSpec& spec, const char* name) {
  const float dots = spec.get_float_attribute(name, 0.0F);
  const std::string unit(spec.get_string_attribute("ResolutionUnit"));
  const double unit_mm = unit == "in" || unit == "inch" ? 25.4 : unit == "cm" ? 10.0 : unit == "m" ? 1000.0 : 0.0;
  if (unit_mm == 0.0 || !(dots > 0.0F) || dots > std::numeric_limits<float>::max()) {
    return std::nullopt;
  }
  return static_cast<double>(dots) / unit_mm;
}

/// Rows that OpenEXR decodes at once.
std::int64_t exr_chunk_rows(const OIIO::ImageSpec& spec) {
  const std::string codec(spec.get_string_attribute("compression", "none"));
  return codec == "none" || codec == "rle" || codec == "zips" ? 1
         : codec == "zip" || codec == "pxr24"                 ? 16
         : codec == "piz" || codec.rfind("b44", 0) == 0       ? 32
                                                              : 256;
}

/// OpenEXR's facts come from OpenImageIO, once the header was found harmless; check_exr_header() saw every part.
HeaderFacts exr_facts(const OIIO::ImageSpec& spec) {
  HeaderFacts facts;
  facts.width = spec.width;
  facts.height = spec.height;
  facts.bits = static_cast<int>(spec.format.size()) * 8;
  facts.tiled = spec.tile_width > 0;
  facts.rows_per_block = facts.tiled ? spec.tile_height : exr_chunk_rows(spec);
  // A chunk as stored, as the codec turns it over, as decoded: four times, eight for the cosine codecs; a row of tiles
  // once more on its way to us.
  const std::int64_t width = facts.tiled ? std::int64_t{spec.tile_width} : facts.width;
  const std::int64_t chunk = facts.rows_per_block * width * 4 * (facts.rows_per_block == 256 ? 8 : 4);
  facts.decoder_bytes = kLibraryBytes + chunk + (facts.tiled ? facts.rows_per_block * facts.width * 4 : 0);
  return facts;
}

Result<HeaderFacts> read_facts(const BilevelTiffOpener& tiff, const std::string& path, std::int64_t page,
                               ImageKind kind) {
  switch (kind) {
    case ImageKind::tiff:
      return read_tiff_header(tiff, path, page);
    case ImageKind::png:
      return read_png_header(path);
    case ImageKind::bmp:
      return read_bmp_header(path);
    case ImageKind::openexr:
    case ImageKind::pnm:
      break;
  }
  GRAVURE_CHECK(check_exr_header(path));
  return HeaderFacts{};
}

Result<void> check_channels(const std::string& where, const OIIO::ImageSpec& spec, const HeaderFacts& facts) {
  if (spec.deep || spec.depth > 1) {
    return bad_file(where, "is a deep or volume image; flatten it");
  }
  if (spec.nchannels != (facts.three_channels ? 3 : 1)) {
    std::string names;
    for (const std::string& name : spec.channelnames) {
      names += (names.empty() ? "" : ", ") + name;
    }
    return not_one_channel(where, std::to_string(spec.nchannels) + " channels (" + names + ")");
  }
  if (spec.alpha_channel >= 0) {
    return not_one_channel(where, "its only channel is transparency (alpha)");
  }
  return {};
}

Result<SampleType> sample_type(const std::string& where, const OIIO::ImageSpec& spec, const HeaderFacts& facts) {
  if (facts.bits == 1) {
    return SampleType::bit;
  }
  if (spec.format == OIIO::TypeUInt8 && facts.bits == 8) {
    return SampleType::u8;
  }
  if (spec.format == OIIO::TypeUInt16 && facts.bits == 16) {
    return SampleType::u16;
  }
  if (spec.format == OIIO::TypeHalf || spec.format == OIIO::TypeFloat) {
    return SampleType::f32;
  }
  return bad_file(where, std::string("its samples are ") + spec.format.c_str() + " (" + std::to_string(facts.bits) +
                             " bits): 1, 8 and 16 bits without sign, half and float are read; save it so");
}

Result<void> check_geometry(const std::string& where, const OIIO::ImageSpec& spec, const HeaderFacts& facts) {
  if (spec.width != facts.width || spec.height != facts.height) {
    return bad_file(where, "OpenImageIO takes it for " + std::to_string(spec.width) + " x " +
                               std::to_string(spec.height) + " pixels, its header says " + std::to_string(facts.width) +
                               " x " + std::to_string(facts.height) + ": the file is damaged or of an unusual kind");
  }
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height) {
    return bad_file(where, "its data window (" + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                               ") is not its display window (" + std::to_string(spec.full_width) + " x " +
                               std::to_string(spec.full_height) + "): what lies between has no depth; crop or fill it");
  }
  if (const int orientation = spec.get_int_attribute("Orientation", 1); orientation != 1) {
    return bad_file(where, "orientation " + std::to_string(orientation) +
                               ": only 1 (first row on top, first pixel left) is read; turn the pixels and save");
  }
  return {};
}

}  // namespace

OiioOpener::OiioOpener() {
  // Sizes are checked against the file itself (header_facts.hpp); this limit would refuse honest large rollers.
  OIIO::attribute("limits:imagesize_MB", std::numeric_limits<int>::max());
  OIIO::attribute("threads", 1);       // a pool that cannot start ends the process (a limit on processes, a container)
  OIIO::attribute("exr_threads", -1);  // none of its own: the caller has workers, and each thread holds its own rows
}

Result<std::int64_t> OiioOpener::count_pages(const std::string& path) const {
  try {
    return count_unguarded(path);
  } catch (const std::exception& failure) {
    return bad_file(path, std::string("cannot be read: ") + failure.what());
  }
}

Result<std::int64_t> OiioOpener::count_unguarded(const std::string& path) const {
  GRAVURE_TRY(const ImageKind kind, imported_kind(path));
  if (kind == ImageKind::tiff) {
    return tiff_.count_pages(path);
  }
  if (kind != ImageKind::openexr) {
    return std::int64_t{1};
  }
  GRAVURE_CHECK(check_exr_header(path));
  GRAVURE_TRY(const auto input, open_input(path, kind));
  return std::int64_t{std::max(1, input->spec().get_int_attribute("oiio:subimages", 1))};
}

Result<std::unique_ptr<ImageSource>> OiioOpener::open(const std::string& path, std::int64_t page) const {
  try {
    return open_unguarded(path, page);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::io, place(path, page) + ": out of memory while opening: lower --memory or --threads"};
  } catch (const std::exception& failure) {
    return bad_file(place(path, page), std::string("cannot be read: ") + failure.what());
  }
}

Result<std::unique_ptr<ImageSource>> OiioOpener::open_unguarded(const std::string& path, std::int64_t page) const {
  GRAVURE_TRY(const ImageKind kind, imported_kind(path));
  GRAVURE_TRY(const std::int64_t pages, count_unguarded(path));
  if (page < 0 || page >= pages) {
    return Error{ErrorCode::out_of_range, place(path, page) + ": the file has pages 0 to " + std::to_string(pages - 1)};
  }
  GRAVURE_TRY(HeaderFacts facts, read_facts(tiff_, path, page, kind));
  if (kind == ImageKind::png) {
    GRAVURE_CHECK(check_png_start(path));  // before OpenImageIO lets libpng print it
  }
  GRAVURE_TRY(auto input, open_input(path, kind));
  const std::string where = place(path, page);
  if (!input->seek_subimage(static_cast<int>(page), 0)) {
    return bad_file(where, "cannot be reached: the file is damaged: " + input->geterror());
  }
  const OIIO::ImageSpec& spec = input->spec();
  if (kind == ImageKind::openexr) {
    facts = exr_facts(spec);
  }
  GRAVURE_CHECK(check_channels(where, spec, facts));
  GRAVURE_CHECK(check_geometry(where, spec, facts));
  GRAVURE_TRY(const SampleType samples, sample_type(where, spec, facts));
  ImageInfo info;
  info.path = path;
  info.page = page;
  info.width = facts.width;
  info.height = facts.height;
  info.samples = samples;
  info.rows_per_block = std::min(facts.rows_per_block, facts.height);
  info.random_access = facts.random_access;
  info.decoder_bytes = facts.decoder_bytes + (kind == ImageKind::png ? 0 : OiioSource::buffer_bytes(info, facts));
  info.x_dots_per_mm = facts.x_dots_per_mm ? facts.x_dots_per_mm : dots_per_mm(spec, "XResolution");
  info.y_dots_per_mm = facts.y_dots_per_mm ? facts.y_dots_per_mm : dots_per_mm(spec, "YResolution");
  if (kind == ImageKind::png) {
    return std::unique_ptr<ImageSource>(new PngSource(std::move(info)));
  }
  return std::unique_ptr<ImageSource>(new OiioSource(std::move(input), std::move(info), facts));
}

}  // namespace gravure::oiio
