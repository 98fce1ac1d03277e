#include "gravure/formats/points.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "gravure/core/file_output.hpp"
#include "readers.hpp"

namespace gravure {
namespace {

bool is_finite(const Point3& point) noexcept {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

/// Of length 1, or 0 0 0 where there is no direction in it.
Point3 unit_normal(const Point3& normal) noexcept {
  const double largest = std::max({std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])});
  if (!is_finite(normal) || largest < 1e-30) {
    return {0, 0, 0};
  }
  const Point3 scaled{normal[0] / largest, normal[1] / largest, normal[2] / largest};
  const double length = std::sqrt(scaled[0] * scaled[0] + scaled[1] * scaled[1] + scaled[2] * scaled[2]);
  return {scaled[0] / length, scaled[1] / length, scaled[2] / length};
}

/// "1e+308": no digits that say nothing.
std::string shortest_text(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return {digits, end};
}

Result<void> check_range(const PointSet& points, const std::string& name) {
  for (std::size_t i = 0; i < points.points_mm.size(); ++i) {
    for (const double value : points.points_mm[i]) {
      if (std::isfinite(value) && std::abs(value) > kMostCoordinateMm) {
        return Error{ErrorCode::bad_file, name + ": point " + std::to_string(i) + ": coordinate " +
                                              shortest_text(value) +
                                              " mm: must be within 1e9 mm of 0; is the file in another unit?"};
      }
    }
  }
  return {};
}

/// Takes out the points that are no finite numbers; gives the new index of each.
std::vector<std::uint32_t> drop_points(PointFile& file) {
  constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();
  PointSet& set = file.points;
  std::vector<std::uint32_t> now(set.points_mm.size(), kDropped);
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < set.points_mm.size(); ++i) {
    if (!is_finite(set.points_mm[i])) {
      file.add_dropped("point " + std::to_string(i));
      continue;
    }
    now[i] = kept;
    set.points_mm[kept] = set.points_mm[i];
    if (!set.normals.empty()) {
      set.normals[kept] = unit_normal(set.normals[i]);
    }
    ++kept;
  }
  set.points_mm.resize(kept);
  if (!set.normals.empty()) {
    set.normals.resize(kept);
  }
  return now;
}

void drop_triangles(PointFile& file, const std::vector<std::uint32_t>& now) {
  const auto kept = std::remove_if(file.triangles.begin(), file.triangles.end(), [&](auto& triangle) {
    for (std::uint32_t& corner : triangle) {
      corner = now[corner];
    }
    const auto [a, b, c] = triangle;
    constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();
    return a == b || b == c || c == a || a == kDropped || b == kDropped || c == kDropped;
  });
  file.dropped_triangles += std::distance(kept, file.triangles.end());
  file.triangles.erase(kept, file.triangles.end());
}

Result<PointFile> parse_kind(std::string_view bytes, PointKind kind, const std::string& name) {
  switch (kind) {
    case PointKind::ply:
      return parse_ply(bytes, name);
    case PointKind::stl:
      return parse_stl(bytes, name);
    case PointKind::pcd:
      return parse_pcd(bytes, name);
    case PointKind::text:
      break;
  }
  return parse_point_text(bytes, name);
}

Result<PointKind> kind_of(const std::string& path) {
  constexpr std::pair<std::string_view, PointKind> kSuffixes[] = {
      {".ply", PointKind::ply},  {".stl", PointKind::stl},  {".pcd", PointKind::pcd}, {".xyz", PointKind::text},
      {".csv", PointKind::text}, {".txt", PointKind::text}, {".asc", PointKind::text}};
  std::string end = path.substr(path.size() - std::min<std::size_t>(4, path.size()));
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [suffix, kind] : kSuffixes) {
    if (end == suffix) {
      return kind;
    }
  }
  return Error{ErrorCode::bad_argument,
               path + ": what kind of points? The name must end in .ply, .stl, .pcd, .xyz, .txt, .asc or .csv"};
}

}  // namespace

Result<PointFile> parse_points(std::string_view bytes, PointKind kind, const std::string& name) {
  GRAVURE_TRY(PointFile file, parse_kind(bytes, kind, name));
  GRAVURE_CHECK(check_range(file.points, name));
  drop_triangles(file, drop_points(file));
  if (kind == PointKind::stl && file.triangles.empty()) {
    return Error{ErrorCode::bad_file,
                 name + ": no triangles" +
                     (file.dropped_triangles > 0
                          ? ": all " + std::to_string(file.dropped_triangles) + " have no area or no finite corners"
                          : std::string()) +
                     ": an STL must have one or more"};
  }
  if (file.points.points_mm.empty()) {
    return Error{ErrorCode::bad_file, name + ": no points" +
                                          (file.dropped_points > 0 ? ": all " + std::to_string(file.dropped_points) +
                                                                         " have coordinates that are no finite numbers"
                                                                   : std::string())};
  }
  return file;
}

Result<PointFile> read_point_file(const std::string& path) {
  GRAVURE_TRY(const PointKind kind, kind_of(path));
  GRAVURE_TRY(const std::string bytes, read_file(path, kMostPointBytes));
  return parse_points(bytes, kind, path);
}

Result<TriangleMesh> read_triangle_mesh(const std::string& path) {
  GRAVURE_TRY(PointFile file, read_point_file(path));
  if (file.triangles.empty()) {
    return Error{ErrorCode::bad_file, path + ": points but no triangles: give a mesh (STL, or PLY with faces)"};
  }
  return TriangleMesh{std::move(file.points.points_mm), std::move(file.triangles)};
}

}  // namespace gravure
