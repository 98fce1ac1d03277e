#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "gravure/core/board_runs.hpp"
#include "gravure/core/line_device.hpp"
#include "gravure/core/program.hpp"

namespace gravure {

/// Makes a device whose pins are watched by the observer.
using DeviceFactory = std::function<std::unique_ptr<LineDevice>(PinObserver&)>;

/// A chunk of a program as it lies ready to be sent: its lines in time order for either direction.
class ProgramChunk {
 public:
  /// Reads and verifies a chunk; keeps it until another is asked for.
  Result<void> load(LineSource& program, ChunkAddress address);
  /// The chunk's lines in time order, as a revolution that exposes its layer has them; valid until the next call.
  std::span<const std::byte> lines_for(const ProgramHeader& header, std::int64_t revolution);
  /// Sends the chunk's lines for a revolution that exposes its layer. A device refusal is returned as it is.
  Result<void> send(const ProgramHeader& header, std::int64_t revolution, LineDevice& device);
  std::int64_t first_line() const noexcept { return first_line_; }
  std::int64_t lines() const noexcept { return lines_; }

 private:
  ChunkAddress address_{-1, -1};
  std::int64_t first_line_ = 0;
  std::int64_t lines_ = 0;
  std::vector<std::byte> stored_;  ///< as the program has them
  std::vector<std::byte> turned_;  ///< every line mirrored, for revolutions that start the other way
  bool turned_valid_ = false;
};

/// Collects what the pins showed and puts it back to where the image has it: the lines of one chunk, left to right.
class Landing {
 public:
  explicit Landing(const Plan& plan) : plan_(plan) {}
  /// Ready for `lines` lines.
  void start(std::int64_t lines);
  /// Takes an executed line; false if it does not belong to the marking window the plan gives its direction.
  bool take(const ExecutedLine& line);
  std::int64_t lines() const noexcept { return taken_; }
  /// The landed lines of a revolution whose line 0 runs as said, in image orientation, inverted if a one is to mean
  /// "stays dark". Unused low bits are 0.
  std::span<const std::byte> turn_back(std::int64_t first_line, bool starts_reverse, bool invert);

 private:
  const Plan& plan_;
  std::int64_t taken_ = 0;
  std::vector<std::byte> fired_;
  std::vector<std::byte> landed_;
};

}  // namespace gravure
