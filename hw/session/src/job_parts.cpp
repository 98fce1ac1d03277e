#include "gravure/session/job_parts.hpp"

#include <fmt/format.h>

namespace gravure::session {
namespace {

std::string to_do_before(const Plan& plan, std::int64_t revolution) {
  const std::int64_t each = revolutions_per_band(plan);
  if (!plan.bands || revolution == 0 || revolution % each != 0) {
    return {};
  }
  const std::int64_t band = revolution / each;
  return fmt::format("band {} of {}: move the stage along the axis to {:.6f} mm from the place of band 0", band,
                     plan.bands->count, to_double(Rational(band) * plan.bands->step_mm));
}

}  // namespace

std::vector<JobPart> job_parts(const Plan& plan) {
  const std::int64_t each = plan.mode == Mode::flat ? 1 : revolutions_per_band(plan);
  std::vector<JobPart> parts;
  for (std::int64_t revolution = 0; revolution < plan.job.revolutions; revolution += each) {
    const std::int64_t lines = plan.rotary.lines_per_revolution;
    const bool backward = plan.mode == Mode::flat && revolution % revolutions_per_band(plan) % 2 != 0;
    parts.push_back({revolution * lines, (revolution + each) * lines, backward, to_do_before(plan, revolution)});
  }
  return parts;
}

std::size_t part_of(const std::vector<JobPart>& parts, std::int64_t line) {
  std::size_t at = 0;
  while (at + 1 < parts.size() && line >= parts[at].end_line) {
    ++at;
  }
  return at;
}

std::string line_text(const Plan& plan, std::int64_t line) {
  const std::int64_t lines = plan.rotary.lines_per_revolution;
  return fmt::format("{} {}, line {}", plan.mode == Mode::flat ? "pass" : "revolution", line / lines, line % lines);
}

}  // namespace gravure::session
