#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gravure/core/contour.hpp"
#include "gravure/core/error.hpp"
#include "gravure/kinematics/machine.hpp"

namespace gravure::cli {

/// The contours of a file where the part is: moved by `transform` if there is one. Warns
/// of what was read otherwise than it stands there.
Result<std::vector<Contour>> load_contours(const std::string& path, const std::string& transform);

/// The machine of a file, or the example machine; `field_mm`, where given, is its scan field.
Result<kinematics::Machine> load_zones_machine(const std::string& path, std::optional<double> field_mm);

}  // namespace gravure::cli
