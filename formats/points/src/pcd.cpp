#include <algorithm>
#include <array>
#include <optional>

#include "lzf.hpp"
#include "point_text.hpp"
#include "readers.hpp"
#include "scalar_type.hpp"

namespace gravure {
namespace {

constexpr std::size_t kMostFields = 256;
constexpr std::uint64_t kMostCount = 4096;
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 31U;

struct Field {
  std::string name;
  std::uint64_t size = 4;
  char type = 'F';
  std::uint64_t count = 1;
  std::uint64_t offset = 0;  ///< in a point, bytes
  std::uint64_t first = 0;   ///< value of a point, counted from 0
};

enum class PcdData : std::uint8_t { ascii, binary, compressed };

struct PcdHeader {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::uint64_t point_bytes = 0;
  std::uint64_t point_values = 0;
  PcdData data = PcdData::ascii;
  std::size_t bytes = 0;
  std::int64_t lines = 0;
};

std::optional<ScalarType> scalar_type(const Field& field) {
  constexpr std::string_view kKinds = "IUF";
  constexpr std::array<std::optional<ScalarType>, 12> kTypes{
      ScalarType::i8,  ScalarType::u8,  std::nullopt,    ScalarType::i16, ScalarType::u16, std::nullopt,
      ScalarType::i32, ScalarType::u32, ScalarType::f32, ScalarType::i64, ScalarType::u64, ScalarType::f64};
  const std::size_t kind = kKinds.find(field.type);
  const std::size_t power = field.size == 1 ? 0 : field.size == 2 ? 1 : field.size == 4 ? 2 : field.size == 8 ? 3 : 4;
  return kind == std::string_view::npos || power == 4 ? std::nullopt : kTypes[3 * power + kind];
}

class PcdHeaderReader {
 public:
  PcdHeaderReader(std::string_view bytes, const std::string& name) : rest_(bytes), size_(bytes.size()), name_(name) {}

  Result<PcdHeader> read() {
    rest_ = without_byte_order_mark(rest_);
    while (!rest_.empty()) {
      ++header_.lines;
      TextWords words(take_line(rest_));
      const std::string_view key = words.next();
      if (key.empty() || key.starts_with('#')) {
        continue;
      }
      GRAVURE_CHECK(line(key, words));
      if (key == "DATA") {
        header_.bytes = size_ - rest_.size();
        GRAVURE_CHECK(finish());
        return std::move(header_);
      }
    }
    return wrong("the file ends before a line DATA");
  }

 private:
  Error wrong(const std::string& what) const { return bad_line(name_, header_.lines, what); }

  Result<void> line(std::string_view key, TextWords& words) {
    if (key == "FIELDS" || key == "COLUMNS") {
      return fields(words);
    }
    if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      return per_field(key, words);
    }
    if (key == "POINTS" || key == "WIDTH" || key == "HEIGHT") {
      std::uint64_t& value = key == "POINTS" ? points_ : key == "WIDTH" ? width_ : height_;
      const std::string_view word = words.next();
      return to_count(word, value) && value < kMostPoints
                 ? Result<void>()
                 : wrong(std::string(key) + " " + in_quotes(word) + ": must be an integer from 0 to 2147483647");
    }
    if (key == "DATA") {
      return data(words.next());
    }
    return key == "VERSION" || key == "VIEWPOINT"
               ? Result<void>()
               : wrong(in_quotes(key) +
                       ": must be VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS "
                       "or DATA");
  }

  Result<void> fields(TextWords& words) {
    header_.fields.clear();
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      if (header_.fields.size() == kMostFields) {
        return wrong("more than " + std::to_string(kMostFields) + " fields");
      }
      header_.fields.emplace_back().name = word;
    }
    return {};
  }

  Result<void> per_field(std::string_view key, TextWords& words) {
    for (Field& field : header_.fields) {
      const std::string_view word = words.next();
      bool good = !word.empty();
      if (key == "TYPE") {
        field.type = good ? word[0] : '?';
      } else {
        std::uint64_t& value = key == "SIZE" ? field.size : field.count;
        good = to_count(word, value) && value <= kMostCount;
      }
      if (!good) {
        return wrong(std::string(key) + " " + in_quotes(word) + " of field " + in_quotes(field.name) + ": must be " +
                     (key == "TYPE" ? "I, U or F" : "an integer up to " + std::to_string(kMostCount)));
      }
    }
    return {};
  }

  Result<void> data(std::string_view word) {
    if (word != "ascii" && word != "binary" && word != "binary_compressed") {
      return wrong("DATA " + in_quotes(word) + ": must be ascii, binary or binary_compressed");
    }
    header_.data = word == "ascii" ? PcdData::ascii : word == "binary" ? PcdData::binary : PcdData::compressed;
    return {};
  }

