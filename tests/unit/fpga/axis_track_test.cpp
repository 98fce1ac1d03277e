#include "gravure/fpga/axis_track.hpp"

#include <gtest/gtest.h>

#include "dice.hpp"

namespace gravure::fpga {
namespace {

using gravure::test::Dice;

/// Narrow counters, so that one count more or less moves an edge.
AbGenerator::Widths random_widths(Dice& dice) {
  const int segment = static_cast<int>(dice.between(4, 8));
  return {.bits = segment * static_cast<int>(dice.between(1, 2)),
          .prescaler_bits = 8,
          .fraction_bits = 6,
          .fraction = true,
          .segment_bits = segment};
}

AbPacer::Inputs random_load(Dice& dice, const AbGenerator::Widths& widths) {
  const std::int64_t quarter = std::int64_t{1} << (widths.bits - 2);
  const std::int64_t den = dice.between(1, 63);
  return {.enable = true,
          .load = true,
          .backward = dice.coin(),
          .increment = static_cast<std::uint64_t>(dice.coin() ? dice.between(0, quarter - 1) : quarter / 2),
          .prescaler = static_cast<std::uint64_t>(dice.coin() ? 1 : dice.between(1, 9)),
          .fraction_num = static_cast<std::uint64_t>(dice.coin() ? 0 : dice.between(0, den - 1)),
          .fraction_den = static_cast<std::uint64_t>(den)};
}

/// A generator after two loads and some clocks, even in number: it may have turned where A and B differ.
AbGenerator running(Dice& dice, const AbGenerator::Widths& widths, bool& enable, std::uint64_t& clock) {
  AbGenerator generator(widths);
  AbPacer::Inputs in;
  for (int load = 0; load < 2; ++load) {
    in = random_load(dice, widths);
    for (std::int64_t left = 2 * dice.between(20, 200); left > 0; --left) {
      generator.step(in);
      in.load = left % 2 == 0 && in.load;
      ++clock;
    }
  }
  const std::int64_t clocks = 2 * dice.between(60, 400);
  for (std::int64_t count = 0; count < clocks; ++count) {
    in.enable = count < clocks / 2 || enable;
    generator.step(in);
  }
  clock += static_cast<std::uint64_t>(clocks);
  return generator;
}

TEST(AxisTrack, HasEveryEdgeOfTheGenerator) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 2000; ++trial) {
    const AbGenerator::Widths widths = random_widths(dice);
    bool enable = dice.between(0, 9) != 0;
    std::uint64_t clock = 0;
    AbGenerator generator = running(dice, widths, enable, clock);
    AxisTrack track(generator, widths, enable, clock);
    AbGenerator::Outputs before;
    for (std::uint64_t now = clock + 1; now <= clock + 1000; ++now) {
      const AbGenerator::Outputs out = generator.step({.enable = enable});
      const bool due = track.next_clock() == now;
      if (due) {
        const AbPins pins = track.take();
        ASSERT_EQ(pins.a, out.a) << "trial " << trial << ", clock " << now;
        ASSERT_EQ(pins.b, out.b) << "trial " << trial << ", clock " << now;
      }
      if (now > clock + track.latency() + 1) {
        ASSERT_EQ(due, out.a != before.a || out.b != before.b) << "trial " << trial << ", clock " << now;
      }
      before = out;
    }
  }
}

TEST(AxisTrack, MakesTheGeneratorOfAnyLaterClock) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  for (int trial = 0; trial < 2000; ++trial) {
    const AbGenerator::Widths widths = random_widths(dice);
    bool enable = dice.between(0, 9) != 0;
    std::uint64_t clock = 0;
    AbGenerator generator = running(dice, widths, enable, clock);
    const AxisTrack track(generator, widths, enable, clock);
    const auto later = static_cast<std::uint64_t>(2 * dice.between(AxisTrack::kDrainSeedClocks, 300));
    for (std::uint64_t count = 0; count < 2 * later; ++count) {
      generator.step({.enable = enable});
    }
    AbGenerator made = track.at(clock + 2 * later);
    for (int count = 0; count < 300; ++count) {
      const bool on = count > 40 ? enable : dice.coin();
      const AbPacer::Inputs in{.enable = count % 2 == 0 ? on : enable};  // looked at on the first of two clocks
      const AbGenerator::Outputs expected = generator.step(in);
      const AbGenerator::Outputs found = made.step(in);
      ASSERT_EQ(expected, found) << "trial " << trial << ", " << count << " clocks after " << 2 * later;
    }
  }
}

}  // namespace
}  // namespace gravure::fpga
