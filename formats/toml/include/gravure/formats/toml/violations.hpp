#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/job.hpp"

namespace gravure::toml_file {

using Location = TextPlace;

/// Gathers what is wrong with a file, so that one run tells all of it.
class Violations {
 public:
  void add(Location at, std::string text) { list_.push_back({at, false, std::move(text)}); }
  /// A number outside its range and nothing worse.
  void add_range(Location at, std::string text) { list_.push_back({at, true, std::move(text)}); }
  bool empty() const noexcept { return list_.empty(); }
  /// No more will be shown one by one.
  bool is_full() const noexcept { return list_.size() >= kMaxShown; }
  /// One line each, in file order.
  Error to_error(std::string_view path) const;

  static constexpr std::size_t kMaxShown = 1000;

 private:
  struct Violation {
    Location at;
    bool is_range;
    std::string text;
  };
  std::vector<Violation> list_;
};

/// "path:line:column: "
std::string place(std::string_view path, Location at);

/// Safe to print on one line: control characters become '?', and what is longer than `max_bytes` ends in "...".
std::string one_line(std::string_view text, std::size_t max_bytes = 60);

}  // namespace gravure::toml_file
