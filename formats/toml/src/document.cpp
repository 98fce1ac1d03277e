#include "gravure/formats/toml/document.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "gravure/core/byte_order_mark.hpp"

#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
// Two things in toml++ 3.3 take bad input for a bug, which in a release build is undefined behaviour. The fuzz target
// found both and runs this very configuration.
// - It asserts (or tells clang to assume) that a key follows "[" before it checks so and reports a syntax error: the
//   assertions are off and the checks decide.
// - Its test for white space outside ASCII takes most letters outside ASCII for impossible: they are no white space.
#include <toml++/impl/preprocessor.h>
#undef TOML_ASSERT
#undef TOML_ASSUME
#undef TOML_ASSERT_ASSUME
#undef TOML_UNREACHABLE
#define TOML_ASSERT(condition) static_assert(true)
#define TOML_ASSUME(...) static_assert(true)
#define TOML_ASSERT_ASSUME(condition) static_assert(true)
#define TOML_UNREACHABLE return false
#include <toml++/impl/forward_declarations.h>
#include <toml++/impl/unicode.h>
#undef TOML_UNREACHABLE
#define TOML_UNREACHABLE __builtin_unreachable()
#include <toml++/toml.h>

namespace gravure::toml_file {
namespace {

/// Finds the text of what toml++ locates by line and column (in characters, from 1), in constant time: a hostile file
/// may have all its keys on one line.
class SourceText {
 public:
  explicit SourceText(std::string_view text) : text_(text) {
    line_starts_.push_back(0);
    for (std::size_t at = byte_order_mark_bytes(text); at < text.size(); ++at) {
      if ((static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U) {
        continue;  // not the first byte of a character
      }
      characters_.push_back(at);
      if (text[at] == '\n') {
        line_starts_.push_back(characters_.size());
      }
    }
    characters_.push_back(text.size());
  }

  /// A line without its end.
  std::string_view line(std::uint32_t number) const {
    if (number < 1 || number > line_starts_.size()) {
      return {};
    }
    const std::size_t begin = characters_[line_starts_[number - 1]];
    std::string_view found = text_.substr(begin, characters_[line_end(number)] - begin);
    if (!found.empty() && found.back() == '\r') {
      found.remove_suffix(1);
    }
    return found;
  }

  /// The text of a region, or the part of it on its first line.
  std::string_view literal(const toml::source_region& region) const {
    const std::size_t begin = character(region.begin);
    const std::size_t end = region.end.line == region.begin.line ? character(region.end) : line_end(region.begin.line);
    return end <= begin ? std::string_view() : text_.substr(characters_[begin], characters_[end] - characters_[begin]);
  }

  Location end() const {
    return {static_cast<std::uint32_t>(line_starts_.size()),
            static_cast<std::uint32_t>(characters_.size() - line_starts_.back())};
  }

 private:
  /// Index of the line feed that ends a line, or of the end of the text.
  std::size_t line_end(std::uint32_t number) const {
    return number < line_starts_.size() ? line_starts_[number] - 1 : characters_.size() - 1;
  }

  std::size_t character(toml::source_position at) const {
    if (at.line < 1 || at.line > line_starts_.size() || at.column < 1) {
      return 0;
    }
    return std::min(line_starts_[at.line - 1] + at.column - 1, line_end(at.line));
  }

  std::string_view text_;
  std::vector<std::size_t> characters_;   ///< first byte of each; the size of the text at the end
  std::vector<std::size_t> line_starts_;  ///< first character of each
};

Location location_of(const toml::source_region& region) {
  return {region.begin.line, region.begin.column};
}

Kind kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::boolean:
      return Kind::boolean;
    case toml::node_type::integer:
      return Kind::integer;
    case toml::node_type::floating_point:
      return std::isfinite(node.as_floating_point()->get()) ? Kind::decimal : Kind::not_finite;
    case toml::node_type::string:
      return Kind::text;
    case toml::node_type::array:
      return Kind::array;
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
      return Kind::date;
    case toml::node_type::table:
    case toml::node_type::none:
      return Kind::table;
  }
  return Kind::table;
}

/// Both readings of one literal agree but for the rounding of the double.
[[maybe_unused]] bool agrees(const Rational& exact, double rounded) {
  const double nearest = to_double(exact);
  return std::abs(nearest - rounded) <= 1e-15 * std::abs(nearest) + 1e-300;
}

void read_decimal(std::string_view literal, double rounded, Value& value) {
  const Result<Rational> exact = parse_decimal(literal);
  value.is_readable = static_cast<bool>(exact);
  if (exact) {
    value.number = exact.value();
    assert(agrees(value.number, rounded));
  }
  static_cast<void>(rounded);
}

Value scalar_of(const toml::node& node, const SourceText& source) {
  Value value;
  value.kind = kind_of(node);
  value.at = location_of(node.source());
  const std::string_view literal = source.literal(node.source());
  value.shown = one_line(literal);
  if (node.source().end.line > node.source().begin.line) {
    value.shown += "...";
  }
  if (const auto* boolean = node.as_boolean()) {
    value.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    value.integer = integer->get();
    value.number = ratio(integer->get(), 1);
  } else if (const auto* text = node.as_string()) {
    value.text = text->get();
  } else if (value.kind == Kind::decimal) {
    read_decimal(literal, node.as_floating_point()->get(), value);
  }
  return value;
}

Value value_of(const toml::node& node, const SourceText& source) {
  Value value = scalar_of(node, source);
  if (const auto* array = node.as_array()) {
    for (const toml::node& item : *array) {
      value.items.push_back(scalar_of(item, source));
    }
  }
  return value;
}

/// toml++ sorts by name; violations are told in file order.
template <class T>
void sort_by_place(std::vector<T>& list) {
  std::stable_sort(list.begin(), list.end(), [](const T& a, const T& b) { return a.at < b.at; });
}

Section section_of(const std::string& name, const toml::key& key, const toml::node& node, const SourceText& source) {
  Section section;
  section.name = name;
  section.at = location_of(node.is_table() ? node.source() : key.source());
  section.is_table = node.is_table();
  if (const auto* table = node.as_table()) {
    for (auto&& [entry_key, entry] : *table) {
      section.entries.push_back(
          {std::string(entry_key.str()), location_of(entry_key.source()), value_of(entry, source)});
    }
    sort_by_place(section.entries);
  } else {
    section.value = value_of(node, source);
  }
  return section;
}

}  // namespace

