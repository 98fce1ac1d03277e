#include "gravure/fpga/axis_track.hpp"

namespace gravure::fpga {
namespace {

void hold(AbGenerator& generator, bool enable) noexcept {
  const AbPacer::Inputs inputs{.enable = enable};
  for (int clock = 0; clock < AbGenerator::kClockMultiplier * AxisTrack::kDrainSeedClocks; ++clock) {
    static_cast<void>(generator.step(inputs));
  }
}

}  // namespace

AxisTrack::AxisTrack(const AbGenerator& generator, const AbGenerator::Widths& widths, bool enable,
                     std::uint64_t clock) noexcept
    : front_(generator),
      enable_(enable),
      clock_(clock),
      latency_(static_cast<std::uint64_t>(AbGenerator::enable_latency(widths))) {
  hold(front_, false);
  const AbPacer& pacer = front_.pacer_;
  den_ = pacer.below_ + pacer.addend_;
  accumulator_ = pacer.x_ >= pacer.num_ ? pacer.x_ - pacer.num_ : pacer.x_ + den_ - pacer.num_;
  count_ = front_.accumulator_.count_;
  quarter_ = count_ >> front_.accumulator_.quarter_shift_;
  turn_ = front_.accumulator_.turns_ & 3U;
  back_ = pacer.out_.back;
  per_step_ = static_cast<Uint128>(pacer.out_.step) * den_ + pacer.num_;
  per_edge_ = (static_cast<Uint128>(1) << front_.accumulator_.quarter_shift_) * den_;
  if (!enable || per_step_ == 0) {
    return;
  }
  gap_ = per_edge_ / per_step_;
  rest_ = per_edge_ % per_step_;
  const std::uint64_t in_quarter = count_ - (quarter_ << front_.accumulator_.quarter_shift_);
  const Uint128 left = per_edge_ - (static_cast<Uint128>(in_quarter) * den_ + accumulator_);
  const Uint128 steps = (left + per_step_ - 1) / per_step_;
  over_ = steps * per_step_ - left;
  next_clock_ = clock_ + latency_ + pacer.left_;  // of the first step
  advance(steps - 1);
}

void AxisTrack::advance(Uint128 steps) noexcept {
  const Uint128 clock = next_clock_ + steps * front_.pacer_.period_;
  next_clock_ = clock < kNever ? static_cast<std::uint64_t>(clock) : kNever;
}

AbPins AxisTrack::take() noexcept {
  const bool longer = over_ < rest_;
  over_ = longer ? over_ + per_step_ - rest_ : over_ - rest_;
  advance(longer ? gap_ + 1 : gap_);
  turn_ = turned(turn_, 1);
  return pins_of_quarter(turn_);
}

AbGenerator AxisTrack::at(std::uint64_t clock) const noexcept {
  AbGenerator generator = front_;
  AbPacer& pacer = generator.pacer_;
  const std::uint64_t clocks = clock - clock_ - std::uint64_t{AbGenerator::kClockMultiplier} * kDrainSeedClocks;
  if (enable_) {
    const std::uint64_t steps = clocks < pacer.left_ ? 0 : (clocks - pacer.left_) / pacer.period_ + 1;
    pacer.left_ = pacer.left_ + steps * pacer.period_ - clocks;
    const Uint128 sum = accumulator_ + static_cast<Uint128>(steps) * pacer.num_;
    const auto accumulator = static_cast<std::uint64_t>(sum % den_);
    const auto carries = static_cast<std::uint64_t>(sum / den_);
    pacer.x_ = static_cast<std::uint64_t>((static_cast<Uint128>(accumulator) + pacer.num_) % den_);
    pacer.y_ = static_cast<std::uint64_t>((static_cast<Uint128>(pacer.x_) + pacer.num_) % den_);
    AbAccumulator& counter = generator.accumulator_;
    counter.count_ = (count_ + steps * pacer.out_.step + carries) & counter.mask_;
    counter.turns_ = turned(front_.accumulator_.turns_, (counter.count_ >> counter.quarter_shift_) - quarter_);
  }
  hold(generator, enable_);
  return generator;
}

}  // namespace gravure::fpga
