#pragma once

#include <span>
#include <string>
#include <vector>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"

namespace gravure {

/// How the rows of a path program differ from what compile_path() makes of this motion, these pulses and these wanted
/// points; nothing: they are the same. One sentence for the set-points, one for the wanted points and one for the
/// pulses, each with the number of those that differ and the first of them.
///
/// Set-points and wanted points may be 1e-9 mm or rad apart, for another mathematical library may round another way.
/// The slots that fire follow from the stored set-points by sums and products alone and must be the same, bit by bit;
/// they are not looked at where set-points or the numbers of rows differ. Memory does not grow with the program. Fails
/// with bad_argument where the program follows no path, cancelled, or with what program and motion say.
Result<std::vector<std::string>> compare_path(LineSource& program, const PathMotion& motion, const PathPulses& pulses,
                                              std::span<const PathTarget> targets, CancelToken* cancel = nullptr,
                                              Progress* progress = nullptr);

}  // namespace gravure
