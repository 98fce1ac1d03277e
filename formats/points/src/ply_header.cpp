#include "ply_header.hpp"

#include <utility>

#include "point_text.hpp"

namespace gravure {
namespace {

constexpr std::size_t kMostElements = 64;
constexpr std::size_t kMostProperties = 256;

std::optional<ScalarType> scalar_type(std::string_view word) {
  constexpr std::pair<std::string_view, ScalarType> kTypes[] = {
      {"char", ScalarType::i8},    {"uchar", ScalarType::u8},   {"short", ScalarType::i16},
      {"ushort", ScalarType::u16}, {"int", ScalarType::i32},    {"uint", ScalarType::u32},
      {"float", ScalarType::f32},  {"double", ScalarType::f64}, {"int8", ScalarType::i8},
      {"uint8", ScalarType::u8},   {"int16", ScalarType::i16},  {"uint16", ScalarType::u16},
      {"int32", ScalarType::i32},  {"uint32", ScalarType::u32}, {"float32", ScalarType::f32},
      {"float64", ScalarType::f64}};
  for (const auto& [text, type] : kTypes) {
    if (word == text) {
      return type;
    }
  }
  return std::nullopt;
}

bool is_integer(ScalarType type) noexcept {
  return type != ScalarType::f32 && type != ScalarType::f64;
}

class PlyHeaderReader {
 public:
  PlyHeaderReader(std::string_view bytes, const std::string& name) : rest_(bytes), size_(bytes.size()), name_(name) {}

  Result<PlyHeader> read() {
    if (without_byte_order_mark(take()) != "ply") {
      return wrong("a PLY file begins with the line ply");
    }
    bool has_format = false;
    while (!rest_.empty()) {
      TextWords words(take());
      const std::string_view key = words.next();
      if (key == "end_header") {
        header_.bytes = size_ - rest_.size();
        if (!has_format) {
          return wrong("the header has no line \"format ascii 1.0\" (or binary_little_endian, binary_big_endian)");
        }
        GRAVURE_CHECK(check_size());
        return std::move(header_);
      }
      if (key == "format") {
        has_format = true;
        GRAVURE_CHECK(format(words));
      } else if (key == "element") {
        GRAVURE_CHECK(element(words));
      } else if (key == "property") {
        GRAVURE_CHECK(property(words));
      } else if (!key.empty() && key != "comment" && key != "obj_info") {
        return wrong(in_quotes(key) + ": must be format, element, property, comment, obj_info or end_header");
      }
    }
    return wrong("the file ends before end_header");
  }

 private:
  std::string_view take() {
    ++header_.lines;
    return take_line(rest_);
  }
  Error wrong(const std::string& what) const { return bad_line(name_, header_.lines, what); }

  Result<void> format(TextWords& words) {
    const std::string_view word = words.next();
    if (word == "ascii") {
      header_.format = PlyFormat::ascii;
    } else if (word == "binary_little_endian") {
      header_.format = PlyFormat::little_endian;
    } else if (word == "binary_big_endian") {
      header_.format = PlyFormat::big_endian;
    } else {
      return wrong("format " + in_quotes(word) + ": must be ascii, binary_little_endian or binary_big_endian");
    }
    const std::string_view version = words.next();
    return version == "1.0" ? Result<void>() : wrong("version " + in_quotes(version) + ": must be 1.0");
  }

  Result<void> element(TextWords& words) {
    PlyElement element;
    element.name = words.next();
    const std::string_view count = words.next();
    if (element.name.empty() || !to_count(count, element.count)) {
      return wrong("element " + in_quotes(element.name) + " " + in_quotes(count) + ": must be a name and a count");
    }
    if (header_.elements.size() == kMostElements) {
      return wrong("more than " + std::to_string(kMostElements) + " elements");
    }
    header_.elements.push_back(std::move(element));
    return {};
  }

  Result<void> property(TextWords& words) {
    PlyProperty property;
    std::string_view type = words.next();
    if (type == "list") {
      const std::string_view count = words.next();
      property.count_type = scalar_type(count);
      if (!property.count_type || !is_integer(*property.count_type)) {
        return wrong("length of list " + in_quotes(count) + ": must be an integer type as uchar or int");
      }
      type = words.next();
    }
    const auto known = scalar_type(type);
    property.name = words.next();
    if (!known || property.name.empty()) {
      return wrong("property " + in_quotes(type) + " " + in_quotes(property.name) +
                   ": must be a type (char uchar short ushort int uint float double) and a name");
    }
    property.type = *known;
    if (header_.elements.empty() || header_.elements.back().properties.size() == kMostProperties) {
      return wrong(header_.elements.empty() ? "a property before any element"
                                            : "more than " + std::to_string(kMostProperties) + " properties");
    }
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  /// Each value takes its bytes, in ascii at least one and a blank.
  Result<void> check_size() const {
    std::uint64_t left = rest_.size() + 1;
    for (const PlyElement& element : header_.elements) {
      std::uint64_t least = 0;
      for (const PlyProperty& property : element.properties) {
        least += header_.format == PlyFormat::ascii ? 2 : bytes_of(property.count_type.value_or(property.type));
      }
      if (element.count > 0 && (least == 0 || element.count > left / least)) {
        return wrong("element " + in_quotes(element.name) + " " + std::to_string(element.count) +
                     (least == 0 ? ": has no properties"
                                 : ": does not fit into the " + std::to_string(rest_.size()) +
                                       " bytes after the header; is the file cut?"));
      }
      left -= element.count * least;
    }
    return {};
  }

  std::string_view rest_;
  std::size_t size_;
  const std::string& name_;
  PlyHeader header_;
};

}  // namespace

Result<PlyHeader> parse_ply_header(std::string_view bytes, const std::string& name) {
  return PlyHeaderReader(bytes, name).read();
}

}  // namespace gravure
