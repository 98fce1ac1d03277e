#include "gravure/emulator/fired_lines.hpp"

#include <fcntl.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "board_folder.hpp"
#include "gravure/core/file_output.hpp"

namespace gravure::emulator {
namespace {

constexpr char kProgramFile[] = "program";

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

Result<void> note_program(const std::string& folder, const std::string& path) {
  std::error_code unknown;
  const std::filesystem::path whole = std::filesystem::absolute(path, unknown);
  return write_file(folder + "/" + kProgramFile, (unknown ? path : whole.string()) + "\n");
}

Result<std::string> noted_program(const std::string& folder) {
  const std::string name = folder + "/" + kProgramFile;
  constexpr std::size_t kMostBytes = 1 << 16;
  std::error_code unknown;
  if (!std::filesystem::exists(name, unknown)) {
    return Error{ErrorCode::bad_file,
                 name + " is not there: nothing says which program this board ran; give --program"};
  }
  GRAVURE_TRY(std::string path, read_file(name, kMostBytes));
  path.erase(std::find(path.begin(), path.end(), '\n'), path.end());
  return path;
}

}  // namespace gravure::emulator
