// Any bytes are points within the stated range, with triangles between them, or an Error.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gravure/formats/points.hpp"

namespace {

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_file(const gravure::PointFile& file) {
  const auto& points = file.points.points_mm;
  require(!points.empty() && (file.points.normals.empty() || file.points.normals.size() == points.size()));
  for (const gravure::Point3& point : points) {
    for (const double value : point) {
      require(std::abs(value) <= gravure::kMostCoordinateMm);
    }
  }
  for (const gravure::Point3& normal : file.points.normals) {
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    require(length == 0 || std::abs(length - 1) < 1e-12);
  }
  for (const auto& [a, b, c] : file.triangles) {
    require(a < points.size() && b < points.size() && c < points.size() && a != b && b != c && c != a);
  }
}

void check_error(const gravure::Error& error) {
  require(error.code == gravure::ErrorCode::bad_file && error.message.substr(0, 4) == "fuzz");
  for (const char c : error.message) {
    require(static_cast<unsigned char>(c) >= 0x20U);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto file = gravure::parse_points(bytes, gravure::PointKind::GRAVURE_POINT_KIND, "fuzz");
  file ? check_file(file.value()) : check_error(file.error());
  return 0;
}
