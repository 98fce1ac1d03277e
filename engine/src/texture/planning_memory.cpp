#include "gravure/texture/planning_memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gravure/core/units.hpp"

namespace gravure::texture {
namespace {

constexpr std::int64_t kBytesAPoint = 1000;
constexpr std::int64_t kOnce = 56 * kMiB;  // the program itself, blocks of motion

}  // namespace

std::int64_t planning_bytes(std::size_t points) noexcept {
  return kOnce + kBytesAPoint * static_cast<std::int64_t>(points);
}

Result<void> check_planning_memory(std::size_t points, std::int64_t most_bytes) {
  const std::int64_t needed = planning_bytes(points);
  if (most_bytes <= 0 || needed <= most_bytes) {
    return {};
  }
  return Error{
      ErrorCode::out_of_range,
      fmt::format("a path of {} points needs {} MiB of memory to be planned, allowed are {} MiB: that does for "
                  "{} points; take them further apart, a smaller texture or more memory",
                  points, whole_mib(needed), most_bytes / kMiB,
                  std::max<std::int64_t>(0, (most_bytes - kOnce) / kBytesAPoint))};
}

}  // namespace gravure::texture
