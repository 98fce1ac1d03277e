#include "gravure/zones/zone_watch.hpp"

namespace gravure::zones {

void ZoneWatch::tell(ZonePart part, std::size_t done, std::size_t total) const {
  if (progress == nullptr || total == 0) {
    return;
  }
  constexpr std::int64_t kSteps = 100;  // of a part
  const auto within = static_cast<std::int64_t>(static_cast<std::size_t>(kSteps) * done / total);
  progress->update(kSteps * static_cast<std::int64_t>(part) + within,
                   kSteps * static_cast<std::int64_t>(ZonePart::count));
}

Result<void> ZoneWatch::go_on() const {
  if (stopped()) {
    return Error{ErrorCode::cancelled, "stopped before the zones were planned"};
  }
  return {};
}

}  // namespace gravure::zones
