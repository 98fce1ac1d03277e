#include "gravure/emulator/fired_lines.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "board_folder.hpp"
#include "gravure/core/crc32c.hpp"
#include "gravure/core/file_output.hpp"

namespace gravure::emulator {
namespace {

constexpr char kProgramFile[] = "program";
constexpr std::size_t kSealBytes = 512;

}  // namespace

Result<void> read_fired_lines(const std::string& folder, const std::function<Result<void>(const FiredLine&)>& take) {
  const std::string name = folder + "/" + kFiredFile;
  GRAVURE_TRY(const OpenFile file, open_regular(name, O_RDONLY));
  GRAVURE_TRY(RecordReader reader, RecordReader::open(source_of(file, name), name, kFiredMagic));
  for (;;) {
    GRAVURE_TRY(const std::optional<Record> record, reader.next());
    if (!record) {
      return {};
    }
    GRAVURE_CHECK(take({.revolution = record->a, .line = record->b, .first_slot = record->c, .bits = record->payload}));
  }
}

std::vector<std::string> state_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const char* name : {kHostFile, kFiredFile, kProgramFile}) {
    files.push_back(folder + "/" + name);
  }
  return files;
}

Result<std::string> program_seal(const std::string& path) {
  GRAVURE_TRY(const OpenFile file, open_regular(path, O_RDONLY));
  std::array<std::byte, kSealBytes> head{};
  GRAVURE_TRY(const std::size_t got, source_of(file, path)(head));
  std::array<char, 8> digits{};
  const std::uint32_t seal = ~crc32c_continue(kCrc32cStart, std::span(head).first(got));
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), seal, 16).ptr;
  return std::string(digits.data(), end);
}

Result<void> note_program(const std::string& folder, const std::string& path) {
  std::error_code unknown;
  const std::filesystem::path whole = std::filesystem::absolute(path, unknown);
  GRAVURE_TRY(const std::string seal, program_seal(path));
  return write_file(folder + "/" + kProgramFile, (unknown ? path : whole.string()) + "\n" + seal + "\n");
}

Result<NotedProgram> noted_program(const std::string& folder) {
  const std::string name = folder + "/" + kProgramFile;
  constexpr std::size_t kMostBytes = 1 << 16;
  std::error_code unknown;
  if (!std::filesystem::exists(name, unknown)) {
    return Error{ErrorCode::bad_file,
                 name + " is not there: nothing says which program this board ran; give --program"};
  }
  GRAVURE_TRY(const std::string text, read_file(name, kMostBytes));
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string rest = text.substr(std::min(end + 1, text.size()));
  return NotedProgram{.path = text.substr(0, end), .seal = rest.substr(0, rest.find('\n'))};
}

}  // namespace gravure::emulator
