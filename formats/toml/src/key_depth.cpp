#include "gravure/formats/toml/document.hpp"

namespace gravure::toml_file {
namespace {

/// Walks TOML text just closely enough to know what is a key part, a string and a comment.
class DepthScanner {
 public:
  DepthScanner(std::string_view text, int max_parts) : text_(text), max_parts_(max_parts) {}

  Location find() {
    while (at_ < text_.size() && parts_ <= max_parts_) {
      if (!step()) {
        return {};
      }
    }
    return parts_ > max_parts_ ? here() : Location{};
  }

 private:
  /// Takes one token; false at a string without end.
  bool step() {
    const char c = text_[at_];
    if (c == '"' || c == '\'') {
      return skip_string(c);
    }
    if (c == '#') {
      while (at_ < text_.size() && text_[at_] != '\n') {
        ++at_;
      }
      return true;
    }
    if (c == '.') {
      ++parts_;
    } else if (!is_key_character(c)) {
      parts_ = 1;  // a new key or value begins
    }
    ++at_;
    return true;
  }

  /// Bare key characters, the space round dots, and whatever is not ASCII (an error the parser reports).
  static bool is_key_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == ' ' || c == '\t' || static_cast<unsigned char>(c) >= 0x80U;
  }

  bool skip_string(char quote) {
    const bool is_multi_line = text_.substr(at_, 3) == std::string_view(quote == '"' ? "\"\"\"" : "'''");
    at_ += is_multi_line ? 3 : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\\' && quote == '"') {
        at_ += 2;
      } else if (c == '\n' && !is_multi_line) {
        return false;
      } else if (c != quote) {
        ++at_;
      } else if (!is_multi_line) {
        ++at_;
        return true;
      } else if (count_quotes(quote) >= 3) {
        at_ += count_quotes(quote);
        return true;
      } else {
        at_ += count_quotes(quote);
      }
    }
    return false;
  }

  /// Quotes standing together from here; a multi-line string may end in five, two of them its own.
  std::size_t count_quotes(char quote) const {
    std::size_t count = 0;
    while (count < 5 && at_ + count < text_.size() && text_[at_ + count] == quote) {
      ++count;
    }
    return count;
  }

  Location here() const {
    Location location{1, 1};
    for (const char c : text_.substr(0, at_)) {
      if (c == '\n') {
        location = {location.line + 1, 1};
      } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
        ++location.column;
      }
    }
    return location;
  }

  std::string_view text_;
  int max_parts_;
  std::size_t at_ = 0;
  int parts_ = 1;
};

}  // namespace

Location find_deep_key(std::string_view text, int max_parts) {
  return DepthScanner(text, max_parts).find();
}

}  // namespace gravure::toml_file
