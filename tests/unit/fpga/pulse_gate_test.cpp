#include "gravure/fpga/pulse_gate.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "random_registers.hpp"

namespace gravure::fpga {
namespace {

using test::random_seed;
using test::Words;

std::vector<std::byte> random_bits(Words& words, std::uint32_t slots) {
  std::vector<std::byte> bits(packed_bytes(slots));
  for (std::byte& byte : bits) {
    byte = static_cast<std::byte>(words.word() >> 56U);
  }
  return bits;
}

/// What the pins showed over one line, one entry a slot; every tick of a slot must show the same.
std::vector<bool> run_line(PulseGate& gate, const GateRegisters& registers) {
  std::vector<bool> slots;
  for (std::uint32_t slot = 0; slot < registers.slots_per_line; ++slot) {
    for (std::uint32_t tick = 0; tick < registers.ticks_per_slot; ++tick) {
      const bool last = slot + 1 == registers.slots_per_line && tick + 1 == registers.ticks_per_slot;
      const PulseGate::Pins pins = gate.step();
      EXPECT_EQ(pins.slot, tick == 0);
      EXPECT_EQ(pins.line_done, last);
      if (tick == 0) {
        slots.push_back(pins.gate);
      } else {
        EXPECT_EQ(pins.gate, slots.back());
      }
    }
  }
  EXPECT_FALSE(gate.running());
  return slots;
}

void expect_fast_form_equals(const GateRegisters& registers, std::uint32_t first_slot, Words& words, bool fault) {
  SCOPED_TRACE(testing::Message() << "slots " << registers.slots_per_line << ", window " << registers.window_slots
                                  << " at " << first_slot << (fault ? ", dark" : ""));
  auto gate = PulseGate::make(registers);
  ASSERT_TRUE(gate);
  const std::vector<std::byte> bits = random_bits(words, registers.window_slots);
  std::vector<std::byte> fired(bits.size(), std::byte{0xAA});
  gate_line(bits, registers.window_slots, fault, fired);
  if (fault) {
    gate->raise_fault();
  }
  gate->start_line(bits, first_slot);
  const std::vector<bool> slots = run_line(*gate, registers);
  std::vector<std::byte> packed(bits.size(), std::byte{0});
  for (std::uint32_t slot = 0; slot < registers.slots_per_line; ++slot) {
    const std::uint32_t place = slot - first_slot;
    if (slot < first_slot || place >= registers.window_slots) {
      EXPECT_FALSE(slots[slot]) << "slot " << slot << " is outside the window";
    } else if (slots[slot]) {
      packed[place / 8] |= static_cast<std::byte>(0x80U >> (place % 8));
    }
  }
  EXPECT_EQ(packed, fired);
}

TEST(PulseGate, FastLineFormEqualsClockByClock) {
  const std::uint64_t seed = random_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  Words words(seed);
  for (int trial = 0; trial < 2000; ++trial) {
    GateRegisters registers;
    registers.ticks_per_slot = static_cast<std::uint32_t>(1 + words.below(5));
    registers.slots_per_line = static_cast<std::uint32_t>(1 + words.below(100));
    registers.window_slots = static_cast<std::uint32_t>(words.below(registers.slots_per_line + 1));
    const std::uint32_t spare = registers.slots_per_line - registers.window_slots;
    const std::uint32_t firsts[] = {0, spare, static_cast<std::uint32_t>(words.below(spare + 1))};
    expect_fast_form_equals(registers, firsts[trial % 3], words, trial % 10 == 9);
  }
}

TEST(PulseGate, SendsTheMostSignificantBitFirst) {
  const GateRegisters registers{.ticks_per_slot = 2, .slots_per_line = 6, .window_slots = 3};
  auto gate = PulseGate::make(registers);
  const std::byte bits[] = {std::byte{0b1010'0000}};
  gate->start_line(bits, 2);
  EXPECT_EQ(run_line(*gate, registers), (std::vector<bool>{false, false, true, false, true, false}));
}

TEST(PulseGate, FaultClosesTheGateInTheSameClockUntilALineStartsAfterAcknowledge) {
  const GateRegisters registers{.ticks_per_slot = 1, .slots_per_line = 4, .window_slots = 4};
  auto gate = PulseGate::make(registers);
  const std::byte bits[] = {std::byte{0xF0}};
  gate->start_line(bits, 0);
  EXPECT_TRUE(gate->step().gate);
  gate->raise_fault();
  EXPECT_FALSE(gate->step().gate);
  gate->acknowledge();
  EXPECT_FALSE(gate->step().gate);  // the rest of the line stays dark
  EXPECT_TRUE(gate->step().line_done);
  gate->start_line(bits, 0);
  EXPECT_TRUE(gate->step().gate);
}

TEST(PulseGate, StaysClosedBetweenLines) {
  auto gate = PulseGate::make({.ticks_per_slot = 1, .slots_per_line = 1, .window_slots = 1});
  const std::byte bits[] = {std::byte{0x80}};
  EXPECT_FALSE(gate->step().gate);
  gate->start_line(bits, 0);
  EXPECT_TRUE(gate->step().gate);
  EXPECT_FALSE(gate->step().gate);
}

TEST(PulseGate, FaultsWhenALineStartsBeforeTheLastHasEnded) {
  auto gate = PulseGate::make({.ticks_per_slot = 1, .slots_per_line = 3, .window_slots = 3});
  const std::byte bits[] = {std::byte{0xE0}};
  gate->start_line(bits, 0);
  EXPECT_TRUE(gate->step().gate);
  gate->start_line(bits, 0);
  EXPECT_TRUE(gate->fault());
  EXPECT_FALSE(gate->step().gate);
  EXPECT_TRUE(gate->step().line_done);
}

TEST(PulseGate, FaultsWhenTheWindowLeavesTheLineOrTheBitsDoNotFit) {
  const GateRegisters registers{.ticks_per_slot = 1, .slots_per_line = 10, .window_slots = 9};
  const std::byte bits[] = {std::byte{0xFF}, std::byte{0x80}, std::byte{0}};
  auto gate = PulseGate::make(registers);
  gate->start_line(std::span(bits).first(2), 1);
  EXPECT_FALSE(gate->fault());
  gate = PulseGate::make(registers);
  gate->start_line(std::span(bits).first(2), 2);
  EXPECT_TRUE(gate->fault());
  for (int slot = 0; slot < 10; ++slot) {
    EXPECT_FALSE(gate->step().gate);
  }
  for (const std::size_t size : {1U, 3U}) {
    gate = PulseGate::make(registers);
    gate->start_line(std::span(bits).first(size), 0);
    EXPECT_TRUE(gate->fault());
  }
}

TEST(PulseGate, RefusesWhatTheBoardWouldRefuse) {
  EXPECT_EQ(check(GateRegisters{.ticks_per_slot = 0}), GateRefusal::ticks_per_slot);
  EXPECT_EQ(check(GateRegisters{.slots_per_line = 0}), GateRefusal::slots_per_line);
  EXPECT_EQ(check(GateRegisters{.slots_per_line = 7, .window_slots = 8}), GateRefusal::window_slots);
  EXPECT_EQ(check(GateRegisters{.slots_per_line = ~0U, .window_slots = kMaxWindowSlots + 1}),
            GateRefusal::window_slots);
  EXPECT_EQ(check(GateRegisters{.slots_per_line = ~0U, .window_slots = kMaxWindowSlots}), GateRefusal::none);
  EXPECT_FALSE(PulseGate::make({.ticks_per_slot = 0}));
}

}  // namespace
}  // namespace gravure::fpga
