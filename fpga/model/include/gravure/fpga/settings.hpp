#pragma once

#include <cstdint>

#include "gravure/fpga/latencies.hpp"
#include "gravure/fpga/register_map.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/settings.v: the registers that the host writes, and what of them the board refuses.
class Settings {
 public:
  struct Inputs {
    bool rst = false;
    bool clear = false;
    bool write = false;
    std::uint8_t address = 0;
    std::uint32_t write_data = 0;
  };
  /// Named as in docs/registers.md.
  struct Outputs {
    std::uint16_t control = kControlRegister.reset;
    std::uint16_t command = 0;  ///< for one clock
    std::uint32_t increment = kIncrementRegister.reset;
    std::uint32_t prescaler = kPrescalerRegister.reset;
    std::uint64_t fraction_num = kFractionNumRegister.reset;
    std::uint64_t fraction_den = kFractionDenRegister.reset;
    std::uint32_t increment_1 = kIncrement1Register.reset;
    std::uint32_t prescaler_1 = kPrescaler1Register.reset;
    std::uint64_t fraction_num_1 = kFractionNum1Register.reset;
    std::uint64_t fraction_den_1 = kFractionDen1Register.reset;
    std::uint16_t seeds_per_slot = kSeedsPerSlotRegister.reset;
    std::uint32_t slots_per_line = kSlotsPerLineRegister.reset;
    std::uint32_t window_slots = kWindowSlotsRegister.reset;
    std::uint32_t slots_per_microvector = kSlotsPerMicrovectorRegister.reset;
    std::uint32_t lines_per_revolution = kLinesPerRevolutionRegister.reset;
    std::uint32_t position_revolution = kPositionRevolutionRegister.reset;
    std::uint32_t position_line = kPositionLineRegister.reset;
    std::uint32_t silence_limit = kSilenceLimitRegister.reset;
    std::uint32_t first_tick = kFirstTickRegister.reset;
    std::uint16_t reverse_delay = kReverseDelayRegister.reset;
    std::uint16_t low_level = kLowLevelRegister.reset;
    std::uint8_t correction_limit = kCorrectionLimitRegister.reset;
    std::uint16_t index_window = kIndexWindowRegister.reset;
    std::uint64_t revolution_seeds = kRevolutionSeedsRegister.reset;
    std::uint32_t schedule_increment = kScheduleIncrementRegister.reset;
    std::uint32_t schedule_seeds = kScheduleSeedsRegister.reset;
    bool store = false;  ///< the word below is accepted on this clock, by a register that can be read back
    std::uint8_t store_address = 0;
    std::uint32_t store_data = 0;
    bool refused = false;  ///< a write changed nothing; sticky until clear
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  static constexpr int kLatency = kSettingsLatency;  ///< clocks from a write to the register
  /// Clocks that the settings of lines must stand before slots may run.
  static constexpr int kCheckClocks = 4;

  Outputs step(const Inputs& in) noexcept;

 private:
  /// The word of the clock before.
  struct Word {
    bool asked = false;
    bool bad = false;  ///< by itself
    std::uint8_t address = 0;
    std::uint32_t data = 0;
  };
  bool refuses() const noexcept;
  void show_store() noexcept;
  void take(std::uint8_t address, std::uint32_t data) noexcept;

  Outputs out_;
  Word word_;
  std::uint32_t low_word_ = 0;
  int young_ = kCheckClocks;
  std::uint32_t least_slot_ = 0;  ///< seed clocks that a slot must last
  bool fits_ = false;
};

}  // namespace gravure::fpga
