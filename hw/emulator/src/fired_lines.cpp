#include "gravure/emulator/fired_lines.hpp"

#include <fcntl.h>

#include <cerrno>

#include "board_folder.hpp"
#include "gravure/core/file_output.hpp"

namespace gravure::emulator {

Result<void> read_fired_lines(const std::string& folder, const std::function<Result<void>(const FiredLine&)>& take) {
  const std::string name = folder + "/" + kFiredFile;
  const OpenFile file(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0) {
    return open_error(name, errno);
  }
  GRAVURE_TRY(RecordReader reader, RecordReader::open(source_of(file, name), name, kFiredMagic));
  for (;;) {
    GRAVURE_TRY(const std::optional<Record> record, reader.next());
    if (!record) {
      return {};
    }
    GRAVURE_CHECK(take({.revolution = record->a, .line = record->b, .first_slot = record->c, .bits = record->payload}));
  }
}

}  // namespace gravure::emulator
