#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board_folder.hpp"
#include "board_machine.hpp"
#include "gravure/emulator/emulated_board.hpp"

namespace gravure::emulator {

/// A machine with its clock and the folder that keeps it: every event is noted before the machine sees it.
class EmulatedBoard::Front final : public PinObserver {
 public:
  explicit Front(BoardOptions options);
  /// With a value for everything.
  static BoardOptions filled_in(BoardOptions options, const std::string& path);
  static Result<std::unique_ptr<Front>> open(const std::string& folder, BoardOptions options);

  std::uint32_t read_register(std::uint8_t address);
  void write_register(std::uint8_t address, std::uint32_t value);
  std::size_t take(std::span<const std::byte> stream);
  void pass_time();
  void happens(BoardEvent event);
  void power_cycle();

  BoardStatus status() const;
  const BoardOptions& options() const noexcept { return options_; }
  const std::string& folder() const noexcept { return path_; }
  const Result<void>& health() const noexcept { return health_; }

  void on_line(const ExecutedLine& line) override;

 private:
  std::uint64_t clock() const;
  void start_clock();
  bool note(const Record& event);
  /// What it took, where it takes something.
  std::size_t apply(const Record& event);
  void obey(std::uint16_t commands);
  void power_up_again();
  void begin_folder(bool with_state);
  Result<void> resume();
  Result<void> take_stored(const BoardOptions& stored);
  Result<void> take_event(const Record& event);
  void keep(const Result<void>& result);

  BoardOptions options_;
  std::string path_;
  std::optional<BoardFolder> folder_;
  Result<void> health_;
  std::unique_ptr<BoardMachine> machine_;
  std::uint64_t power_up_ = 1;
  std::uint64_t start_ns_ = 0;  ///< where the machine's clock was start_clock_
  std::uint64_t start_clock_ = 0;
  bool replays_ = false;
  bool begin_due_ = false;  ///< the power went while events were taken again
};

}  // namespace gravure::emulator
