#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"
#include "gravure/formats/toml/violations.hpp"

namespace gravure::toml_file {

enum class Kind : std::uint8_t { boolean, integer, decimal, not_finite, text, array, table, date };

/// "an integer", for "must be ..., not an integer".
std::string_view kind_name(Kind kind);

/// One value with the place it stands at. Tables inside values are not followed: no key of a job is one.
struct Value {
  Kind kind = Kind::table;
  Location at;
  std::string shown;  ///< the value as the file writes it: first line, shortened, control characters replaced
  bool boolean = false;
  std::int64_t integer = 0;
  Rational number = 0;      ///< integer and decimal: exact
  bool is_readable = true;  ///< false: a decimal with more digits or a larger exponent than parse_decimal() takes
  std::string text;
  std::vector<Value> items;
};

struct Entry {
  std::string key;
  Location at;
  Value value;
};

/// One key of the root: a section with its entries, or a value that stands where a section should.
struct Section {
  std::string name;
  Location at;
  bool is_table = true;
  Value value;  ///< where it is no table
  std::vector<Entry> entries;

  const Entry* find(std::string_view key) const;
};

struct Document {
  std::vector<Section> sections;  ///< these and their entries in file order
  Location end;                   ///< just behind the last character

  const Section* find(std::string_view name) const;
};

struct SyntaxError {
  Location at;
  std::string message;
};

/// Parses TOML 1.0. Keys of more than kMaxKeyParts parts are refused: nesting must not exhaust the stack. The tables of
/// a root key in `parents` are sections of their own ("twin.servo"), in its stead.
std::variant<Document, SyntaxError> parse_toml(std::string_view text, std::span<const std::string_view> parents = {});

/// The document that the text of a file holds. Fails with bad_file where the text has more than `most_bytes`, which is
/// said of `what` ("a job file"), and with bad_argument, at its place, where it is no TOML.
Result<Document> read_document(std::string_view text, const std::string& path, std::string_view what,
                               std::size_t most_bytes, std::span<const std::string_view> parents = {});

inline constexpr int kMaxKeyParts = 32;

/// Where a key of more than `max_parts` dotted parts stands; line 0 if nowhere. Looks no further than the first
/// unterminated string, where parsing ends as well.
Location find_deep_key(std::string_view text, int max_parts);

}  // namespace gravure::toml_file
