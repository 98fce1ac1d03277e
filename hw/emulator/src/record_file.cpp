#include "record_file.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "gravure/core/crc32c.hpp"

namespace gravure::emulator {
namespace {

constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeadBytes = 32;

void put(std::vector<std::byte>& bytes, std::uint64_t value, unsigned size) {
  for (unsigned i = 0; i < size; ++i) {
    bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
  }
}

std::uint64_t get(std::span<const std::byte> bytes, std::size_t at, unsigned size) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < size; ++i) {
    value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  }
  return value;
}

std::uint32_t checksum(std::span<const std::byte> bytes) {
  return ~crc32c_continue(kCrc32cStart, bytes);
}

}  // namespace

void append_file_head(std::vector<std::byte>& bytes, std::string_view magic) {
  const auto text = std::as_bytes(std::span(magic.data(), magic.size()));
  bytes.insert(bytes.end(), text.begin(), text.end());
  put(bytes, kVersion, 4);
  put(bytes, 0, 4);
}

void append_record(std::vector<std::byte>& bytes, const Record& record) {
  const std::size_t begin = bytes.size();
  for (const std::uint32_t field : {record.kind, record.a, record.b, record.c}) {
    put(bytes, field, 4);
  }
  put(bytes, record.number, 8);
  put(bytes, record.payload.size(), 4);
  put(bytes, checksum(std::span<const std::byte>(bytes).subspan(begin)), 4);
  if (!record.payload.empty()) {
    bytes.insert(bytes.end(), record.payload.begin(), record.payload.end());
    put(bytes, checksum(record.payload), 4);
  }
}

Error RecordReader::damage(const std::string& what) const {
  return {ErrorCode::bad_file, name_ + ", byte " + std::to_string(end_) + ": " + what +
                                   "; the state of this board is damaged: give another folder"};
}

Result<RecordReader> RecordReader::open(Source source, std::string name, std::string_view magic) {
  RecordReader reader(std::move(source), std::move(name));
  std::array<std::byte, kFileHeadBytes> head{};
  GRAVURE_TRY(const std::size_t got, reader.source_(head));
  std::vector<std::byte> expected;
  append_file_head(expected, magic);
  if (!std::equal(head.begin(), head.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(got, magic.size())),
                  expected.begin())) {
    return reader.damage("it does not begin with " + std::string(magic));
  }
  reader.over_ = got < head.size();
  if (!reader.over_ && get(head, magic.size(), 4) != kVersion) {
    return Error{ErrorCode::version_mismatch, reader.name_ + " has version " +
                                                  std::to_string(get(head, magic.size(), 4)) +
                                                  ", this program reads version " + std::to_string(kVersion) +
                                                  ": use the program that made it, or another folder"};
  }
  reader.end_ = reader.over_ ? 0 : head.size();
  return reader;
}

Result<std::optional<Record>> RecordReader::next() {
  std::array<std::byte, kHeadBytes> head{};
  if (!over_) {
    GRAVURE_TRY(const std::size_t got, source_(head));
    over_ = got < head.size();
  }
  if (over_) {
    return std::optional<Record>();
  }
  if (get(head, kHeadBytes - 4, 4) != checksum(std::span(head).first(kHeadBytes - 4))) {
    return damage("the checksum of a record's head is wrong");
  }
  const std::size_t length = get(head, 24, 4);
  if (length > kMostPayloadBytes) {
    return damage("a record of " + std::to_string(length) + " bytes, most is " + std::to_string(kMostPayloadBytes));
  }
  const std::size_t rest = length == 0 ? 0 : length + 4;
  payload_.clear();
  while (payload_.size() < rest) {  // in parts: the length is believed only as far as there are bytes
    const std::size_t had = payload_.size();
    payload_.resize(std::min(rest, had + (std::size_t{1} << 20U)));
    GRAVURE_TRY(const std::size_t got, source_(std::span(payload_).subspan(had)));
    if (got < payload_.size() - had) {
      over_ = true;
      return std::optional<Record>();
    }
  }
  const std::span<const std::byte> payload = std::span<const std::byte>(payload_).first(length);
  if (length != 0 && get(payload_, length, 4) != checksum(payload)) {
    return damage("the checksum of a record's bytes is wrong");
  }
  end_ += kHeadBytes + rest;
  const auto field = [&](std::size_t at) { return static_cast<std::uint32_t>(get(head, at, 4)); };
  return std::optional(Record{field(0), field(4), field(8), field(12), get(head, 16, 8), payload});
}

}  // namespace gravure::emulator
