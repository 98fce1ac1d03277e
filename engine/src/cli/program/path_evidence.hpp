#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gravure/core/program.hpp"

namespace gravure::cli {

/// What a program that follows a path can be held against beside itself.
struct PathEvidence {
  struct Wanted {
    std::vector<PathTarget> targets;
    PathPulses pulses;
  };
  std::optional<Wanted> wanted;         ///< what the job asks for, where that can be found out
  std::vector<std::string> violations;  ///< the program is not what its job leads to
  std::vector<std::string> notes;       ///< sources that are not there or not the same
};

/// Makes what a program's job asks for anew from the job in it and its sources, which are sought at the job's paths or
/// below `folder`. Freeform: pulses, wanted points and plan; the motion is not reckoned again. Zones: all of it, and
/// compared with what the program at `path` stores.
Result<PathEvidence> evidence_of(LineSource& program, const std::string& path, const std::string& folder);

}  // namespace gravure::cli
