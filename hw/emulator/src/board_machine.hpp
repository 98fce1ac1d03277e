#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "board_axis.hpp"
#include "board_registers.hpp"
#include "gravure/emulator/emulated_board.hpp"
#include "line_stream.hpp"

namespace gravure::emulator {

/// What is behind an EmulatedBoard, and lost with its power.
class EmulatedBoard::Machine {
 public:
  explicit Machine(BoardOptions options);

  std::uint32_t read_register(std::uint8_t address);
  void write_register(std::uint8_t address, std::uint32_t value);
  std::size_t take(std::span<const std::byte> stream);
  void pass_time();
  void open_interlock();
  BoardStatus status() const;
  const BoardOptions& options() const noexcept { return options_; }

 private:
  bool stands_still() const noexcept { return !options_.now_ns; }
  bool control(std::uint32_t bit) const noexcept { return (registers_.settings().control & bit) != 0; }
  bool faulty() const noexcept { return fault_ != DeviceFault::none; }
  LineStream::Shape shape() const noexcept;
  std::uint64_t line_seeds() const noexcept;
  std::uint16_t status_word() const noexcept;
  std::uint32_t fifo_level() const noexcept;

  void obey(std::uint16_t command);
  void load_axis(std::size_t axis);
  void acknowledge() noexcept;
  void stop();

  std::uint64_t real_clock() const;
  void catch_up();
  void run_until(std::uint64_t clock);
  bool next_event(std::uint64_t clock);
  bool start_by(std::uint64_t clock);
  void move_clock(std::uint64_t clock);

  bool has_room() const noexcept;
  bool judge_next();
  void judge_all();
  void make_room();
  void begin_line();
  void end_line();
  void drop_line();
  void show_line(std::uint32_t slots);
  void strike(DeviceFault fault);
  void close_gate(DeviceFault fault, std::uint32_t slots);
  void cut_short(std::uint32_t slots);
  std::uint32_t slots_begun() const noexcept;
  std::uint64_t draw() noexcept;

  BoardOptions options_;
  std::uint64_t start_ns_ = 0;  ///< where the clock was 0
  BoardRegisters registers_;
  LineStream stream_;
  std::array<BoardAxis, 2> axes_{BoardAxis(true), BoardAxis(false)};
  std::uint64_t random_;

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
  LineStream::Place place_;  ///< of the line that runs or comes next
  std::vector<std::byte> fired_;
};

}  // namespace gravure::emulator
