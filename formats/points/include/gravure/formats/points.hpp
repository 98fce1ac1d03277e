#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/point_set.hpp"

namespace gravure {

enum class PointKind : std::uint8_t { ply, stl, pcd, text };  ///< text: .xyz, .txt, .csv, .asc

inline constexpr std::size_t kMostPointBytes = std::size_t{1} << 30;
inline constexpr double kMostCoordinateMm = 1e9;  ///< beyond, squares of distances lose what a laser can see

/// What a file of points or triangles holds.
struct PointFile {
  PointSet points;                                      ///< those of a mesh are its vertices
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< empty for a cloud; polygons are cut as fans
  std::int64_t dropped_points = 0;     ///< with a coordinate that is no finite number (scanners mark no echo so)
  std::string first_dropped;           ///< "line 3" of a text, "point 2" of other kinds, counted from 0
  std::int64_t dropped_triangles = 0;  ///< with fewer than 3 different corners, or with a dropped one

  void add_dropped(std::string where) { first_dropped = dropped_points++ == 0 ? std::move(where) : first_dropped; }
};

/// Reads PLY (ascii, binary of both byte orders), STL (ascii, binary; equal vertices become one), PCD (ascii, binary,
/// binary_compressed) or text (x y z [nx ny nz] a line). `name` stands in messages. bad_file names line or byte, the
/// value and what is allowed; sizes are held against the bytes there before memory is taken.
Result<PointFile> parse_points(std::string_view bytes, PointKind kind, const std::string& name);

/// Reads a file of at most kMostPointBytes, of the kind that its suffix says (any case). Fails as parse_points() and
/// read_file() (core) do; bad_argument for another suffix.
Result<PointFile> read_point_file(const std::string& path);

/// The same, of a file that must hold triangles.
Result<TriangleMesh> read_triangle_mesh(const std::string& path);

}  // namespace gravure
