#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "gravure/core/device_fault.hpp"

namespace gravure::emulator {

/// The bytes that wait in a board: frames that are through as lines, then what the bridge holds. Frames are judged as
/// fpga::FrameParser does it, whole ones at a time.
class LineStream {
 public:
  /// What a frame must be like, from the registers.
  struct Shape {
    std::uint32_t window_slots = 0;
    std::uint32_t slots_per_line = 0;
    std::uint32_t lines_per_revolution = 1;
    friend bool operator==(const Shape&, const Shape&) = default;
  };
  struct Place {
    std::uint32_t revolution = 0;
    std::uint32_t line = 0;
  };
  struct Line {
    Place place;
    std::uint32_t first_slot = 0;
    std::span<const std::byte> bits;  ///< until the next call of append() or pop()
  };

  explicit LineStream(std::size_t capacity_bytes) : capacity_(capacity_bytes) {}

  std::size_t level() const noexcept { return bytes_.size() - begin_; }
  std::size_t room() const noexcept { return capacity_ - level(); }
  std::size_t capacity() const noexcept { return capacity_; }
  /// At most room() bytes.
  void append(std::span<const std::byte> bytes);
  /// Turns a bit over, in the byte so many before the end.
  void spoil(std::size_t before_end) { bytes_[bytes_.size() - before_end] ^= std::byte{0x10}; }
  /// Drops all bytes and lines.
  void flush() noexcept;
  /// The line that must come next, in the frame of that number.
  void set_place(Place place, std::uint32_t sequence = 0) noexcept;
  Place next_place() const noexcept { return next_; }

  /// The next frame as it lies there, or none while it is not whole; the first byte alone where that is no mark.
  std::optional<std::span<std::byte>> next_frame(const Shape& shape) noexcept;
  /// none: it is a line now. Else it stays where it is.
  DeviceFault judge_frame(const Shape& shape);
  /// Leaves the next frame out.
  void drop_frame(const Shape& shape);
  /// Puts the window of a frame behind the end of any line.
  static void leave_line(std::span<std::byte> frame) noexcept;
  /// Puts a copy of the next frame behind it.
  void repeat_frame(const Shape& shape);

  std::size_t lines() const noexcept { return lines_.size(); }
  /// The oldest of them.
  Line front() const noexcept;
  void pop() noexcept;
  std::uint32_t taken() const noexcept { return sequence_; }  ///< since the place was set

 private:
  struct Entry {
    Place place;
    std::uint32_t first_slot = 0;
    std::size_t frame_bytes = 0;
  };
  std::size_t capacity_;
  std::vector<std::byte> bytes_;
  std::size_t begin_ = 0;   ///< of the oldest line
  std::size_t judged_ = 0;  ///< behind the newest
  std::deque<Entry> lines_;
  Place next_;
  std::uint32_t sequence_ = 0;
};

/// Slots of `line` before `slots` fire as they should, the others not.
void cut_line(std::span<std::byte> bits, std::uint32_t first_slot, std::uint32_t slots) noexcept;

}  // namespace gravure::emulator
