#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "gravure/core/error.hpp"

namespace gravure {

/// Nothing as long as work is to go on; else the error to stop with. Asked often, so it is cheap.
using StopTest = std::function<Result<void>()>;

/// The lines of image layers as the images have them: left to right along the line, packed MSB first.
/// Not thread-safe: each worker has its own.
class LayerLines {
 public:
  virtual ~LayerLines() = default;
  /// Lines [first_line, first_line + count) of a layer into `out`, (pixels + 7) / 8 bytes each; bits beyond the pixels
  /// are undefined. Returns true where a one means "stays dark": such bits are to be inverted to become pulses.
  virtual Result<bool> read_lines(std::int64_t layer, std::int64_t first_line, std::int64_t count,
                                  std::span<std::byte> out) = 0;
  /// The least memory it works with when up to `lines` lines are asked for at once, beside the lines it gives.
  virtual std::int64_t least_memory_bytes(std::int64_t /*lines*/) { return 0; }
  /// Grants memory, no less than that, before the first line is read.
  virtual void grant_memory(std::int64_t /*lines*/, std::int64_t /*bytes*/) {}
  /// What is asked again and again within read_lines(), which may decode a whole picture for one line.
  virtual void stop_when(StopTest /*test*/) {}
};

using LayerLinesFactory = std::function<Result<std::unique_ptr<LayerLines>>()>;

}  // namespace gravure
