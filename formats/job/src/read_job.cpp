#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <system_error>

#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/formats/zones_job.hpp"

namespace gravure {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};

std::string reason() {
  return std::generic_category().message(errno);
}

Error too_large(const std::string& path, std::size_t size) {
  return {ErrorCode::bad_file,
          path + ": " + std::to_string(size) + " bytes: a job file has at most " + std::to_string(kMaxJobBytes)};
}

Result<std::string> read_job_text(const std::string& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) {
    return Error{ErrorCode::bad_file, path + ": cannot be opened: " + reason() + "; give the path of a job file"};
  }
  if (!S_ISREG(status.st_mode)) {
    return Error{ErrorCode::bad_file, path + ": is not a regular file; give the path of a job file"};
  }
  if (static_cast<std::uint64_t>(status.st_size) > kMaxJobBytes) {
    return too_large(path, static_cast<std::size_t>(status.st_size));
  }
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rbe"));
  if (!file) {
    return Error{ErrorCode::bad_file, path + ": cannot be opened: " + reason() + "; give the path of a job file"};
  }
  // As much as there is, to one byte beyond the limit, which tells a file that grew meanwhile.
  std::string text;
  std::array<char, 16384> block;
  while (const std::size_t got =
             std::fread(block.data(), 1, std::min(block.size(), kMaxJobBytes + 1 - text.size()), file.get())) {
    text.append(block.data(), got);
  }
  if (std::ferror(file.get()) != 0) {
    return Error{ErrorCode::io, path + ": reading broke off: " + reason()};
  }
  return text;
}

}  // namespace

Result<Job> read_job(const std::string& path) {
  GRAVURE_TRY(const std::string text, read_job_text(path));
  return parse_job(text, path);
}

Result<FreeformJob> read_freeform_job(const std::string& path) {
  GRAVURE_TRY(const std::string text, read_job_text(path));
  return parse_freeform_job(text, path);
}

Result<ZonesJob> read_zones_job(const std::string& path) {
  GRAVURE_TRY(const std::string text, read_job_text(path));
  return parse_zones_job(text, path);
}

std::optional<Mode> mode_of_job(const std::string& path) {
  const Result<std::string> text = read_job_text(path);
  return text ? mode_of_job_text(text.value()) : std::nullopt;
}

}  // namespace gravure
