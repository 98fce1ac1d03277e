#include "gravure/formats/image_kind.hpp"
#include "gravure/core/file_output.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

namespace gravure {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view bytes;
  ImageKind kind;
};

constexpr Signature kSignatures[] = {
    {"II\x2a\0"sv, ImageKind::tiff},
    {"MM\0\x2a"sv, ImageKind::tiff},
    {"II\x2b\0"sv, ImageKind::tiff},
    {"MM\0\x2b"sv, ImageKind::tiff},
    {"\x89PNG\r\n\x1a\n"sv, ImageKind::png},
    {"BM"sv, ImageKind::bmp},
    {"\x76\x2f\x31\x01"sv, ImageKind::openexr},
};

bool is_pnm(std::string_view head) {
  return head.size() >= 3 && head[0] == 'P' && head[1] >= '1' && head[1] <= '6' &&
         std::strchr(" \t\r\n#", head[2]) != nullptr && head[2] != '\0';
}

}  // namespace

const char* image_kind_name(ImageKind kind) noexcept {
  switch (kind) {
    case ImageKind::tiff:
      return "TIFF";
    case ImageKind::png:
      return "PNG";
    case ImageKind::bmp:
      return "BMP";
    case ImageKind::openexr:
      return "OpenEXR";
    case ImageKind::pnm:
      return "PBM/PGM";
  }
  return "unknown";
}

Result<ImageKind> image_kind(const std::string& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) {
    return open_error(path, errno);
  }
  if (!S_ISREG(status.st_mode)) {
    return Error{ErrorCode::bad_file,
                 path + (S_ISDIR(status.st_mode) ? ": is a folder" : ": is no regular file") + ", not an image"};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return open_error(path, errno);
  }
  char bytes[8] = {};
  file.read(bytes, sizeof bytes);
  if (const int reason = errno; file.bad()) {
    return read_error(path, reason);
  }
  const std::string_view head(bytes, static_cast<std::size_t>(file.gcount()));
  for (const Signature& signature : kSignatures) {
    if (head.substr(0, signature.bytes.size()) == signature.bytes) {
      return signature.kind;
    }
  }
  if (is_pnm(head)) {
    return ImageKind::pnm;
  }
  return Error{ErrorCode::bad_file, path + (head.empty() ? ": is empty" : ": is of no kind read here") +
                                        ": images are TIFF, PNG, BMP, OpenEXR, PBM or PGM; convert it"};
}

}  // namespace gravure
