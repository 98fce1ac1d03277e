#pragma once

#include <string>
#include <string_view>

#include "gravure/formats/points.hpp"

namespace gravure {

// What the file says, points that are no finite numbers and normals of any length included.
Result<PointFile> parse_ply(std::string_view bytes, const std::string& name);
Result<PointFile> parse_stl(std::string_view bytes, const std::string& name);
Result<PointFile> parse_pcd(std::string_view bytes, const std::string& name);
Result<PointFile> parse_point_text(std::string_view bytes, const std::string& name);

}  // namespace gravure
