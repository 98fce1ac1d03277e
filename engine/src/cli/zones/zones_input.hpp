#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gravure/core/contour.hpp"
#include "gravure/core/error.hpp"
#include "gravure/kinematics/machine.hpp"

namespace gravure::cli {

/// The contours of a file. Warns of what was read otherwise than it stands there.
Result<std::vector<Contour>> load_contours(const std::string& path);

/// Moves the contours of `file` to where the part is: by the similarity in file `transform`. Warns of a registration
/// that was not sure; bad_argument where it has moved this very file already.
Result<void> move_contours(const std::string& transform, const std::string& file, std::vector<Contour>& contours);

/// The machine of a file, or the example machine; `field_mm`, where given, is its scan field.
Result<kinematics::Machine> load_zones_machine(const std::string& path, std::optional<double> field_mm);

}  // namespace gravure::cli
