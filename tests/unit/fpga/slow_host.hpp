#pragma once

#include <algorithm>
#include <cstdint>

#include "event_pair.hpp"
#include "frame_maker.hpp"
#include "gravure/fpga/register_map.hpp"

namespace gravure::fpga::test {

/// A host of jobs with long slots: between two strobes there is room for every other counter of the board to do
/// something by itself. Most jobs go well; some host falls silent, some index is late.
class SlowHost {
 public:
  SlowHost(EventPair& pair, std::uint64_t seed) : pair_(pair), dice_(seed) {}

  /// One job; false where the two boards differ.
  bool run_job() {
    choose();
    set_up();
    go();
    while (good_ && now_ < end_) {
      next_moment();
    }
    return good_;
  }

 private:
  std::uint64_t below(std::uint64_t bound) { return dice_.word() % bound; }
  std::uint64_t one_of(std::initializer_list<std::uint64_t> values) { return *(values.begin() + below(values.size())); }

  void choose() {
    slots_ = 3 + below(6);
    window_ = 1 + below(slots_);
    seeds_ = 100 + below(1000);
    lines_ = 1 + below(3);
    turn_ = slots_ * seeds_ * lines_;
    maker_.configure(slots_, window_, lines_);
  }

  void hold(std::uint64_t seed_clocks) {
    good_ = good_ && pair_.run(in_, 2 * seed_clocks);
    now_ += seed_clocks;
  }

  void write(const Register& target, std::uint64_t data) {
    for (int word = 0; word < (target.bits > 32 ? 2 : 1); ++word) {
      in_.write = true;
      in_.address = static_cast<std::uint8_t>(target.address + word);
      in_.write_data = static_cast<std::uint32_t>(data >> static_cast<unsigned>(32 * word));
      hold(1);
      in_.write = false;
      in_.address = static_cast<std::uint8_t>(below(160));
      if (dice_.one_in(8)) {
        hold(1 + below(60));
      }
    }
  }

  void send(cosim::FrameMaker::Damage damage) {
    for (const std::uint8_t byte : maker_.next(dice_, damage)) {
      in_.in_valid = true;
      in_.in_data = byte;
      hold(1);
      in_.in_valid = false;
      if (dice_.one_in(10)) {
        hold(1 + below(20));
      }
    }
  }

  void set_up_axes() {
    const std::uint64_t quarter = 1U << 30U;
    const std::uint64_t den = one_of({1, 7, 1'000'003, 4'405'634'541});
    write(kIncrementRegister, one_of({0, 3, 1U << 21U, quarter - 1, quarter, below(quarter)}));
    write(kPrescalerRegister, one_of({1, 1, 2, 3, 500, 4'000'000'000}));
    write(kFractionNumRegister, below(den));
    write(kFractionDenRegister, den);
    write(kIncrement1Register, one_of({1U << 24U, below(quarter)}));
    write(kPrescaler1Register, 1 + below(4));
    write(kFractionNum1Register, 0);
    write(kFractionDen1Register, 1);
    write(kCommandRegister, 512);  // empties the schedules
    for (std::uint64_t segments = below(6); segments > 0; --segments) {
      write(kScheduleIncrementRegister, below(quarter));
      write(kScheduleSeedsRegister, below(dice_.one_in(2) ? 4000 : 100));
      write(kCommandRegister, dice_.one_in(2) ? 128 : 256);
    }
  }

  void set_up() {
    write(kControlRegister, dice_.word() & 384U);
    set_up_axes();
    write(kSeedsPerSlotRegister, seeds_);
    write(kSlotsPerLineRegister, slots_);
    write(kWindowSlotsRegister, window_);
    write(kSlotsPerMicrovectorRegister, 1 + below(3));
    write(kLinesPerRevolutionRegister, lines_);
    write(kPositionRevolutionRegister, 0);
    write(kPositionLineRegister, 0);
    write(kSilenceLimitRegister, dice_.one_in(3) ? 100 + below(seeds_) : 3 * slots_ * seeds_);
    write(kFirstTickRegister, below(3000));
    write(kReverseDelayRegister, dice_.one_in(3) ? 0 : below(seeds_ / 2));
    write(kLowLevelRegister, below(4));
    write(kCorrectionLimitRegister, below(30));
    write(kIndexWindowRegister, below(200));
    write(kRevolutionSeedsRegister, turn_);
    write(kCommandRegister, 1);
    write(kCommandRegister, 2 + 8 + 16);
    hold(100);
  }

  void go() {
    using Damage = cosim::FrameMaker::Damage;
    send(Damage::none);
    send(Damage::none);
    const bool timed = dice_.one_in(2);
    write(kControlRegister, 1U + 2U + 8U + (dice_.one_in(2) ? 4U : 0U) + (timed ? 16U : 0U) + (dice_.word() & 480U));
    write(kCommandRegister, timed || dice_.one_in(2) ? 64 : 0);
    in_.start = !timed;
    hold(1);
    in_.start = false;
    next_frame_ = now_ + slots_ * seeds_ - below(seeds_);
    planned_index_ = next_index_ = now_ + below(turn_);
    end_ = now_ + turn_ * (1 + below(6)) + below(3 * seeds_);
  }

  /// To the next frame or change of the index pin.
  void next_moment() {
    const std::uint64_t index_at = in_.index ? index_falls_ : next_index_;
    const std::uint64_t then = std::min({next_frame_, index_at, end_});
    if (then > now_) {
      hold(then - now_);
      return;
    }
    if (index_at <= now_) {
      in_.index = !in_.index;
      index_falls_ = now_ + 3 + below(40);
      if (in_.index) {
        planned_index_ += turn_;
        next_index_ = planned_index_ - 30 + below(60) + (dice_.one_in(4) ? 300 : 0);
      }
      hold(1);
      return;
    }
    next_frame_ += slots_ * seeds_;
    if (!dice_.one_in(12)) {
      send(dice_.one_in(15) ? cosim::FrameMaker::Damage::on_the_way : cosim::FrameMaker::Damage::none);
    }
    in_.interlock = dice_.one_in(25);
    hold(1);
  }

  EventPair& pair_;
  cosim::Dice dice_;
  cosim::FrameMaker maker_;
  Synchro::Inputs in_;
  std::uint64_t slots_ = 1, window_ = 1, seeds_ = 1, lines_ = 1, turn_ = 1;
  std::uint64_t now_ = 0;  ///< seed clocks
  std::uint64_t next_frame_ = 0, planned_index_ = 0, next_index_ = 0, index_falls_ = 0, end_ = 0;
  bool good_ = true;
};

}  // namespace gravure::fpga::test
