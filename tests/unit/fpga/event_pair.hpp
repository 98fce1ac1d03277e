#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <vector>

#include "gravure/fpga/synchro_events.hpp"

namespace gravure::fpga {

inline void PrintTo(const SynchroEvents::Event& event, std::ostream* out) {
  *out << "clock " << event.clock << ": a " << event.axes[0].a << event.axes[1].a << ", b " << event.axes[0].b
       << event.axes[1].b << ", gate " << event.gate << ", scan " << event.scan << ", fault " << int{event.fault}
       << ", level " << event.fifo_level;
}

inline void PrintTo(const LineProgress::Outputs& progress, std::ostream* out) {
  *out << progress.executed << " lines, " << progress.slots << " slots" << (progress.partial ? ", cut" : "");
}

}  // namespace gravure::fpga

namespace gravure::fpga::test {

/// Synchro clock by clock beside SynchroEvents, with the same inputs.
class EventPair {
 public:
  static constexpr int kFifoBits = 6;
  static constexpr int kScheduleBits = 4;
  using Event = SynchroEvents::Event;

  /// Holds `in` for `clocks`; false at the first difference, which is then a test failure.
  bool run(const Synchro::Inputs& in, std::uint64_t clocks) {
    expected_.clear();
    found_.clear();
    Synchro::Outputs out = last_;
    for (std::uint64_t count = 0; count < clocks; ++count) {
      out = clocked_.step(in);
      const Event before = now_;
      now_ = {.clock = before.clock + 1,
              .axes = {AbPins{out.a, out.b}, AbPins{out.a_1, out.b_1}},
              .gate = out.gate,
              .scan = out.scan,
              .fault = out.fault,
              .fifo_level = clocked_.fifo_level()};
      if (!now_.same_pins(before)) {
        expected_.push_back(now_);
      }
      faults_ |= 1U << out.fault;
      const LineProgress::Outputs& progress = clocked_.line_progress();
      cuts_ += progress.partial && !progress_.partial ? 1 : 0;
      executed_ += progress.executed > progress_.executed ? 1 : 0;
      progress_ = progress;
    }
    events_.run(in, clocks, [this](const Event& event) { found_.push_back(event); });
    seen_ += expected_.size();
    last_ = out;
    return same();
  }
  std::uint64_t clock() const { return now_.clock; }
  std::uint64_t seen() const { return seen_; }
  std::uint64_t stepped() const { return events_.stepped(); }
  unsigned faults() const { return faults_; }  ///< bit n: fault n was there
  std::uint64_t cuts() const { return cuts_; }
  std::uint64_t executed_lines() const { return executed_; }

 private:
  bool same() {
    for (std::size_t at = 0; at < std::min(expected_.size(), found_.size()); ++at) {
      const bool equal = expected_[at].clock == found_[at].clock && expected_[at].same_pins(found_[at]);
      EXPECT_TRUE(equal) << testing::PrintToString(expected_[at]) << "\n found " << testing::PrintToString(found_[at]);
      if (!equal) {
        return false;
      }
    }
    EXPECT_EQ(expected_.size(), found_.size()) << "events up to clock " << now_.clock;
    EXPECT_EQ(events_.clock(), now_.clock);
    EXPECT_EQ(events_.outputs().read_data, last_.read_data) << "after clock " << now_.clock;
    EXPECT_EQ(events_.line_progress(), clocked_.line_progress()) << "after clock " << now_.clock;
    EXPECT_EQ(events_.outputs().a, last_.a);
    EXPECT_EQ(events_.outputs().b_1, last_.b_1);
    return !testing::Test::HasFailure();
  }

  Synchro clocked_{kFifoBits, kScheduleBits};
  SynchroEvents events_{kFifoBits, kScheduleBits};
  Event now_;
  Synchro::Outputs last_;
  std::vector<Event> expected_;
  std::vector<Event> found_;
  std::uint64_t seen_ = 0;
  unsigned faults_ = 0;
  LineProgress::Outputs progress_;
  std::uint64_t cuts_ = 0;
  std::uint64_t executed_ = 0;
};

}  // namespace gravure::fpga::test
