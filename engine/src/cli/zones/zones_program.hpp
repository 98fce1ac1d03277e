#pragma once

#include <memory>
#include <string>

#include "gravure/pipeline/compile_path.hpp"
#include "gravure/zones/zone_motion.hpp"
#include "zones/zones_job_loader.hpp"

namespace gravure::cli {

/// A zones job laid out: zones and layers, the motion that marks them, its pulses, and the plan of the program.
struct ZonesProgram {
  zones::ZonePlan zones;
  std::unique_ptr<zones::ZoneMotion> motion;
  PathPulses pulses;
  Plan plan;
};

/// From what a job and its files say alone. Fails as plan_zones(), ZoneMotion and make_path_plan() do; out_of_range
/// where the zones break their limits. What is one key's doing is said with its place in the job.
Result<ZonesProgram> lay_out_zones(const LoadedZonesJob& loaded);

/// "; 1 of them because ...": zones that travel alone makes more; empty where none.
std::string travel_text(const zones::ZonePlan& plan);

/// Writes the program to `output`.
Result<CompiledPath> compile_zones_program(const LoadedZonesJob& loaded, const ZonesProgram& made,
                                           const std::string& output);

}  // namespace gravure::cli
