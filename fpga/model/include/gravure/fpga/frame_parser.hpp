#pragma once

#include <cstdint>

#include "gravure/fpga/crc32c.hpp"

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/frame_parser.v: bytes from the host -> lines that are in sequence, in shape and whole.
/// A frame is kMark, kKind, sequence, revolution, line, first slot and length (32 bits each, little endian), the
/// window's packed bits (`length` bytes), and the CRC-32C of all that but the mark. Sequence counts the frames since
/// position_load or reset. Any other frame is rolled back and stops the parser until clear.
/// Latency (latencies.hpp): kVerdictLatency.
class FrameParser {
 public:
  static constexpr std::uint8_t kMark = 0xA5;
  static constexpr std::uint32_t kKind = 0x0156'5247;     ///< "GRV", 1: a line
  static constexpr int kHeadBytes = 24;                   ///< from the kind to the length
  static constexpr int kFrameBytes = 1 + kHeadBytes + 4;  ///< beside the bits

  struct Inputs {
    bool rst = false;
    bool clear = false;
    bool in_valid = false;
    bool position_load = false;  ///< sets the line that must come next, as frame 0
    std::uint8_t in_data = 0;
    std::uint32_t slots_per_line = 0;  ///< 24 bits
    std::uint32_t window_slots = 0;    ///< 24 bits
    std::uint32_t lines_per_revolution = 0;
    std::uint32_t position_revolution = 0;
    std::uint32_t position_line = 0;
  };
  struct Outputs {
    bool push = false;
    bool commit = false;
    bool rollback = false;
    bool line_valid = false;
    bool sequence_error = false;  ///< the errors are sticky until clear; at most one stands
    bool shape_error = false;
    bool checksum_error = false;
    std::uint8_t push_data = 0;
    std::uint32_t first_slot = 0;  ///< of the line committed last
    bool odd = false;              ///< its number, counted from the job's first line, is odd
    std::uint32_t revolution = 0;  ///< that must come next
    std::uint32_t line = 0;
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& now) noexcept;

 private:
  /// Registers on the way from the settings to the verdict.
  struct Sums {
    std::uint32_t window_end = 0;  ///< 25 bits
    std::uint32_t next_line = 1;
    std::uint32_t window_bytes = 0;
    std::uint32_t last_place = 0;  ///< of the window's bytes, 21 bits
  };
  enum class Part : std::uint8_t { idle, head, bits, check };

  void reset(bool all) noexcept;
  void take(const Inputs& in, std::uint32_t crc) noexcept;
  void take_head(const Inputs& in, unsigned place) noexcept;
  void compare_head() noexcept;
  void take_first_slot(std::uint8_t byte, unsigned number) noexcept;
  void take_bits(const Inputs& in, unsigned place) noexcept;
  void take_check(const Inputs& in, unsigned place, std::uint32_t crc) noexcept;
  void judge(const Inputs& in) noexcept;
  bool bad() const noexcept { return bad_sequence_ || bad_shape_ || bad_checksum_ || !window_fits_; }
  void enter(Part part) noexcept;

  Part part_ = Part::idle;
  unsigned place_ = 0;  ///< byte within the part; 21 bits
  bool bad_sequence_ = false;
  bool bad_shape_ = false;
  bool bad_checksum_ = false;
  bool byte_valid_ = false;
  std::uint8_t byte_data_ = 0;
  bool compare_ = false;  ///< a byte of the head was taken on the clock before
  unsigned head_place_ = 0;
  std::uint8_t head_byte_ = 0;
  bool ended_ = false;  ///< the last byte was taken on the clock before
  Sums sums_;
  bool window_fits_ = false;
  bool last_line_ = false;
  std::uint32_t new_first_slot_ = 0;
  std::uint32_t sequence_ = 0;  ///< of the frame that must come next
  Crc32c checksum_;
  std::uint32_t crc_ = 0;
  Outputs out_;
};

}  // namespace gravure::fpga