std::string_view kind_name(Kind kind) {
  switch (kind) {
    case Kind::boolean:
      return "a boolean";
    case Kind::integer:
      return "an integer";
    case Kind::decimal:
      return "a decimal number";
    case Kind::not_finite:
      return "inf or nan";
    case Kind::text:
      return "a string";
    case Kind::array:
      return "a list";
    case Kind::table:
      return "a table";
    case Kind::date:
      return "a date or time";
  }
  return "";
}

const Entry* Section::find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

const Section* Document::find(std::string_view name) const {
  const auto found =
      std::find_if(sections.begin(), sections.end(), [&](const Section& section) { return section.name == name; });
  return found == sections.end() ? nullptr : &*found;
}

std::variant<Document, SyntaxError> parse_toml(std::string_view text, std::span<const std::string_view> parents) {
  if (const Location deep = find_deep_key(text, kMaxKeyParts); deep.line != 0) {
    return SyntaxError{deep, "a key of more than " + std::to_string(kMaxKeyParts) + " dotted parts"};
  }
  const SourceText source(text);
  const toml::parse_result parsed = toml::parse(text);
  if (!parsed) {
    const Location at = location_of(parsed.error().source());
    std::string message(parsed.error().description());
    if (const std::string_view line = source.line(at.line); !line.empty()) {
      message += ", in: " + std::string(line);
    }
    return SyntaxError{at, one_line(message, 400)};
  }
  Document document;
  document.end = source.end();
  for (auto&& [key, node] : parsed.table()) {
    const std::string name(key.str());
    const auto* table = node.as_table();
    if (table == nullptr || std::find(parents.begin(), parents.end(), name) == parents.end()) {
      document.sections.push_back(section_of(name, key, node, source));
      continue;
    }
    for (auto&& [child_key, child] : *table) {
      document.sections.push_back(section_of(name + "." + std::string(child_key.str()), child_key, child, source));
    }
  }
  sort_by_place(document.sections);
  return document;
}

Result<Document> read_document(std::string_view text, const std::string& path, std::string_view what,
                               std::size_t most_bytes, std::span<const std::string_view> parents) {
  if (text.size() > most_bytes) {
    return Error{ErrorCode::bad_file, path + ": " + std::to_string(text.size()) + " bytes: " + std::string(what) +
                                          " has at most " + std::to_string(most_bytes)};
  }
  auto parsed = parse_toml(text, parents);
  if (const auto* syntax = std::get_if<SyntaxError>(&parsed)) {
    return Error{ErrorCode::bad_argument, place(path, syntax->at) + "not TOML: " + syntax->message};
  }
  return std::get<Document>(std::move(parsed));
}

}  // namespace gravure::toml_file
