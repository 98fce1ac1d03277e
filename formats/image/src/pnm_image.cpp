#include "pnm_image.hpp"

#include <array>
#include <cerrno>
#include <fstream>
#include <limits>
#include <optional>
#include <utility>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/tiff.hpp"

namespace gravure {
namespace {

constexpr std::int64_t kMaxSide = std::numeric_limits<std::int32_t>::max();

struct PnmHeader {
  char kind = '4';
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::int64_t maximum = 1;
  std::int64_t data_offset = 0;
};

bool is_space(int c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// The next number of the header, past white space and comments; nothing where there is none up to kMaxSide. One
/// character behind it is taken as well.
std::optional<std::int64_t> take_number(std::istream& file) {
  int c = file.get();
  while (is_space(c) || c == '#') {
    if (c == '#') {
      while (c != '\n' && c != '\r' && c != EOF) {
        c = file.get();
      }
    }
    c = file.get();
  }
  std::optional<std::int64_t> value;
  for (; c >= '0' && c <= '9'; c = file.get()) {
    value = value.value_or(0) * 10 + (c - '0');
    if (*value > kMaxSide) {
      return std::nullopt;
    }
  }
  return is_space(c) ? value : std::nullopt;
}

Error bad_file(const std::string& path, const std::string& what) {
  return {ErrorCode::bad_file, path + ": " + what};
}

Result<PnmHeader> read_header(std::istream& file, const std::string& path) {
  PnmHeader header;
  file.get();
  header.kind = static_cast<char>(file.get());
  if (header.kind == '3' || header.kind == '6') {
    return bad_file(path, "is in colour (PPM): save it as PBM or PGM");
  }
  if (header.kind != '4' && header.kind != '5') {
    return bad_file(path, "is a plain text PBM or PGM: save it in the binary form (P4 or P5)");
  }
  const auto width = take_number(file);
  const auto height = width ? take_number(file) : std::nullopt;
  const auto maximum = header.kind == '4' ? std::optional<std::int64_t>(1) : height ? take_number(file) : std::nullopt;
  if (!width || !height || !maximum || *width < 1 || *height < 1) {
    return bad_file(path, "its header does not give a width and height of 1 to " + std::to_string(kMaxSide) +
                              ": the file is damaged");
  }
  if (header.kind == '5' && *maximum != 255 && *maximum != 65535) {
    return bad_file(path, "its largest sample is declared as " + std::to_string(*maximum) +
                              ": 255 and 65535 are read; save it so, rather than have it rescaled here");
  }
  header.width = *width;
  header.height = *height;
  header.maximum = *maximum;
  header.data_offset = static_cast<std::int64_t>(file.tellg());
  return header;
}

class PnmSource final : public ImageSource {
 public:
  PnmSource(std::ifstream file, ImageInfo info, std::int64_t data_offset)
      : file_(std::move(file)),
        info_(std::move(info)),
        data_offset_(data_offset),
        row_bytes_(row_bytes(info_.samples, info_.width)) {}

  const ImageInfo& info() const noexcept override { return info_; }

  Result<void> read_rows(std::int64_t first_row, std::int64_t row_count, std::span<std::byte> out) override {
    if (first_row < 0 || row_count < 0 || row_count > info_.height || first_row > info_.height - row_count) {
      return Error{ErrorCode::out_of_range, info_.path + ": rows " + std::to_string(first_row) + " + " +
                                                std::to_string(row_count) + " asked for: it has rows 0 to " +
                                                std::to_string(info_.height - 1)};
    }
    const std::int64_t bytes = row_count * row_bytes_;
    if (out.size() < static_cast<std::size_t>(bytes)) {
      return Error{ErrorCode::bad_argument, info_.path + ": the buffer for " + std::to_string(row_count) +
                                                " rows holds " + std::to_string(out.size()) + " bytes, " +
                                                std::to_string(bytes) + " are needed"};
    }
    file_.clear();
    file_.seekg(data_offset_ + first_row * row_bytes_);
    file_.read(reinterpret_cast<char*>(out.data()), bytes);
    if (const int reason = errno; file_.bad()) {
      return read_error(info_.path + ": row " + std::to_string(first_row + file_.gcount() / row_bytes_), reason);
    }
    if (file_.gcount() != bytes) {
      return bad_file(info_.path, "row " + std::to_string(first_row + file_.gcount() / row_bytes_) +
                                      ": the file ends; copy it again");
    }
    if (info_.samples == SampleType::u16) {  // stored high byte first
      for (std::int64_t i = 0; i < bytes; i += 2) {
        std::swap(out[static_cast<std::size_t>(i)], out[static_cast<std::size_t>(i + 1)]);
      }
    }
    return {};
  }

 private:
  std::ifstream file_;
  ImageInfo info_;
  std::int64_t data_offset_;
  std::int64_t row_bytes_;
};

}  // namespace

Result<std::unique_ptr<ImageSource>> open_pnm(const std::string& path, std::int64_t page) {
  if (page != 0) {
    return Error{ErrorCode::out_of_range, path + ": page " + std::to_string(page) + ": the file has pages 0 to 0"};
  }
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto file_bytes = static_cast<std::int64_t>(file.tellg());
  file.seekg(0);
  GRAVURE_TRY(const PnmHeader header, read_header(file, path));
  ImageInfo info;
  info.path = path;
  info.width = header.width;
  info.height = header.height;
  info.samples = header.kind == '4' ? SampleType::bit : header.maximum == 255 ? SampleType::u8 : SampleType::u16;
  info.zero_is_white = header.kind == '4';  // PBM: 1 is black
  const std::string size = std::to_string(info.width) + " x " + std::to_string(info.height) + " pixels";
  const std::int64_t bytes_a_row = row_bytes(info.samples, info.width);
  if (bytes_a_row > kMaxTiffRowBytes) {
    return bad_file(path, "is " + size + ": a row is larger than the " + std::to_string(kMaxTiffRowBytes) +
                              " bytes allowed; cut the picture into bands");
  }
  const std::int64_t wanted = header.data_offset + bytes_a_row * info.height;  // below 2^58
  if (wanted > file_bytes) {
    return bad_file(path, "is " + size + ", so " + std::to_string(wanted) + " bytes, but has " +
                              std::to_string(file_bytes) + ": the file is truncated; copy it again");
  }
  if (wanted < file_bytes) {
    return bad_file(path, std::to_string(file_bytes - wanted) + " bytes follow its " + size +
                              ": only one image a PBM or PGM file is read; split it");
  }
  return std::unique_ptr<ImageSource>(new PnmSource(std::move(file), std::move(info), header.data_offset));
}

}  // namespace gravure
