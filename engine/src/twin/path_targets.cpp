#include "path_targets.hpp"

#include <algorithm>

namespace gravure {
namespace {

constexpr std::int64_t kTargets = 4096;

kinematics::Vector3 vector_of(const std::array<double, 3>& parts) {
  return {parts[0], parts[1], parts[2]};
}

}  // namespace

TargetWalk::TargetWalk(LineSource& program, std::span<const PathTarget> given)
    : program_(program),
      given_(given),
      total_(given.empty() ? program.header().plan.path->targets : static_cast<std::int64_t>(given.size())) {}

Result<PathTarget> TargetWalk::point(std::int64_t index) {
  if (!given_.empty()) {
    return given_[static_cast<std::size_t>(index)];
  }
  if (block_.empty() || index < block_first_ || index >= block_first_ + static_cast<std::int64_t>(block_.size())) {
    block_first_ = index;
    block_.resize(static_cast<std::size_t>(std::min(kTargets, total_ - index)));
    GRAVURE_CHECK(program_.read_targets(block_first_, block_));
  }
  return block_[static_cast<std::size_t>(index - block_first_)];
}

Result<std::optional<WantedPoint>> TargetWalk::at(double along_mm) {
  constexpr double kRounding_mm = 1e-6;  // mm of path
  while (at_ + 2 < total_) {
    GRAVURE_TRY(const PathTarget next, point(at_ + 1));
    if (next.along_mm >= along_mm) {
      break;
    }
    ++at_;
  }
  if (total_ < 2) {
    return std::optional<WantedPoint>();
  }
  GRAVURE_TRY(const PathTarget begin, point(at_));
  GRAVURE_TRY(const PathTarget end, point(at_ + 1));
  if (along_mm < begin.along_mm - kRounding_mm || along_mm > end.along_mm + kRounding_mm) {
    return std::optional<WantedPoint>();
  }
  const double length = end.along_mm - begin.along_mm;
  const double share = length > 0 ? (along_mm - begin.along_mm) / length : 0;
  WantedPoint wanted;
  wanted.position_mm = (1 - share) * vector_of(begin.position_mm) + share * vector_of(end.position_mm);
  wanted.normal = ((1 - share) * vector_of(begin.normal) + share * vector_of(end.normal)).normalized();
  return std::optional(wanted);
}

}  // namespace gravure
