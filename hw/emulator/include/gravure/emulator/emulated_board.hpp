#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/device_link.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/emulator/wire_faults.hpp"

namespace gravure::emulator {

inline constexpr std::size_t kDefaultCapacity = std::size_t{1} << 20;
inline constexpr int kDefaultFifoBits = 16;

struct BoardOptions {
  /// Empty: that of the folder, or one made from its path.
  std::string serial = {};
  /// Bytes of the stream, bridge and line FIFO together. 0: as the folder has it, else kDefaultCapacity.
  std::size_t capacity_bytes = 0;
  /// The register of that name. 0: as the folder has it, else kDefaultFifoBits, the most that a board has.
  int fifo_bits = 0;
  /// Of the pseudo-random moment in which a fault strikes where the clock stands still.
  std::uint64_t seed = 1;
  std::vector<WireFault> faults = {};  ///< that are to come
  /// Seed clocks a second where the clock runs freely.
  std::uint64_t seed_hz = 82'000'000;
  /// Nanoseconds from anywhere, never less than before: the clock runs with it. Empty: it stands still where a job
  /// that runs would starve.
  std::function<std::uint64_t()> now_ns = {};
  /// Sees every line that fired, the cut one too: `fired` is what the gate let through, `start_tick` counts FPGA ticks
  /// since go, the axes count since power-up, whichever way their pins run. Must outlive the board.
  PinObserver* observer = nullptr;
};

/// A board on the wire without the board: the registers of docs/registers.md, the byte stream of docs/protocol.md with
/// a bridge buffer in front of the FPGA's parser, and status messages. It goes from line to line where fpga::Synchro
/// goes from clock to clock: same decisions, faults and lines.
///
/// Where its clock stands still ("waits for the host") a line begins only once its frame is there, so nothing ever
/// starves; lines run when pass_time() is called, or as room is needed. A frame that is refused meanwhile closes the
/// gate in a line and slot that BoardOptions::seed chooses, as it would be anywhere in the lines before.
/// The latencies of docs/registers.md, always the same few clocks, are left out.
///
/// While a fault stands, and until it is acknowledged, bytes are held and not looked at. A line that is stopped by
/// `control` while it runs is dropped.
///
/// Not safe for several threads at once.
class EmulatedBoard {
 public:
  /// In memory alone.
  explicit EmulatedBoard(BoardOptions options);
  /// Kept in a folder, which is made where there is none (docs/formats/emulated_board.md): it outlives this process at
  /// any moment. A board that is opened again first does what it had still to do, as a machine that went on, and then
  /// lacks its host. bad_argument: it has another serial number; device: another process has it open; bad_file names
  /// what is damaged; io.
  static Result<EmulatedBoard> open(const std::string& folder, BoardOptions options);
  EmulatedBoard(EmulatedBoard&& other) noexcept;
  EmulatedBoard& operator=(EmulatedBoard&& other) noexcept;
  ~EmulatedBoard();

  std::uint32_t read_register(std::uint8_t address);
  /// What the board refuses shows in its status register (bit 11).
  void write_register(std::uint8_t address, std::uint32_t value);
  /// How many bytes were taken: fewer where there is no room for more.
  std::size_t take(std::span<const std::byte> stream);
  /// Runs all that can run by now.
  void pass_time();
  /// The interlock opens for a moment.
  void open_interlock();
  /// As if it had been switched off and on again: all state is lost, the number of BoardStatus::power_up is another.
  void power_cycle();
  /// Nobody speaks to it any more, for as long as it has something to do.
  void lose_host();

  /// As it stands after the last call.
  BoardStatus status() const;
  const BoardOptions& options() const noexcept;
  const std::string& folder() const noexcept;
  /// Its clock stands still where a job would starve: after pass_time() only the host can change anything.
  bool waits_for_host() const noexcept { return !options().now_ns; }
  /// io where its folder could not be written: it does nothing from then on. bad_file where that shows damage.
  const Result<void>& health() const noexcept;

 private:
  class Front;
  explicit EmulatedBoard(std::unique_ptr<Front> front);
  std::unique_ptr<Front> front_;
};

}  // namespace gravure::emulator
