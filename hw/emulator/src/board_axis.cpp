#include "board_axis.hpp"

#include <algorithm>

namespace gravure::emulator {

void BoardAxis::load(const fpga::AbRegisters& registers) noexcept {
  refused_ = fpga::check(registers) != fpga::AbRefusal::none || (!with_fraction_ && registers.fraction_num != 0);
  if (!refused_) {
    walk_.load(registers);
  }
}

void BoardAxis::load_increment(std::uint64_t increment) noexcept {
  refused_ = increment > fpga::max_increment(walk_.registers());
  if (!refused_) {
    walk_.set_increment(increment);
  }
}

void BoardAxis::append(const ScheduleSegment& segment) {
  overflow_ = overflow_ || segments_.size() == kScheduleSegments;
  if (segments_.size() < kScheduleSegments) {
    segments_.push_back(segment);
  }
}

void BoardAxis::empty() noexcept {
  segments_.clear();
  left_ = 0;
  runs_ = overflow_ = false;
}

void BoardAxis::run(std::uint64_t ticks, bool enabled, std::uint64_t ticks_per_seed) noexcept {
  while (ticks != 0) {
    if (runs_ && left_ == 0 && !segments_.empty()) {
      load_increment(segments_.front().increment);
      left_ = segments_.front().seeds * ticks_per_seed;
      segments_.pop_front();
    }
    const std::uint64_t part = left_ != 0 ? std::min(left_, ticks) : ticks;
    if (enabled) {
      walk_.run(part);
    }
    left_ -= std::min(left_, part);
    ticks -= part;
  }
}

}  // namespace gravure::emulator
