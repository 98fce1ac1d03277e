#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gravure/core/error.hpp"

namespace gravure::formats {

/// How FPGA ticks become times of a value change dump, which knows only 1, 10 or 100 of a decimal unit. A tick whose
/// time is no whole number of units is rounded down, and the dump's comment says so.
struct VcdTime {
  std::string timescale = "1 ns";  ///< 1, 10 or 100, then s, ms, us, ns, ps or fs
  std::uint64_t units_num = 1;     ///< one tick is num / den units, >= 1
  std::uint64_t units_den = 1;     ///< 1 <= den <= num: two ticks must not share a time
};

/// One variable of a dump.
struct WaveSignal {
  std::string name;  ///< letters, digits and underscores
  int bits = 1;      ///< 1 to 64
};

/// Any signals as a value change dump (IEEE 1364 section 18) for GTKWave and the like. Every call appends to `out`, so
/// that the text can be written away piece by piece: memory does not grow with the length of the recording.
class WaveDump {
 public:
  static constexpr std::size_t kMaxSignals = 90;  ///< one printable character names each

  /// bad_argument where `time` or a signal breaks its ranges.
  static Result<WaveDump> make(const VcdTime& time, std::string scope, std::vector<WaveSignal> signals);

  /// The head, and every signal as it stands after tick `first`; `values` has one for each.
  Result<void> begin(std::string& out, std::uint64_t first, std::span<const std::uint64_t> values);
  /// What `signal` shows from `tick` on, which is not before the last one given. Nothing is appended where that is no
  /// change. out_of_range where the time does not fit 64 bits; then nothing is appended either.
  Result<void> change(std::string& out, std::uint64_t tick, std::size_t signal, std::uint64_t value);
  /// The end of the recording, so that viewers show the last state at its length.
  Result<void> end(std::string& out, std::uint64_t last);

 private:
  WaveDump(VcdTime time, std::string scope, std::vector<WaveSignal> signals)
      : time_(std::move(time)), scope_(std::move(scope)), signals_(std::move(signals)), values_(signals_.size()) {}
  Result<void> append_time(std::string& out, std::uint64_t tick) const;
  void append_value(std::string& out, std::size_t signal, std::uint64_t value) const;

  VcdTime time_;
  std::string scope_;
  std::vector<WaveSignal> signals_;
  std::vector<std::uint64_t> values_;
  std::uint64_t tick_ = 0;
};

}  // namespace gravure::formats
