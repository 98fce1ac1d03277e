#pragma once

// clang-format off
// Made by fpga/regs/generate.py from latencies.txt; change that file.

#include <array>
#include <string_view>

namespace gravure::fpga {

// Clocks from the one before which an input stands to the one after which its effect shows, both included; of the
// A-B generator from just after the one that takes it.

/// seed clocks: a write to the register or command.
inline constexpr int kSettingsLatency = 2;
/// seed clocks: an address to read_data.
inline constexpr int kReadLatency = 2;
/// seed clocks: a frame's last byte to commit or fault.
inline constexpr int kVerdictLatency = 3;
/// seed clocks: what the FIFO holds to its level.
inline constexpr int kLevelLatency = 1;
/// seed clocks: what the FIFO holds to almost_empty.
inline constexpr int kAlmostEmptyLatency = 2;
/// seed clocks: go to slots_run, first_tick apart.
inline constexpr int kStartLatency = 3;
/// seed clocks: a slot's first clock to `slot`.
inline constexpr int kSlotLatency = 1;
/// seed clocks: `slot` to the decision.
inline constexpr int kSequencerLatency = 1;
/// seed clocks: the decision through direction_delay; for backward lines reverse_delay more.
inline constexpr int kDelayLatency = 1;
/// seed clocks: the delayed decision to `gate`.
inline constexpr int kGateLatency = 1;
/// seed clocks: a slot's begin, its end or a cut at `gate` to closed_slot and executed_lines.
inline constexpr int kProgressLatency = 1;
/// seed clocks: the decision to `scan`.
inline constexpr int kScanLatency = 1;
/// seed clocks: a slot's first clock to `gate`.
inline constexpr int kSlotToGate = kSlotLatency + kSequencerLatency + kDelayLatency + kGateLatency;
/// seed clocks: a slot's first clock to `scan`.
inline constexpr int kSlotToScan = kSlotLatency + kSequencerLatency + kScanLatency;
/// seed clocks: a segment that is due to its load_increment.
inline constexpr int kScheduleLatency = 1;
/// seed clocks: an edge of the index pin to index_error.
inline constexpr int kIndexLatency = 4;
/// seed clocks: the end of a line to its correction.
inline constexpr int kAdjustLatency = 2;
/// seed clocks: the clock that is one too many to `expired`.
inline constexpr int kWatchdogLatency = 1;
/// seed clocks: an error to `fault`.
inline constexpr int kFaultLatency = 1;
/// seed clocks: a byte to the checksum.
inline constexpr int kCrcLatency = 1;
/// seed clocks: a number to its descriptor.
inline constexpr int kRomLatency = 1;
/// seed clocks: A-B load to the word of its clock 1.
inline constexpr int kLoadClocks = 8;
/// seed clocks: A-B enable to the word.
inline constexpr int kDueLatency = 3;
/// seed clocks: A-B load_increment to the word.
inline constexpr int kStepLatency = 1;
/// FPGA clocks: the word to the pins, and one more for each segment of the counter.
inline constexpr int kWordStages = 3;

struct Latency {
  std::string_view name;  ///< as latencies.txt and the timing tables write it
  int clocks;
};
inline constexpr std::array<Latency, 25> kLatencies{{
    {"SETTINGS_LATENCY", kSettingsLatency},
    {"READ_LATENCY", kReadLatency},
    {"VERDICT_LATENCY", kVerdictLatency},
    {"LEVEL_LATENCY", kLevelLatency},
    {"ALMOST_EMPTY_LATENCY", kAlmostEmptyLatency},
    {"START_LATENCY", kStartLatency},
    {"SLOT_LATENCY", kSlotLatency},
    {"SEQUENCER_LATENCY", kSequencerLatency},
    {"DELAY_LATENCY", kDelayLatency},
    {"GATE_LATENCY", kGateLatency},
    {"PROGRESS_LATENCY", kProgressLatency},
    {"SCAN_LATENCY", kScanLatency},
    {"SLOT_TO_GATE", kSlotToGate},
    {"SLOT_TO_SCAN", kSlotToScan},
    {"SCHEDULE_LATENCY", kScheduleLatency},
    {"INDEX_LATENCY", kIndexLatency},
    {"ADJUST_LATENCY", kAdjustLatency},
    {"WATCHDOG_LATENCY", kWatchdogLatency},
    {"FAULT_LATENCY", kFaultLatency},
    {"CRC_LATENCY", kCrcLatency},
    {"ROM_LATENCY", kRomLatency},
    {"LOAD_CLOCKS", kLoadClocks},
    {"DUE_LATENCY", kDueLatency},
    {"STEP_LATENCY", kStepLatency},
    {"WORD_STAGES", kWordStages},
}};

}  // namespace gravure::fpga
