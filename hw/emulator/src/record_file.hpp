#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::emulator {

/// One entry of the files in a board's folder (docs/formats/emulated_board.md).
struct Record {
  std::uint32_t kind = 0;
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t c = 0;
  std::uint64_t number = 0;
  std::span<const std::byte> payload = {};
};

inline constexpr std::size_t kFileHeadBytes = 16;
inline constexpr std::size_t kMostPayloadBytes = std::size_t{1} << 30;

/// `magic` has 8 characters.
void append_file_head(std::vector<std::byte>& bytes, std::string_view magic);
void append_record(std::vector<std::byte>& bytes, const Record& record);

/// Reads records one after the other. A record that breaks off with the file was being written when the board was
/// killed, and is none.
class RecordReader {
 public:
  /// Gives the next bytes of a file, fewer only at its end.
  using Source = std::function<Result<std::size_t>(std::span<std::byte> bytes)>;

  /// `name` is that of the file. bad_file, version_mismatch where it does not begin as it should; a file that breaks
  /// off there has no records.
  static Result<RecordReader> open(Source source, std::string name, std::string_view magic);

  /// The next record, whose payload is valid until the next call; none at the end. bad_file with name and place.
  Result<std::optional<Record>> next();
  /// Bytes of the file up to the end of the last whole record.
  std::uint64_t end() const noexcept { return end_; }
  /// The source stands there now, between two records.
  void moved_to(std::uint64_t place) noexcept { end_ = place; }

 private:
  RecordReader(Source source, std::string name) : source_(std::move(source)), name_(std::move(name)) {}
  Error damage(const std::string& what) const;

  Source source_;
  std::string name_;
  std::uint64_t end_ = 0;
  bool over_ = false;
  std::vector<std::byte> payload_;
};

}  // namespace gravure::emulator
