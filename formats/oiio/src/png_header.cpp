#include <zlib.h>

#include <cerrno>

#include "gravure/core/file_output.hpp"
#include "header_facts.hpp"

namespace gravure::oiio {
namespace {

constexpr std::int64_t kBeforeData = 8;  // length and type of a chunk; its checksum follows the data with 4 bytes
constexpr std::int64_t kPiece = std::int64_t{1} << 20;
constexpr std::int64_t kMaxDeflateRatio = 1032;  // 258 bytes from 2 bits

/// io where the last read failed.
Error damaged(const std::string& path, std::int64_t offset, const std::string& what) {
  if (const int reason = errno; is_device_failure(reason)) {
    return read_error(path, reason);
  }
  return bad_file(path, what + " at byte " + std::to_string(offset) +
                            ": the file is damaged or truncated; copy or export it again");
}

/// The type of the chunk at `offset` and where the next one begins, once its checksum was found right.
struct Chunk {
  std::string type;
  std::int64_t data_bytes = 0;
  std::int64_t next = 0;
};

Result<Chunk> check_chunk(HeaderFile& file, std::int64_t offset) {
  errno = 0;
  const std::string head = file.bytes(offset, kBeforeData);
  const std::int64_t length = big_endian(head, 0, 4);
  if (head.size() < kBeforeData || length > file.size() - offset - kBeforeData - 4) {
    return damaged(file.path(), offset, "a PNG chunk reaches beyond the end of the file, begun");
  }
  uLong sum = crc32(0, reinterpret_cast<const Bytef*>(head.data() + 4), 4);
  for (std::int64_t done = 0; done < length;) {
    const std::string piece = file.bytes(offset + kBeforeData + done, std::min(kPiece, length - done));
    if (piece.empty()) {
      return damaged(file.path(), offset, "a PNG chunk cannot be read");
    }
    sum = crc32(sum, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size()));
    done += static_cast<std::int64_t>(piece.size());
  }
  if (big_endian(file.bytes(offset + kBeforeData + length, 4), 0, 4) != sum) {
    return damaged(file.path(), offset, "a PNG chunk with a wrong checksum");
  }
  return Chunk{head.substr(4, 4), length, offset + kBeforeData + length + 4};
}

Result<HeaderFacts> read_ihdr(const std::string& path, std::string_view ihdr) {
  HeaderFacts facts;
  facts.width = big_endian(ihdr, 0, 4);
  facts.height = big_endian(ihdr, 4, 4);
  facts.bits = static_cast<unsigned char>(ihdr[8]);
  const int colour_type = static_cast<unsigned char>(ihdr[9]);
  const int interlace = static_cast<unsigned char>(ihdr[12]);
  if (colour_type != 0) {
    return not_one_channel(path, colour_type == 3   ? "has a palette"
                                 : colour_type == 4 ? "has transparency (alpha)"
                                                    : "is in colour");
  }
  if (facts.bits != 1 && facts.bits != 8 && facts.bits != 16) {
    return bad_file(path, std::to_string(facts.bits) + " bits a sample: PNG is read with 1, 8 or 16; save it so");
  }
  if (interlace != 0) {
    return bad_file(path, "is interlaced, which cannot be read row by row; save it without interlacing");
  }
  GRAVURE_CHECK(check_size(path, facts.width, facts.height, facts.bits));
  if (facts.width > kMaxPngSide || facts.height > kMaxPngSide) {
    return bad_file(path, "is " + std::to_string(facts.width) + " x " + std::to_string(facts.height) +
                              " pixels: PNG is read up to " + std::to_string(kMaxPngSide) + " a side; save it as TIFF");
  }
  facts.random_access = false;
  const std::int64_t row_bytes = (facts.width * facts.bits + 7) / 8;
  facts.decoder_bytes = kLibraryBytes + 4 * row_bytes;  // this row and the last one in libpng, a row passed over
  return facts;
}

}  // namespace

/// Every chunk's checksum is verified here: libpng would print what it finds wrong.
Result<HeaderFacts> read_png_header(const std::string& path) {
  HeaderFile file(path);
  const std::string start = file.bytes(0, 8 + kBeforeData + 13);
  if (start.size() < 8 + kBeforeData + 13 || start.substr(12, 4) != "IHDR" || big_endian(start, 8, 4) != 13) {
    return damaged(path, 8, "no PNG header (IHDR)");
  }
  GRAVURE_TRY(const Chunk first, check_chunk(file, 8));
  GRAVURE_TRY(const HeaderFacts facts, read_ihdr(path, std::string_view(start).substr(8 + kBeforeData)));
  std::int64_t data_bytes = 0;
  for (std::int64_t offset = first.next;;) {
    GRAVURE_TRY(const Chunk chunk, check_chunk(file, offset));
    if (chunk.type == "tRNS") {
      return not_one_channel(path, "has transparency (tRNS)");
    }
    if (chunk.type == "IDAT") {
      data_bytes += chunk.data_bytes;
    }
    if (chunk.type == "IEND") {
      break;
    }
    offset = chunk.next;
  }
  const std::int64_t raw_bytes = facts.height * (1 + (facts.width * facts.bits + 7) / 8);  // below 2^61
  if (raw_bytes / kMaxDeflateRatio > data_bytes) {
    return bad_file(path, "declares " + std::to_string(facts.width) + " x " + std::to_string(facts.height) +
                              " pixels, which its " + std::to_string(data_bytes) +
                              " bytes of data cannot hold: the file is damaged");
  }
  return facts;
}

}  // namespace gravure::oiio
