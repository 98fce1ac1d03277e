#pragma once

#include <optional>
#include <string>

#include "gravure/core/plan.hpp"
#include "gravure/formats/zones_job.hpp"
#include "gravure/zones/optics.hpp"
#include "gravure/zones/plan_zones.hpp"

namespace gravure::cli {

/// What a job's [beam] comes to.
struct ZonesOptics {
  zones::Spot spot;
  double over_threshold = 0;  ///< 0: no threshold is known
};

/// Where the files that a job names lie; "" for those it does not.
struct ZonesFiles {
  std::string contours;
  std::string transform;
  std::string machine;
};

/// A zones job with the files it names.
struct LoadedZonesJob {
  ZonesJob job;
  ZonesFiles files;
  zones::ZonePlanRequest request;
  std::optional<ZonesOptics> optics;
  std::string machine;  ///< PathPlan::machine
};

/// Reads a job, its contours where the part is, and its machine. Fails as parse_zones_job(), load_contours() and
/// read_machine() do; bad_argument for a machine whose axes are not those a path program knows (both signs of
/// docs/kinematics.md, telecentric), out_of_range where the beam ablates nothing or the mark speed needs more pulses
/// than the laser gives. Every error begins with a place in the job.
Result<LoadedZonesJob> load_zones_job(const std::string& path);
/// The same of a job that has been read, and whose files lie elsewhere now.
Result<LoadedZonesJob> load_zones_job(ZonesJob job, ZonesFiles files);

}  // namespace gravure::cli
