#include <array>
#include <optional>

#include "header_facts.hpp"

namespace gravure::oiio {
namespace {

constexpr std::int64_t kMaxHeaderBytes = std::int64_t{1} << 20;
constexpr std::uint32_t kMultiPart = 0x1000;
constexpr std::uint32_t kDeep = 0x800;
constexpr std::int64_t kMaxRowsPerChunk = 256;  // DWAB
constexpr std::uint32_t kPixelTypes = 3;        // 32-bit unsigned, half, float

/// OpenEXR reads these by their type, not by the size that the file gives: with another size it would take the bytes
/// that follow for attributes, and allocate what they seem to say. (Layout: the file layout chapter of OpenEXR 3.1.)
struct FixedSize {
  std::string_view type;
  std::size_t bytes;
};
constexpr std::array kFixedSizes = {
    FixedSize{"box2f", 16},      FixedSize{"box2i", 16},    FixedSize{"chromaticities", 32},
    FixedSize{"compression", 1}, FixedSize{"double", 8},    FixedSize{"deepImageState", 1},
    FixedSize{"envmap", 1},      FixedSize{"float", 4},     FixedSize{"int", 4},
    FixedSize{"keycode", 28},    FixedSize{"lineOrder", 1}, FixedSize{"m33d", 72},
    FixedSize{"m33f", 36},       FixedSize{"m44d", 128},    FixedSize{"m44f", 64},
    FixedSize{"rational", 8},    FixedSize{"tiledesc", 9},  FixedSize{"timecode", 8},
    FixedSize{"v2d", 16},        FixedSize{"v2f", 8},       FixedSize{"v2i", 8},
    FixedSize{"v3d", 24},        FixedSize{"v3f", 12},      FixedSize{"v3i", 12},
};

/// Texts, each after its length.
bool fits_string_vector(std::string_view value) {
  std::size_t at = 0;
  while (at + 4 <= value.size()) {
    const std::size_t length = little_endian(value, at, 4);
    if (length > value.size() - at - 4) {
      return false;
    }
    at += 4 + length;
  }
  return at == value.size();
}

/// Width, height, four bytes a pixel.
bool fits_preview(std::string_view value) {
  const std::uint64_t width = little_endian(value, 0, 4);
  const std::uint64_t height = little_endian(value, 4, 4);
  return value.size() >= 8 && width <= value.size() && height <= value.size() && value.size() == 8 + 4 * width * height;
}

/// Does the size of an attribute agree with what its type makes OpenEXR read?
bool size_fits(std::string_view type, std::string_view value) {
  for (const FixedSize& fixed : kFixedSizes) {
    if (type == fixed.type) {
      return value.size() == fixed.bytes;
    }
  }
  return type == "stringvector"  ? fits_string_vector(value)
         : type == "preview"     ? fits_preview(value)
         : type == "floatvector" ? value.size() % 4 == 0
                                 : true;
}

/// What of one part's header decides how much memory reading it takes, and what OpenImageIO would abort on.
struct Part {
  std::optional<std::string> channels;
  std::optional<std::string> data_window;
  std::optional<std::string> tiles;
};

/// Walks the attributes of one part: name, type, size, value, until an empty name. Nothing when the bytes run out
/// or a size does not fit.
std::optional<Part> read_part(std::string_view bytes, std::size_t& at) {
  Part part;
  while (at < bytes.size()) {
    const std::size_t name_end = bytes.find('\0', at);
    if (name_end == at) {
      ++at;
      return part;
    }
    const std::size_t type_end = name_end == std::string_view::npos ? name_end : bytes.find('\0', name_end + 1);
    if (type_end == std::string_view::npos || bytes.size() - type_end < 5) {
      return std::nullopt;
    }
    const std::string_view name = bytes.substr(at, name_end - at);
    const std::string_view type = bytes.substr(name_end + 1, type_end - name_end - 1);
    const std::size_t value = type_end + 5;
    const std::size_t size = little_endian(bytes, type_end + 1, 4);
    if (size > bytes.size() - value || !size_fits(type, bytes.substr(value, size)) ||
        (name == "channels") != (type == "chlist")) {  // one list, check_channel_list() follows it
      return std::nullopt;
    }
    if (name == "channels") {
      part.channels = bytes.substr(value, size);
    } else if (name == "dataWindow" && size == 16) {
      part.data_window = bytes.substr(value, size);
    } else if (name == "tiles" && size == 9) {
      part.tiles = bytes.substr(value, size);
    }
    at = value + size;
  }
  return std::nullopt;
}

std::int64_t signed_at(const std::string& bytes, std::size_t at) {
  return static_cast<std::int32_t>(little_endian(bytes, at, 4));
}

/// A list of channels: name, pixel type, four bytes of no matter here, sampling in x and y; an empty name ends it.
Result<void> check_channel_list(const std::string& place, const std::string& list) {
  constexpr std::size_t kAfterName = 16;
  std::size_t at = 0;
  for (int number = 0;; ++number) {
    const std::size_t name_end = list.find('\0', at);
    if (name_end == at) {
      return number > 0 && at + 1 == list.size()
                 ? Result<void>{}
                 : bad_file(place, "its list of channels is empty or has more than ends it: the file is damaged");
    }
    if (name_end == std::string::npos || list.size() - name_end - 1 < kAfterName) {
      return bad_file(place, "its list of channels does not end: the file is damaged");
    }
    const std::string channel = "channel " + std::to_string(number);
    if (const std::uint32_t type = little_endian(list, name_end + 1, 4); type >= kPixelTypes) {
      return bad_file(place, channel + " is of the unknown pixel type " + std::to_string(type) +
                                 " (0, 1 and 2 are defined): the file is damaged or of a newer kind");
    }
    if (signed_at(list, name_end + 9) != 1 || signed_at(list, name_end + 13) != 1) {
      return bad_file(place, channel + " has fewer samples than pixels; save it with a sample for each");
    }
    at = name_end + 1 + kAfterName;
  }
}

Result<void> check_part(const HeaderFile& file, const Part& part, std::size_t number) {
  const std::string place = file.path() + ": page " + std::to_string(number);
  if (!part.channels) {
    return bad_file(place, "has no list of channels: the file is damaged");
  }
  GRAVURE_CHECK(check_channel_list(place, *part.channels));
  if (!part.data_window) {
    return bad_file(place, "has no data window: the file is damaged");
  }
  const std::int64_t width = signed_at(*part.data_window, 8) - signed_at(*part.data_window, 0) + 1;
  const std::int64_t height = signed_at(*part.data_window, 12) - signed_at(*part.data_window, 4) + 1;
  GRAVURE_CHECK(check_size(place, width, height, 32));
  if (width > kMaxExrWidth) {
    return bad_file(place, std::to_string(width) + " pixels wide: OpenEXR is read up to " +
                               std::to_string(kMaxExrWidth) + "; cut the picture into bands or save it as TIFF");
  }
  std::int64_t chunks = (height - 1) / kMaxRowsPerChunk + 1;
  if (part.tiles) {
    const std::int64_t tile_width = little_endian(*part.tiles, 0, 4);
    const std::int64_t tile_height = little_endian(*part.tiles, 4, 4);
    if (tile_width < 1 || tile_height < 1 || tile_width > kMaxExrWidth ||
        tile_height > kMaxBlockBytes / 4 / std::max(width, tile_width)) {
      return bad_file(place, "tiles of " + std::to_string(tile_width) + " x " + std::to_string(tile_height) +
                                 " pixels: a row of tiles must fit into " + std::to_string(kMaxBlockBytes) +
                                 " bytes; save it in scan lines");
    }
    chunks = ((width - 1) / tile_width + 1) * ((height - 1) / tile_height + 1);
  }
  if (chunks > file.size() / 8) {  // the table of chunk offsets alone
    return bad_file(place, "declares " + std::to_string(width) + " x " + std::to_string(height) +
                               " pixels, which its " + std::to_string(file.size()) +
                               " bytes cannot hold: the file is truncated or damaged; copy it again");
  }
  return {};
}

}  // namespace

Result<void> check_exr_header(const std::string& path) {
  HeaderFile file(path);
  const std::string bytes = file.bytes(0, kMaxHeaderBytes);
  const std::uint32_t version = little_endian(bytes, 4, 4);
  if ((version & kDeep) != 0) {
    return bad_file(path, "is a deep OpenEXR image: many samples a pixel are no depth map; flatten it");
  }
  std::size_t at = 8;
  for (std::size_t number = 0;; ++number) {
    const auto part = read_part(bytes, at);
    if (!part) {
      return bad_file(path,
                      "its OpenEXR header does not end or has sizes that do not fit: the file is truncated or damaged; "
                      "copy it again");
    }
    GRAVURE_CHECK(check_part(file, *part, number));
    // A multi-part header ends with one more empty name.
    if ((version & kMultiPart) == 0 || (at < bytes.size() && bytes[at] == '\0')) {
      return {};
    }
  }
}

}  // namespace gravure::oiio
