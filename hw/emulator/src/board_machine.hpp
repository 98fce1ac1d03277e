#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "board_axis.hpp"
#include "board_registers.hpp"
#include "gravure/core/device_link.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/emulator/wire_faults.hpp"
#include "gravure/fpga/ab_generator.hpp"
#include "line_stream.hpp"

namespace gravure::emulator {

/// What an EmulatedBoard does, and loses with its power: the same for the same calls at the same clocks. Clocks are
/// seed clocks since power-up, never less than before; where the clock stands still they are not looked at.
class BoardMachine {
 public:
  struct Setup {
    std::size_t capacity_bytes = 0;
    int fifo_bits = 0;
    std::uint64_t random = 0;
    bool stands_still = true;
    std::vector<WireFault> faults;
  };
  BoardMachine(const Setup& setup, PinObserver& observer);

  std::uint32_t read_register(std::uint8_t address, std::uint64_t clock);
  /// The commands it gave.
  std::uint16_t write_register(std::uint8_t address, std::uint32_t value, std::uint64_t clock);
  std::size_t take(std::span<const std::byte> stream, std::uint64_t clock);
  void pass_time(std::uint64_t clock);
  void open_interlock(std::uint64_t clock);
  void lose_host();

  /// Bytes that take() would take.
  std::size_t room(std::uint64_t clock);
  BoardStatus status() const;
  bool stands_still() const noexcept { return setup_.stands_still; }
  std::uint64_t clock() const noexcept { return clock_; }
  bool power_lost() const noexcept { return power_lost_; }
  /// Something is left that pass_time() would do.
  bool can_run() const noexcept;
  bool runs_slots() const noexcept { return control(1); }
  const fpga::Settings::Outputs& settings() const noexcept { return registers_.settings(); }
  std::uint32_t stored_word(std::uint8_t address) noexcept { return registers_.read(address, {}); }

  /// Slots stand, no schedule is left: after an acknowledge the registers and these counters are all there is to know.
  bool rests() const noexcept;
  struct Counters {
    std::uint32_t executed = 0;
    LineStream::Place place;  ///< of the line that comes next
    std::uint32_t taken = 0;
  };
  Counters counters() const noexcept { return {executed_, place_, stream_.taken()}; }
  void restore(const Counters& counters) noexcept;

  /// What makes another machine do the same from now on, the registers apart; bytes count anew.
  const Setup& setup_from_now();
  /// Other faults to come, another seed, another clock.
  void set_up(const Setup& setup);

 private:
  static constexpr std::uint64_t kTicksPerSeed = fpga::AbGenerator::kClockMultiplier;

  bool control(std::uint32_t bit) const noexcept { return (registers_.settings().control & bit) != 0; }
  bool faulty() const noexcept { return fault_ != DeviceFault::none; }
  LineStream::Shape shape() const noexcept;
  std::int64_t ordinal_of(LineStream::Place place) const noexcept;
  std::uint64_t line_seeds() const noexcept;
  std::uint16_t status_word() const noexcept;
  std::uint32_t fifo_level() const noexcept;

  void obey(std::uint16_t command);
  void load_axis(std::size_t axis);
  void acknowledge() noexcept;

  void catch_up(std::uint64_t clock);
  void run_until(std::uint64_t clock);
  bool next_event(std::uint64_t clock);
  bool start_by(std::uint64_t clock);
  void run_dark(std::uint64_t clock);
  void move_clock(std::uint64_t clock);

  bool has_room() const noexcept;
  bool judge_next();
  void judge_all();
  void make_room();
  void begin_line();
  void end_line();
  void complete_line();
  void drop_line();
  void show_line(std::uint32_t slots);
  void strike(DeviceFault fault);
  void close_gate(DeviceFault fault, std::uint32_t slots);
  void cut_short(std::uint32_t slots);
  std::uint32_t slots_begun() const noexcept;
  std::uint32_t delay_of(LineStream::Place place) const noexcept;
  bool meet_fault(std::uint64_t clock);
  bool spoil_frame();
  std::size_t most_taken(std::size_t wanted) const;
  std::uint64_t draw() noexcept;

  Setup setup_;
  PinObserver* observer_;
  WireFaults planned_;
  std::optional<WireFault> due_;  ///< in the line that runs
  bool frame_lost_ = false;
  bool power_lost_ = false;
  std::int64_t taken_bytes_ = 0;
  BoardRegisters registers_;
  LineStream stream_;
  std::array<BoardAxis, 2> axes_{BoardAxis(true), BoardAxis(false)};

  std::uint64_t clock_ = 0;      ///< seed clocks since power-up
  std::uint64_t last_host_ = 0;  ///< when the host said something
  std::uint64_t go_clock_ = 0;
  bool gone_ = false;             ///< go was given, and no line has begun since
  bool started_ = false;          ///< lines have begun
  bool line_runs_ = false;        ///< the oldest of the stream
  std::uint64_t line_clock_ = 0;  ///< when it began
  std::array<AxisState, 2> axes_at_start_{};
  bool positioned_ = false;

  DeviceFault fault_ = DeviceFault::none;
  std::uint8_t faults_ = 0;
  bool overflow_ = false;
  std::uint64_t dark_until_ = 0;  ///< a fault stands: when the lines run out that came before it
  std::uint32_t executed_ = 0;
  std::uint32_t closed_slot_ = 0;
  bool partial_ = false;     ///< a line was cut there
  LineStream::Place place_;  ///< of the line that runs or comes next
  std::vector<std::byte> fired_;
};

}  // namespace gravure::emulator
