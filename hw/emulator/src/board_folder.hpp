#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/line_device.hpp"
#include "record_file.hpp"

namespace gravure::emulator {

inline constexpr std::string_view kFiredMagic = "GRVFIRED";
inline constexpr std::string_view kHostMagic = "GRVHOST1";
inline constexpr char kFiredFile[] = "fired";
inline constexpr char kHostFile[] = "host";

/// What happened to a board.
enum class BoardEvent : std::uint32_t {
  begin = 1,  ///< power_up in `number`; bytes of `fired` in a (low) and b (high); the payload is its options
  write = 2,  ///< register a took b
  take = 3,   ///< the payload
  pass = 4,   ///< time passed
  gone = 5,   ///< nobody speaks to it any more
  interlock = 6,
  options = 7,   ///< the payload, from now on
  counters = 8,  ///< a lines were executed, line b, c comes next, `number` frames were taken
};

/// A file descriptor that is closed.
class OpenFile {
 public:
  OpenFile() = default;
  explicit OpenFile(int number) noexcept : number_(number) {}
  OpenFile(OpenFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile();
  int number() const noexcept { return number_; }

 private:
  int number_ = -1;
};

/// Never waits for the other end of a pipe. bad_file: it cannot be opened, or is no regular file.
Result<OpenFile> open_regular(const std::string& name, int flags);

/// Reads from where `file` stands, which must outlive the source.
RecordReader::Source source_of(const OpenFile& file, const std::string& name);

/// The folder of a board's state, locked as long as this lives. What fired is in one file; in another is all that the
/// host did since the state was last all known from the registers alone, so that a board is made again by doing it all
/// again: every line that fires then must be the one that stands in the first file, or come behind its end.
class BoardFolder {
 public:
  /// Makes it where there is none. device: another process has it. io.
  static Result<BoardFolder> open(const std::string& path);

  bool is_new() const noexcept { return is_new_; }
  const std::string& path() const noexcept { return path_; }
  /// Gives every event since the last begin(), the first is that.
  Result<void> replay(const std::function<Result<void>(const Record& event)>& take);
  /// Forgets all events; `events` come first from now on, behind begin.
  Result<void> begin(std::uint64_t power_up, const std::string& options, const std::vector<Record>& events);
  Result<void> note(const Record& event);
  /// All events have been taken again, and what followed from the last.
  Result<void> end_replay();
  /// A line fired, one write; false: it stands there since before.
  Result<bool> fire(std::uint32_t revolution, std::uint32_t line, const ExecutedLine& executed);

 private:
  Result<void> read_fired_from(std::uint64_t place);
  Result<bool> known(const Record& record);
  Result<void> cut_fired();

  std::string path_;
  OpenFile lock_;
  OpenFile host_;
  OpenFile fired_;
  std::uint64_t fired_end_ = 0;
  std::optional<RecordReader> again_;  ///< lines that are in the file already
  bool is_new_ = false;
  std::vector<std::byte> buffer_;
};

}  // namespace gravure::emulator
