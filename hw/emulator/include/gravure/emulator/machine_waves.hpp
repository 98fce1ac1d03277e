#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gravure/core/line_device.hpp"
#include "gravure/fpga/ab_edges.hpp"

namespace gravure::emulator {

/// What a logic analyser on the machine would show.
enum class Signal : std::uint8_t { a, b, gate, line_start, scanner_clock, revolution, line };
inline constexpr std::size_t kSignals = 7;
using SignalValues = std::array<std::uint64_t, kSignals>;

/// Takes the waves of a window, in order of time.
class WaveSink {
 public:
  virtual ~WaveSink() = default;
  /// Every signal as it stands after tick `first`. These return false to stop.
  virtual bool begin(std::uint64_t first, const SignalValues& values) = 0;
  virtual bool change(std::uint64_t tick, Signal signal, std::uint64_t value) = 0;
};

/// The signals of a machine, made from the lines that its board ran. Nothing is stored but the state at one tick.
///
/// A line starts on the tick of its slot 0. `gate` stands for a whole slot; `line_start` is high for one seed clock at
/// slot 0, `scanner_clock` at every slots_per_microvector-th slot, in phase with slot 0; `revolution` and `line` count
/// from 0. A and B show the counter just after the tick. These are the times of the plan: a board shows all of them
/// later by constants, which its model names.
class MachineWaves final : public PinObserver {
 public:
  struct Setup {
    DeviceSetup device;  ///< of the first run that is shown
    std::int64_t slots_per_microvector = 1;
    std::int64_t ticks_per_seed_clock = 1;  ///< j
    std::uint64_t first_tick = 0;           ///< of the window
    std::uint64_t last_tick = 0;            ///< included
  };

  /// `setup.device` is one that EmulatedDevice takes; the sink must outlive this.
  MachineWaves(const Setup& setup, WaveSink& sink);

  /// The lines that follow are those of another run, whose counters begin with its first line: A and B may jump there.
  void start_run(const DeviceSetup& device);
  /// The lines that touch the window, in order and without a gap; others before it or after it are passed over.
  void on_line(const ExecutedLine& line) override;
  /// What is left of the window after the last line.
  void finish();
  /// The sink wanted no more.
  bool stopped() const noexcept { return stopped_; }

 private:
  void slot(const ExecutedLine& line, std::int64_t number, std::uint64_t tick);
  void take_edge();
  void edges_to(std::uint64_t tick);
  void fall_by(std::uint64_t tick);
  void set(std::uint64_t tick, Signal signal, std::uint64_t value);
  void open_window();

  Setup setup_;
  WaveSink& sink_;
  fpga::AbEdges edges_;     ///< of the run, on clocks from its first tick
  fpga::AbEdge next_edge_;  ///< on a tick of the job, as the pins show it
  std::uint64_t run_tick_ = 0;
  bool edges_left_ = false;
  std::uint64_t strobes_fall_ = 0;
  bool strobes_high_ = false;
  SignalValues values_{};
  bool open_ = false;
  bool stopped_ = false;
};

}  // namespace gravure::emulator