  Result<void> finish() {
    for (Field& field : header_.fields) {
      field.offset = header_.point_bytes;
      field.first = header_.point_values;
      header_.point_bytes += field.size * field.count;
      header_.point_values += field.count;
      if (!scalar_type(field)) {
        return wrong("field " + in_quotes(field.name) + ": TYPE " + in_quotes({&field.type, 1}) + " of SIZE " +
                     std::to_string(field.size) + ": must be I or U of 1, 2, 4 or 8 bytes, or F of 4 or 8");
      }
    }
    header_.points = points_ != kNone ? points_ : width_ * height_;
    if (points_ == kNone && width_ == kNone) {
      return wrong("the header has no line POINTS (or WIDTH and HEIGHT)");
    }
    if (points_ != kNone && width_ != kNone && width_ * height_ != points_) {
      return wrong("POINTS " + std::to_string(points_) + ": must be WIDTH times HEIGHT, " + std::to_string(width_) +
                   " x " + std::to_string(height_));
    }
    if (header_.points >= kMostPoints) {
      return wrong(std::to_string(header_.points) + " points: must be fewer than " + std::to_string(kMostPoints));
    }
    const std::uint64_t least = header_.data == PcdData::ascii ? 2 * header_.point_values : header_.point_bytes;
    const bool packed = header_.data == PcdData::compressed;
    if (header_.points > 0 && (least == 0 || (!packed && header_.points > (rest_.size() + 1) / least))) {
      return wrong(std::to_string(header_.points) + " points of " + std::to_string(header_.point_values) +
                   " values: they do not fit into the " + std::to_string(rest_.size()) +
                   " bytes after the header; is the file cut?");
    }
    return {};
  }

  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  std::string_view rest_;
  std::size_t size_;
  const std::string& name_;
  PcdHeader header_;
  std::uint64_t points_ = kNone;
  std::uint64_t width_ = kNone;
  std::uint64_t height_ = 1;
};

/// x y z and, where all three are there, the normal.
struct Columns {
  std::array<std::optional<Field>, 6> field;
  bool points() const noexcept { return field[0] && field[1] && field[2]; }
  bool normals() const noexcept { return field[3] && field[4] && field[5]; }
};

Columns columns_of(const PcdHeader& header) {
  constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  Columns columns;
  for (const Field& field : header.fields) {
    const auto* const name = std::find(kNames.begin(), kNames.end(), field.name);
    if (name != kNames.end() && field.count > 0) {
      columns.field[static_cast<std::size_t>(name - kNames.begin())] = field;
    }
  }
  return columns;
}

template <class Value>
void append(PointFile& file, const Columns& columns, const Value& value) {
  file.points.points_mm.push_back({value(*columns.field[0]), value(*columns.field[1]), value(*columns.field[2])});
  if (columns.normals()) {
    file.points.normals.push_back({value(*columns.field[3]), value(*columns.field[4]), value(*columns.field[5])});
  }
}

Result<PointFile> read_ascii(const PcdHeader& header, const Columns& columns, std::string_view data,
                             const std::string& name) {
  TextWords words(data, header.lines + 1);
  PointFile file;
  std::vector<double> values(header.point_values);
  for (std::uint64_t i = 0; i < header.points; ++i) {
    for (double& value : values) {
      const std::string_view word = words.next();
      if (!to_number(word, value)) {
        return bad_line(name, words.line(),
                        (word.empty() ? "the file ends" : in_quotes(word) + " is no number") + " in point " +
                            std::to_string(i) + " of " + std::to_string(header.points));
      }
    }
    append(file, columns, [&](const Field& field) { return values[field.first]; });
  }
  return file;
}

Result<PointFile> read_compressed(const PcdHeader& header, const Columns& columns, std::string_view data,
                                  const std::string& name) {
  constexpr std::size_t kSizes = 8;
  if (data.size() < kSizes) {
    return bad_byte(name, header.bytes, "the file ends before the two sizes of the compressed data");
  }
  const auto packed = static_cast<std::uint64_t>(scalar_at(data.data(), ScalarType::u32, false));
  const auto plain = static_cast<std::uint64_t>(scalar_at(data.data() + 4, ScalarType::u32, false));
  if (packed > data.size() - kSizes || plain != header.points * header.point_bytes) {
    return bad_byte(name, header.bytes,
                    std::to_string(packed) + " compressed bytes that hold " + std::to_string(plain) + ": must be " +
                        std::to_string(header.points * header.point_bytes) + " out of at most " +
                        std::to_string(data.size() - kSizes));
  }
  const auto unpacked = lzf_unpacked(data.substr(kSizes, packed), plain);
  if (!unpacked) {
    return bad_byte(name, header.bytes + kSizes, unpacked.error().message);
  }
  PointFile file;
  for (std::uint64_t i = 0; i < header.points; ++i) {  // field after field, each for all points
    append(file, columns, [&](const Field& field) {
      const std::uint64_t at = field.offset * header.points + i * field.size * field.count;
      return scalar_at(unpacked.value().data() + at, *scalar_type(field), false);
    });
  }
  return file;
}

PointFile read_binary(const PcdHeader& header, const Columns& columns, std::string_view data) {
  PointFile file;
  for (std::uint64_t i = 0; i < header.points; ++i) {
    append(file, columns, [&](const Field& field) {
      return scalar_at(data.data() + i * header.point_bytes + field.offset, *scalar_type(field), false);
    });
  }
  return file;
}

}  // namespace

Result<PointFile> parse_pcd(std::string_view bytes, const std::string& name) {
  GRAVURE_TRY(const PcdHeader header, PcdHeaderReader(bytes, name).read());
  const Columns columns = columns_of(header);
  if (!columns.points()) {
    return Error{ErrorCode::bad_file, name + ": FIELDS must have x, y and z"};
  }
  const std::string_view data = bytes.substr(header.bytes);
  switch (header.data) {
    case PcdData::ascii:
      return read_ascii(header, columns, data, name);
    case PcdData::compressed:
      return read_compressed(header, columns, data, name);
    case PcdData::binary:
      break;
  }
  if (header.points * header.point_bytes > data.size()) {
    return bad_byte(name, header.bytes, "the file ends before the last point");
  }
  return read_binary(header, columns, data);
}

}  // namespace gravure
