#include "check_path.hpp"

#include <algorithm>
#include <string>

namespace gravure::plan_json {
namespace {

constexpr std::size_t kMostText = std::size_t{1} << 16U;
constexpr std::int64_t kMostInstants = std::int64_t{1} << 40U;

void check_limit(const std::string& key, const std::optional<Rational>& value, Complaint& complaint) {
  if (value) {
    complaint.positive(key, *value);
  }
}

void check_axes(const PathPlan& path, Complaint& complaint) {
  for (std::size_t i = 0; i < path.axes.size(); ++i) {
    const PathAxisPlan& axis = path.axes[i];
    const std::string key = "path.axes." + std::string(kPathAxes[i]) + ".";
    complaint.positive(key + "counts", axis.counts_per_unit);
    check_limit(key + "max_speed", axis.limits.max_speed, complaint);
    check_limit(key + "max_acceleration", axis.limits.max_acceleration, complaint);
    check_limit(key + "max_jerk", axis.limits.max_jerk, complaint);
    complaint.unless(!axis.least || !axis.most || *axis.least < *axis.most, key + "least", "must be below the most");
  }
}

}  // namespace

void check_path(const Plan& plan, Complaint& complaint) {
  const PathPlan& path = *plan.path;
  const LinePlan& line = plan.line;
  complaint.unless(!plan.spin && !plan.bands && !plan.scanner, "path", "goes with no spin, bands or scanner");
  complaint.unless(!line.bidirectional, "line.bidirectional", "must be false on a path");
  complaint.equal("line.pixels", line.pixels, line.slots);
  complaint.equal("job.revolutions", plan.job.revolutions, 1);
  complaint.unless(plan.rotary.lines_per_revolution < kMostInstants, "path.periods", "are more than 2^40");
  complaint.equal("path.ticks", plan.rotary.ticks_per_revolution,
                  Integer(line.ticks) * plan.rotary.lines_per_revolution);
  complaint.equal("job.ticks", plan.job.ticks, plan.rotary.ticks_per_revolution);
  complaint.equal("job.duration_s", plan.job.duration_s, ratio(plan.job.ticks, plan.clock.fpga_hz));
  complaint.positive("path.along_counts_per_mm", path.along_counts_per_mm);
  complaint.unless(path.pulses >= 0 && path.pulses < kMostInstants, "path.pulses", "must be 0 to 2^40 - 1");
  complaint.unless(path.targets >= 0 && path.targets != 1 && path.targets < kMostInstants, "path.targets",
                   "must be none, or 2 to 2^40 - 1");
  check_axes(path, complaint);
  if (path.picture) {
    constexpr std::int64_t kMostSide = std::int64_t{1} << 31U;
    const auto side = [](std::int64_t value) { return value >= 1 && value < kMostSide; };
    complaint.unless(side(path.picture->width) && side(path.picture->height), "path.picture",
                     "must have sides of 1 to 2^31 - 1");
    complaint.equal("path.pulses", path.pulses, Integer(path.picture->width) * path.picture->height);
  }
  check_limit("path.max_focus_offset_um", path.max_focus_offset_um, complaint);
  check_limit("path.max_incidence_deg", path.max_incidence_deg, complaint);
  check_limit("path.max_displacement_mm", path.max_displacement_mm, complaint);
  check_limit("path.max_landing_um", path.max_landing_um, complaint);
  complaint.unless(path.machine == "texturing" || path.machine == "post_processor", "path.machine",
                   "must be \"texturing\" or \"post_processor\"");
  complaint.unless(std::max(path.surface.size(), path.texture.size()) <= kMostText, "path.surface",
                   "or texture is longer than " + std::to_string(kMostText) + " bytes");
}

}  // namespace gravure::plan_json
