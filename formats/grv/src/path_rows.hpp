#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"

namespace gravure::grv {

/// Set-points and wanted points as rows of set_point_columns() and target_columns(), and back.
std::vector<std::int64_t> rows_of(std::span<const PathSetPoint> points, bool focus_axis);
void set_points_from(std::span<const std::int64_t> rows, bool focus_axis, std::span<PathSetPoint> out);
/// bad_argument for numbers beyond what a row holds, and for such as are none.
Result<std::vector<std::int64_t>> rows_of(std::span<const PathTarget> targets);
void targets_from(std::span<const std::int64_t> rows, std::span<PathTarget> out);

}  // namespace gravure::grv
