#include "gravure/fpga/synchro_events.hpp"

#include "control_bits.hpp"

// What SynchroEvents knows of the counters inside the blocks: for how many seed clocks each does nothing but count, and
// where it stands after some of them. All inputs stand still meanwhile.
namespace gravure::fpga {

std::uint64_t SynchroEvents::slots_still_for() const noexcept {
  const std::uint32_t control = board_.now_.settings.control;
  const SlotDivider& slots = board_.slots_;
  if (!board_.start_.slots_run((control & kRun) != 0, (control & kTimed) != 0)) {
    return kForEver;
  }
  if (slots.begins_ || board_.now_.reference.adjust) {
    return 0;
  }
  return slots.count_ < slots.length_ ? slots.length_ - slots.count_ + 1 : 1;
}

std::uint64_t SynchroEvents::start_still_for() const noexcept {
  const LineStart& start = board_.start_;
  const std::uint32_t first = board_.now_.settings.first_tick;
  if (start.arrives_) {
    return 0;
  }
  if (!start.counting_) {
    return kForEver;
  }
  return start.tick_ <= first ? first - start.tick_ : (std::uint64_t{1} << 32U) - start.tick_;
}

std::uint64_t SynchroEvents::schedule_still_for(const IncrementSchedule& schedule) const noexcept {
  if (!board_.now_.schedules_run) {
    return kForEver;
  }
  if (schedule.left_ > 1) {
    return schedule.left_ - 1;
  }
  return schedule.left_ == 0 && !schedule.list_.valid ? kForEver : 0;
}

std::uint64_t SynchroEvents::reference_still_for() const noexcept {
  const IndexReference& reference = board_.reference_;
  const std::uint32_t control = board_.now_.settings.control;
  if ((control & kReference) == 0 || (control & kRun) == 0) {
    return kForEver;
  }
  if (reference.wanted_ || reference.missing_ || reference.late_) {
    return 0;
  }
  const std::int64_t before_missing = reference.ahead_ + board_.now_.settings.index_window + 1;
  return !reference.out_.referenced ? kForEver : before_missing > 0 ? static_cast<std::uint64_t>(before_missing) : 0;
}

std::uint64_t SynchroEvents::host_still_for() const noexcept {
  if ((board_.now_.settings.control & kWatch) == 0) {
    return kForEver;
  }
  const std::uint32_t silent = board_.host_.silent_;
  const std::uint32_t limit = board_.now_.settings.silence_limit;
  return silent < limit ? limit - silent : board_.now_.host.expired ? kForEver : 0;
}

/// Seed clocks in which nothing but counters moves.
std::uint64_t SynchroEvents::still_for() const noexcept {
  if (still_ < kStillClocks || since_host_ < kHostClocks || in_.rst || in_.write || in_.in_valid ||
      board_.now_.settings.command != 0) {
    return 0;
  }
  const DirectionDelay& delay = board_.delay_;
  std::uint64_t clocks = delay.waiting_ ? delay.left_ - std::uint64_t{1} : kForEver;
  for (const std::uint64_t other :
       {slots_still_for(), start_still_for(), schedule_still_for(board_.schedules_[0]),
        schedule_still_for(board_.schedules_[1]), reference_still_for(), host_still_for()}) {
    clocks = std::min(clocks, other);
  }
  return clocks;
}

void SynchroEvents::jump(std::uint64_t seed_clocks) noexcept {
  const Settings::Outputs& settings = board_.now_.settings;
  const auto low = static_cast<std::uint32_t>(seed_clocks);  // of counters that stop a jump before they wrap
  if (SlotDivider& slots = board_.slots_; slots_still_for() != kForEver) {
    slots.begins_ = slots_still_for() == seed_clocks;
    slots.count_ = slots.begins_ ? 1 : slots.count_ + low;
    slots.length_ = slots.begins_ ? settings.seeds_per_slot : slots.length_;
  }
  if (LineStart& start = board_.start_; start.counting_) {
    start.tick_ += low;
    start.counting_ = start.tick_ != 0;
  }
  for (IncrementSchedule& schedule : board_.schedules_) {
    if (board_.now_.schedules_run && schedule.left_ > 1) {
      schedule.left_ -= low;
    }
  }
  if (IndexReference& reference = board_.reference_; reference_still_for() != kForEver) {
    const std::int64_t window = settings.index_window;
    reference.ahead_ -= static_cast<std::int64_t>(seed_clocks);
    const std::int64_t before = reference.ahead_ + 1;
    reference.near_ = before <= window && before >= -window;
    reference.early_ = before > window;
    reference.late_ = before < -window;
  }
  if (board_.delay_.waiting_) {
    board_.delay_.left_ = static_cast<std::uint16_t>(board_.delay_.left_ - seed_clocks);
  }
  if ((settings.control & kWatch) != 0 && board_.host_.silent_ < settings.silence_limit) {
    board_.host_.silent_ += low;
  }
}

}  // namespace gravure::fpga
