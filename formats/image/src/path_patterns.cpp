#include <glob.h>

#include <algorithm>
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

class Glob {
 public:
  explicit Glob(const std::string& pattern) : status_(::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found_)) {}
  Glob(const Glob&) = delete;
  Glob& operator=(const Glob&) = delete;
  ~Glob() { ::globfree(&found_); }
  std::vector<std::string> paths() const {
    return status_ == 0 ? std::vector<std::string>(found_.gl_pathv, found_.gl_pathv + found_.gl_pathc)
                        : std::vector<std::string>();
  }

 private:
  ::glob_t found_ = {};
  int status_;
};

std::vector<std::string> matches_of(const std::string& folder, const std::string& pattern) {
  const bool absolute = !pattern.empty() && pattern.front() == '/';
  const std::string prefix = absolute || folder.empty() ? "" : folder + (folder.back() == '/' ? "" : "/");
  std::error_code unknown;
  if (std::filesystem::is_regular_file(prefix + pattern, unknown)) {
    return {prefix + pattern};  // a name that happens to hold * ? or [ is that name
  }
  std::vector<std::string> paths = Glob(escape_for_glob(prefix) + pattern).paths();
  std::erase_if(paths, [](const std::string& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
  });
  std::sort(paths.begin(), paths.end(), natural_less);
  return paths;
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
    const std::vector<std::string> matches = matches_of(folder, pattern);
    if (matches.empty()) {
      unmatched += (unmatched.empty() ? "" : "\n") + std::string("\"") + pattern + "\" matches no file in " +
                   (folder.empty() ? "." : folder) + ": patterns are relative to the job file";
    }
    for (const std::string& path : matches) {
      if (seen.insert(path).second) {
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
