#include <array>
#include <cmath>

#include "ply_header.hpp"
#include "point_text.hpp"
#include "readers.hpp"

namespace gravure {
namespace {

/// The values after the header, one after the other, from text or from bytes.
class Values {
 public:
  Values(const PlyHeader& header, std::string_view bytes, const std::string& name)
      : format_(header.format),
        bytes_(bytes),
        at_(header.bytes),
        words_(bytes.substr(header.bytes), header.lines + 1),
        name_(name) {}

  Result<double> take(ScalarType type, const PlyElement& element, std::uint64_t row, const std::string& property) {
    if (format_ == PlyFormat::ascii) {
      double value = 0;
      const std::string_view word = words_.next();
      return to_number(word, value)
                 ? Result<double>(value)
                 : wrong(word.empty() ? "the file ends" : in_quotes(word) + " is no number", element, row, property);
    }
    const std::size_t size = bytes_of(type);
    if (bytes_.size() - at_ < size) {
      return wrong("the file ends", element, row, property);
    }
    const double value = scalar_at(bytes_.data() + at_, type, format_ == PlyFormat::big_endian);
    at_ += size;
    return value;
  }

  Error wrong(const std::string& what, const PlyElement& element, std::uint64_t row,
              const std::string& property) const {
    const std::string where = what + ": must be " + in_quotes(property) + " of " + in_quotes(element.name) + " " +
                              std::to_string(row) + " of " + std::to_string(element.count);
    return format_ == PlyFormat::ascii ? bad_line(name_, words_.line(), where) : bad_byte(name_, at_, where);
  }

 private:
  PlyFormat format_;
  std::string_view bytes_;
  std::size_t at_;
  TextWords words_;
  const std::string& name_;
};

/// Where x y z nx ny nz stand among the properties of a vertex.
class VertexColumns {
 public:
  static constexpr std::size_t kNone = ~std::size_t{0};
  explicit VertexColumns(const PlyElement& element) {
    constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
    column_.fill(kNone);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (element.properties[p].name == kNames[i] && !element.properties[p].count_type) {
          column_[i] = p;
        }
      }
    }
  }
  bool has_points() const noexcept { return column_[0] != kNone && column_[1] != kNone && column_[2] != kNone; }
  bool has_normals() const noexcept { return column_[3] != kNone && column_[4] != kNone && column_[5] != kNone; }
  Point3 of(const std::vector<double>& row, std::size_t first) const {
    return {row[column_[first]], row[column_[first + 1]], row[column_[first + 2]]};
  }

 private:
  std::array<std::size_t, 6> column_{};
};

class PlyReader {
 public:
  PlyReader(const PlyHeader& header, std::string_view bytes, const std::string& name)
      : header_(header), values_(header, bytes, name), name_(name) {}

  Result<PointFile> read() {
    for (const PlyElement& element : header_.elements) {
      vertices_ = element.name == "vertex" ? element.count : vertices_;
    }
    for (const PlyElement& element : header_.elements) {
      GRAVURE_CHECK(element.name == "vertex" ? read_vertices(element)
                    : element.name == "face" ? read_faces(element)
                                             : skip(element));
    }
    if (file_.points.points_mm.size() != vertices_) {
      return Error{ErrorCode::bad_file, name_ + ": more than one element \"vertex\""};
    }
    return std::move(file_);
  }

 private:
  Result<std::uint64_t> list_length(const PlyProperty& property, const PlyElement& element, std::uint64_t row) {
    GRAVURE_TRY(const double length, values_.take(*property.count_type, element, row, property.name));
    if (!(length >= 0 && length < 4294967296.0) || length != std::floor(length)) {
      return values_.wrong("a list of length " + std::to_string(length), element, row, property.name);
    }
    return static_cast<std::uint64_t>(length);
  }

  Result<double> pass(const PlyProperty& property, const PlyElement& element, std::uint64_t row) {
    if (!property.count_type) {
      return values_.take(property.type, element, row, property.name);
    }
    GRAVURE_TRY(const std::uint64_t length, list_length(property, element, row));
    for (std::uint64_t i = 0; i < length; ++i) {
      GRAVURE_CHECK(values_.take(property.type, element, row, property.name));
    }
    return 0.0;
  }

  Result<void> skip(const PlyElement& element) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (const PlyProperty& property : element.properties) {
        GRAVURE_CHECK(pass(property, element, row));
      }
    }
    return {};
  }

  Result<void> read_vertices(const PlyElement& element) {
    const VertexColumns columns(element);
    if (!columns.has_points()) {
      return Error{ErrorCode::bad_file, name_ + ": element \"vertex\": must have the properties x, y and z"};
    }
    std::vector<double> values(element.properties.size());
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (std::size_t p = 0; p < values.size(); ++p) {
        GRAVURE_TRY(values[p], pass(element.properties[p], element, row));
      }
      file_.points.points_mm.push_back(columns.of(values, 0));
      if (columns.has_normals()) {
        file_.points.normals.push_back(columns.of(values, 3));
      }
    }
    return {};
  }

  Result<void> read_faces(const PlyElement& element) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (const PlyProperty& property : element.properties) {
        const bool corners =
            property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
        if (corners) {
          GRAVURE_CHECK(read_polygon(property, element, row));
        } else {
          GRAVURE_CHECK(pass(property, element, row));
        }
      }
    }
    return {};
  }

  Result<void> read_polygon(const PlyProperty& property, const PlyElement& element, std::uint64_t row) {
    GRAVURE_TRY(const std::uint64_t length, list_length(property, element, row));
    file_.dropped_triangles += length < 3 ? 1 : 0;
    std::array<std::uint32_t, 3> triangle{};
    for (std::uint64_t i = 0; i < length; ++i) {
      GRAVURE_TRY(const double index, values_.take(property.type, element, row, property.name));
      if (!(index >= 0 && index < static_cast<double>(vertices_)) || index != std::floor(index)) {
        return values_.wrong("vertex " + std::to_string(index) + " (there are " + std::to_string(vertices_) + ")",
                             element, row, property.name);
      }
      triangle[i < 1 ? 0 : 2] = static_cast<std::uint32_t>(index);
      if (i >= 2) {
        file_.triangles.push_back(triangle);
      }
      triangle[1] = i < 1 ? triangle[1] : triangle[2];
    }
    return {};
  }

  const PlyHeader& header_;
  Values values_;
  const std::string& name_;
  std::uint64_t vertices_ = 0;
  PointFile file_;
};

}  // namespace

Result<PointFile> parse_ply(std::string_view bytes, const std::string& name) {
  GRAVURE_TRY(const PlyHeader header, parse_ply_header(bytes, name));
  return PlyReader(header, bytes, name).read();
}

}  // namespace gravure
