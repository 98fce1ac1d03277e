#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <unordered_map>

#include "point_text.hpp"
#include "readers.hpp"
#include "scalar_type.hpp"

namespace gravure {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kTriangleBytes = 50;

struct PointHash {
  std::size_t operator()(const Point3& point) const noexcept {
    std::uint64_t hash = 0;
    for (const double value : point) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29U;
    }
    return hash;
  }
};

/// Triangles whose corners are given one after the other; equal corners become one vertex.
class Welder {
 public:
  void corner(Point3 point) {
    for (double& value : point) {
      value += 0.0;  // -0 and 0 are one place
    }
    const auto next = static_cast<std::uint32_t>(file_.points.points_mm.size());
    const auto [place, is_new] = vertices_.try_emplace(point, next);
    if (is_new) {
      file_.points.points_mm.push_back(point);
    }
    triangle_[corners_++] = place->second;
    if (corners_ == 3) {
      file_.triangles.push_back(triangle_);
      corners_ = 0;
    }
  }
  PointFile take() { return std::move(file_); }

 private:
  PointFile file_;
  std::unordered_map<Point3, std::uint32_t, PointHash> vertices_;
  std::array<std::uint32_t, 3> triangle_{};
  std::size_t corners_ = 0;
};

std::uint64_t count_in(std::string_view bytes) {
  return bytes.size() < kHeaderBytes
             ? 0
             : static_cast<std::uint64_t>(scalar_at(bytes.data() + kHeaderBytes - 4, ScalarType::u32, false));
}

PointFile parse_binary(std::string_view bytes) {
  Welder welder;
  for (std::size_t at = kHeaderBytes; at < bytes.size(); at += kTriangleBytes) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* from = bytes.data() + at + 12 * (corner + 1);  // the normal stands first: the corners say it better
      welder.corner({scalar_at(from, ScalarType::f32, false), scalar_at(from + 4, ScalarType::f32, false),
                     scalar_at(from + 8, ScalarType::f32, false)});
    }
  }
  return welder.take();
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

class AsciiReader {
 public:
  AsciiReader(std::string_view text, const std::string& name) : words_(text), name_(name) {}

  Result<PointFile> read() {
    while (true) {
      const std::string_view word = words_.next();
      if (word.empty()) {
        return inside_ ? Result<PointFile>(wrong(word, "facet or endsolid")) : welder_.take();
      }
      if (same_word(word, inside_ ? "endsolid" : "solid")) {
        inside_ = !inside_;
        words_.skip_line();  // a name, of any words
      } else if (inside_ && same_word(word, "facet")) {
        GRAVURE_CHECK(facet());
      } else {
        return wrong(word, inside_ ? "facet or endsolid" : "solid");
      }
    }
  }

 private:
  Error wrong(std::string_view word, const std::string& wanted) const {
    return bad_line(name_, words_.line(),
                    (word.empty() ? "the file ends here" : in_quotes(word)) + ": must be " + wanted);
  }
  Result<void> expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    return same_word(word, wanted) ? Result<void>() : wrong(word, std::string(wanted));
  }
  Result<Point3> numbers() {
    Point3 point{};
    for (double& value : point) {
      const std::string_view word = words_.next();
      if (!to_number(word, value)) {
        return wrong(word, "a number");
      }
    }
    return point;
  }
  Result<void> facet() {
    GRAVURE_CHECK(expect("normal"));
    GRAVURE_CHECK(numbers());
    GRAVURE_CHECK(expect("outer"));
    GRAVURE_CHECK(expect("loop"));
    for (int corner = 0; corner < 3; ++corner) {
      GRAVURE_CHECK(expect("vertex"));
      GRAVURE_TRY(const Point3 point, numbers());
      welder_.corner(point);
    }
    GRAVURE_CHECK(expect("endloop"));
    return expect("endfacet");
  }

  TextWords words_;
  const std::string& name_;
  Welder welder_;
  bool inside_ = false;
};

}  // namespace

Result<PointFile> parse_stl(std::string_view bytes, const std::string& name) {
  // Binary files may begin with "solid" too: the size decides.
  if (bytes.size() >= kHeaderBytes && (bytes.size() - kHeaderBytes) / kTriangleBytes == count_in(bytes) &&
      (bytes.size() - kHeaderBytes) % kTriangleBytes == 0) {
    return parse_binary(bytes);
  }
  const std::string_view text = without_byte_order_mark(bytes);
  if (same_word(TextWords(text).next(), "solid")) {
    return AsciiReader(text, name).read();
  }
  if (bytes.size() < kHeaderBytes) {
    return Error{ErrorCode::bad_file, name + ": " + std::to_string(bytes.size()) +
                                          " bytes: no STL; it begins with \"solid\" or has 84 bytes and more"};
  }
  return bad_byte(name, kHeaderBytes - 4,
                  std::to_string(count_in(bytes)) + " triangles: the file would have " +
                      std::to_string(kHeaderBytes + kTriangleBytes * count_in(bytes)) + " bytes and has " +
                      std::to_string(bytes.size()) + "; is it cut, or no binary STL?");
}

}  // namespace gravure
