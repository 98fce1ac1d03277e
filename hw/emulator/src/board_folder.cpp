#include "board_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "gravure/core/file_output.hpp"

namespace gravure::emulator {
namespace {

Error io_error(const std::string& name, const std::string& what) {
  return {ErrorCode::io, name + ": " + what + ": " + std::strerror(errno)};
}

/// In one write(2), unless the system breaks it up.
Result<void> write_all(const OpenFile& file, std::span<const std::byte> bytes, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) {
      return io_error(name, "cannot be written");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return {};
}

}  // namespace

OpenFile::~OpenFile() {
  if (number_ >= 0) {
    ::close(number_);
  }
}

Result<OpenFile> open_regular(const std::string& name, int flags) {
  OpenFile file(::open(name.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0666));
  if (file.number() < 0) {
    return open_error(name, errno);
  }
  struct stat about {};
  if (::fstat(file.number(), &about) != 0) {
    return io_error(name, "cannot be looked at");
  }
  if (!S_ISREG(about.st_mode)) {
    return Error{ErrorCode::bad_file,
                 name + ": is not a regular file; the state of this board is damaged: give another folder"};
  }
  return file;
}

RecordReader::Source source_of(const OpenFile& file, const std::string& name) {
  return [number = file.number(), name](std::span<std::byte> bytes) -> Result<std::size_t> {
    std::size_t got = 0;
    while (got < bytes.size()) {
      const ssize_t read = ::read(number, bytes.data() + got, bytes.size() - got);
      if (read < 0 && errno != EINTR) {
        return io_error(name, "cannot be read");
      }
      if (read == 0) {
        break;
      }
      got += static_cast<std::size_t>(std::max<ssize_t>(read, 0));
    }
    return got;
  };
}

Result<BoardFolder> BoardFolder::open(const std::string& path) {
  std::error_code failed;
  std::filesystem::create_directories(path, failed);
  BoardFolder folder;
  folder.path_ = path;
  folder.lock_ = OpenFile(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.lock_.number() < 0) {
    return io_error(path, "cannot be opened");
  }
  if (::flock(folder.lock_.number(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) {
      return io_error(path, "cannot be locked");
    }
    return Error{ErrorCode::device, "emulated:" + path +
                                        ": another process is using this board; wait until it is done, or give "
                                        "another folder"};
  }
  const std::string host = path + "/" + kHostFile;
  const std::string fired = path + "/" + kFiredFile;
  folder.is_new_ = !std::filesystem::exists(host, failed);
  const std::uintmax_t lines = std::filesystem::file_size(fired, failed);
  if (folder.is_new_ && !failed && lines > kFileHeadBytes) {
    return Error{ErrorCode::bad_file, host + " is missing, " + kFiredFile +
                                          " is there: the state of this board is damaged; give another folder"};
  }
  GRAVURE_TRY(folder.fired_, open_regular(fired, O_RDWR | O_CREAT | (folder.is_new_ ? O_TRUNC : 0)));
  if (folder.is_new_) {
    append_file_head(folder.buffer_, kFiredMagic);
    GRAVURE_CHECK(write_all(folder.fired_, folder.buffer_, fired));
    folder.fired_end_ = folder.buffer_.size();
  } else {
    GRAVURE_TRY(folder.host_, open_regular(host, O_RDWR));
  }
  return folder;
}

/// From a place on, which is the end of a record.
Result<void> BoardFolder::read_fired_from(std::uint64_t place) {
  const std::string name = path_ + "/" + kFiredFile;
  struct stat about {};
  if (::fstat(fired_.number(), &about) != 0) {
    return io_error(name, "cannot be looked at");
  }
  if (place < kFileHeadBytes || static_cast<std::uint64_t>(about.st_size) < place) {
    return Error{ErrorCode::bad_file, name + " has " + std::to_string(about.st_size) + " bytes, must have " +
                                          std::to_string(place) +
                                          " or more: the state of this board is damaged; give another folder"};
  }
  ::lseek(fired_.number(), 0, SEEK_SET);
  GRAVURE_TRY(RecordReader reader, RecordReader::open(source_of(fired_, name), name, kFiredMagic));
  ::lseek(fired_.number(), static_cast<off_t>(place), SEEK_SET);
  reader.moved_to(place);
  again_ = std::move(reader);
  fired_end_ = place;
  return {};
}

Result<void> BoardFolder::replay(const std::function<Result<void>(const Record& event)>& take) {
  const std::string name = path_ + "/" + kHostFile;
  GRAVURE_TRY(RecordReader reader, RecordReader::open(source_of(host_, name), name, kHostMagic));
  bool begun = false;
  for (;;) {
    GRAVURE_TRY(const std::optional<Record> event, reader.next());
    if (!event) {
      break;
    }
    const bool begins = event->kind == static_cast<std::uint32_t>(BoardEvent::begin);
    if (begins == begun) {
      return Error{ErrorCode::bad_file, name + ", byte " + std::to_string(reader.end()) +
                                            ": an event out of place; the state of this board is damaged: give "
                                            "another folder"};
    }
    if (begins) {
      begun = true;
      GRAVURE_CHECK(read_fired_from(event->a | std::uint64_t{event->b} << 32U));
    }
    GRAVURE_CHECK(take(*event));
  }
  if (!begun) {
    return Error{ErrorCode::bad_file, name + " is empty: the state of this board is damaged; give another folder"};
  }
  const auto end = static_cast<off_t>(reader.end());
  if (::ftruncate(host_.number(), end) != 0 || ::lseek(host_.number(), end, SEEK_SET) != end) {
    return io_error(name, "cannot be cut where it broke off");
  }
  return {};
}

Result<void> BoardFolder::begin(std::uint64_t power_up, const std::string& options, const std::vector<Record>& events) {
  const std::string name = path_ + "/" + kHostFile;
  const std::string fresh = name + ".new";
  buffer_.clear();
  append_file_head(buffer_, kHostMagic);
  append_record(buffer_, {.kind = static_cast<std::uint32_t>(BoardEvent::begin),
                          .a = static_cast<std::uint32_t>(fired_end_),
                          .b = static_cast<std::uint32_t>(fired_end_ >> 32U),
                          .number = power_up,
                          .payload = std::as_bytes(std::span(options.data(), options.size()))});
  for (const Record& event : events) {
    append_record(buffer_, event);
  }
  GRAVURE_TRY(OpenFile file, open_regular(fresh, O_RDWR | O_CREAT | O_TRUNC));
  GRAVURE_CHECK(write_all(file, buffer_, fresh));
  if (::rename(fresh.c_str(), name.c_str()) != 0) {
    return io_error(fresh, "cannot be renamed to " + name);
  }
  host_ = std::move(file);
  is_new_ = false;
  return {};
}

Result<void> BoardFolder::note(const Record& event) {
  buffer_.clear();
  append_record(buffer_, event);
  return write_all(host_, buffer_, path_ + "/" + kHostFile);
}

/// Whether the line is in the file already; the first that is not ends that for good.
Result<bool> BoardFolder::known(const Record& record) {
  const std::string name = path_ + "/" + kFiredFile;
  if (!again_) {
    return false;
  }
  GRAVURE_TRY(const std::optional<Record> known, again_->next());
  if (known) {
    const bool same = known->number == record.number && known->a == record.a && known->b == record.b &&
                      known->c == record.c && std::ranges::equal(known->payload, record.payload);
    if (!same) {
      return Error{ErrorCode::bad_file, name + ", before byte " + std::to_string(again_->end()) +
                                            ": not what the board fired; its state is damaged: give another folder"};
    }
    fired_end_ = again_->end();
    return true;
  }
  GRAVURE_CHECK(cut_fired());
  return false;
}

/// Where a record broke off, the next one is written.
Result<void> BoardFolder::cut_fired() {
  again_.reset();
  const auto end = static_cast<off_t>(fired_end_);
  if (::ftruncate(fired_.number(), end) != 0 || ::lseek(fired_.number(), end, SEEK_SET) != end) {
    return io_error(path_ + "/" + kFiredFile, "cannot be cut where it broke off");
  }
  return {};
}

Result<void> BoardFolder::end_replay() {
  if (!again_) {
    return {};
  }
  GRAVURE_TRY(const std::optional<Record> more, again_->next());
  if (more) {
    return Error{ErrorCode::bad_file, path_ + "/" + kFiredFile + ", byte " + std::to_string(fired_end_) +
                                          ": a line that the board never took; its state is damaged: give another "
                                          "folder"};
  }
  return cut_fired();
}

Result<bool> BoardFolder::fire(std::uint32_t revolution, std::uint32_t line, const ExecutedLine& executed) {
  const Record record{.kind = 1,
                      .a = revolution,
                      .b = line,
                      .c = static_cast<std::uint32_t>(executed.first_slot),
                      .number = static_cast<std::uint64_t>(executed.ordinal),
                      .payload = executed.fired};
  GRAVURE_TRY(const bool there, known(record));
  if (there) {
    return false;
  }
  buffer_.clear();
  append_record(buffer_, record);
  GRAVURE_CHECK(write_all(fired_, buffer_, path_ + "/" + kFiredFile));
  fired_end_ += buffer_.size();
  return true;
}

}  // namespace gravure::emulator
