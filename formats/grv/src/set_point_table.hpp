#pragma once

#include <hdf5.h>

#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"

namespace gravure::grv {

/// /microvectors: a row for each way that lines run. Called within an Hdf5Session, like the rest of header_io.
Result<void> write_set_points(hid_t file, const std::vector<LineSetPoints>& lines);

/// None where the file has none. Fails with bad_file where the rows are not those of the plan's lines.
Result<std::vector<LineSetPoints>> read_set_points(hid_t file, const Plan& plan);

/// All lines of the plan, each with a set-point for each microvector, or none; `code` is that of the error.
Result<void> check_set_points(const std::vector<LineSetPoints>& lines, const Plan& plan, ErrorCode code);

}  // namespace gravure::grv
