#pragma once

#include <span>

#include "gravure/core/path_motion.hpp"
#include "gravure/core/program.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/pipeline/path_slots.hpp"

namespace gravure {

struct CompiledPath {
  ProgramHeader header;
  PathSpacing spacing;
};

/// A motion along a path and its pulses -> program, in one streaming pass: set-points as integers of the plan's counts,
/// a line of slots for each period, and the wanted points as they are. `header.plan` is that of make_path_plan() for
/// this motion; its one layer, the table of revolutions and the fired pixels are filled in, and the sink is finished.
/// Memory does not grow with the motion. Fails with bad_argument where plan and motion do not fit, where a set-point is
/// no number or beyond 2^62 counts, where the path covered shrinks, or as PathSlots does; cancelled; or what motion and
/// sink say.
Result<CompiledPath> compile_path(ProgramHeader header, const PathMotion& motion, const PathPulses& pulses,
                                  std::span<const PathTarget> targets, LineSink& sink, CancelToken* cancel = nullptr,
                                  Progress* progress = nullptr);

}  // namespace gravure
