#include <dirent.h>
#include <glob.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <set>

#include "gravure/formats/image_files.hpp"

namespace gravure {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The run of digits that begins at `at`, without leading zeros; `at` moves behind it.
std::string_view take_number(std::string_view text, std::size_t& at) {
  const std::size_t begin = at;
  while (at < text.size() && is_digit(text[at])) {
    ++at;
  }
  std::string_view digits = text.substr(begin, at - begin);
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string_view::npos ? std::string_view() : digits.substr(first);
}

/// <0, 0, >0 as numbers, whatever their length.
int compare_numbers(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) {
    return a.size() < b.size() ? -1 : 1;
  }
  return a.compare(b);
}

std::string escape_for_glob(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (std::string_view("*?[]\\~{}").find(c) != std::string_view::npos) {
      escaped += '\\';
    }
    escaped += c;
  }
  return escaped;
}

/// glob() that gives up on a pattern such as "/*/*/*/*/*" before it has walked the whole disk.
class Glob {
 public:
  explicit Glob(const std::string& pattern) {
    names_left = kMostNames;
    closed_folder.clear();
    found_.gl_opendir = [](const char* path) -> void* { return ::opendir(path); };
    found_.gl_readdir = [](void* folder) { return names_left-- > 0 ? ::readdir(static_cast<DIR*>(folder)) : nullptr; };
    found_.gl_closedir = [](void* folder) { static_cast<void>(::closedir(static_cast<DIR*>(folder))); };
    found_.gl_stat = ::stat;
    found_.gl_lstat = ::lstat;
    status_ = ::glob(pattern.c_str(), GLOB_NOSORT | GLOB_ALTDIRFUNC, &on_error, &found_);
  }
  Glob(const Glob&) = delete;
  Glob& operator=(const Glob&) = delete;
  ~Glob() { ::globfree(&found_); }
  bool gave_up() const { return names_left < 0; }
  /// "FOLDER: Permission denied" where one could not be listed: what it holds is not known.
  const std::string& unlisted() const { return closed_folder; }
  std::vector<std::string> paths() const {
    return status_ == 0 ? std::vector<std::string>(found_.gl_pathv, found_.gl_pathv + found_.gl_pathc)
                        : std::vector<std::string>();
  }

  static constexpr std::int64_t kMostNames = 1'000'000;

 private:
  static int on_error(const char* path, int reason) {
    if (closed_folder.empty() && reason != ENOENT && reason != ENOTDIR && reason != ELOOP) {
      closed_folder = std::string(path) + ": " + std::strerror(reason);
    }
    return 0;
  }
  static thread_local std::int64_t names_left;  // glob() hands no context to its callbacks
  static thread_local std::string closed_folder;
  ::glob_t found_ = {};
  int status_;
};

thread_local std::int64_t Glob::names_left = 0;
thread_local std::string Glob::closed_folder;

/// What a pattern matches, without folders; the error says what is wrong where that is nothing.
Result<std::vector<std::string>> matches_of(const std::string& folder, const std::string& pattern) {
  const bool absolute = !pattern.empty() && pattern.front() == '/';
  const std::string prefix = absolute || folder.empty() ? "" : folder + (folder.back() == '/' ? "" : "/");
  const std::string shown = "\"" + pattern + "\" ";
  std::error_code unknown;
  if (std::filesystem::is_regular_file(prefix + pattern, unknown)) {
    return std::vector<std::string>{prefix + pattern};  // a name that happens to hold * ? or [ is that name
  }
  const Glob glob(escape_for_glob(prefix) + pattern);
  if (glob.gave_up()) {
    return Error{ErrorCode::bad_file, shown + "looks through more than " + std::to_string(Glob::kMostNames) +
                                          " names: name the folder of the images"};
  }
  if (!glob.unlisted().empty()) {
    return Error{ErrorCode::bad_file, shown + "cannot be looked for in " + glob.unlisted() + ": check its permissions"};
  }
  std::vector<std::string> paths = glob.paths();
  const bool any = !paths.empty();
  std::erase_if(paths, [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
  });
  if (paths.empty()) {
    const std::string where = folder.empty() ? "." : folder;
    return Error{ErrorCode::bad_file,
                 any ? shown + "matches only folders: name the files in them, such as \"" + pattern + "/*.tif\""
                     : shown + "matches no file in " + where + ": patterns are relative to the job file"};
  }
  std::sort(paths.begin(), paths.end(), natural_less);
  return paths;
}

/// The same for every way to write the path of one directory entry; links to one file are different entries.
std::string identity_of(const std::string& path) {
  const std::filesystem::path entry(path);
  std::error_code failed;
  const std::filesystem::path parent = entry.parent_path();
  const std::filesystem::path folder = std::filesystem::weakly_canonical(parent.empty() ? "." : parent, failed);
  return failed ? path : (folder / entry.filename()).string();
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      if (const int order = compare_numbers(take_number(a, i), take_number(b, j)); order != 0) {
        return order < 0;
      }
    } else if (a[i] != b[j]) {
      return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    } else {
      ++i;
      ++j;
    }
  }
  const std::size_t left_a = a.size() - i;
  const std::size_t left_b = b.size() - j;
  return left_a != left_b ? left_a < left_b : a < b;  // equal but for leading zeros: byte order decides
}

Result<std::vector<std::string>> expand_patterns(const std::string& folder, const std::vector<std::string>& patterns) {
  std::vector<std::string> files;
  std::set<std::string> seen;
  std::string unmatched;
  for (const std::string& pattern : patterns) {
    const Result<std::vector<std::string>> matches = matches_of(folder, pattern);
    if (!matches) {
      unmatched += (unmatched.empty() ? "" : "\n") + matches.error().message;
      continue;
    }
    for (const std::string& path : matches.value()) {
      if (seen.insert(identity_of(path)).second) {
        files.push_back(path);
      }
    }
  }
  if (!unmatched.empty()) {
    return Error{ErrorCode::bad_file, unmatched};
  }
  return files;
}

}  // namespace gravure
