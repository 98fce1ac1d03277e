#pragma once

#include <cstdint>
#include <vector>

#include "stimulus.hpp"

namespace gravure::cosim {

/// CRC-32C of all but the mark.
inline std::uint32_t frame_crc(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t state = ~0U;
  for (std::size_t at = 1; at < bytes.size(); ++at) {
    state ^= bytes[at];
    for (int bit = 0; bit < 8; ++bit) {
      state = (state >> 1U) ^ ((state & 1U) != 0 ? 0x82F63B78U : 0U);
    }
  }
  return ~state;
}

inline void append_word(std::vector<std::uint8_t>& bytes, std::uint64_t value) {
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

/// A frame of a line without its checksum (docs/protocol.md).
inline std::vector<std::uint8_t> frame_content(std::uint64_t sequence, std::uint64_t revolution, std::uint64_t line,
                                               std::uint64_t first_slot, const std::vector<std::uint8_t>& bits) {
  std::vector<std::uint8_t> bytes{0xA5};
  for (const std::uint64_t field : {std::uint64_t{0x01565247}, sequence, revolution, line, first_slot, bits.size()}) {
    append_word(bytes, field);
  }
  bytes.insert(bytes.end(), bits.begin(), bits.end());
  return bytes;
}

/// And with it.
inline std::vector<std::uint8_t> line_frame(std::uint64_t sequence, std::uint64_t revolution, std::uint64_t line,
                                            std::uint64_t first_slot, const std::vector<std::uint8_t>& bits) {
  std::vector<std::uint8_t> bytes = frame_content(sequence, revolution, line, first_slot, bits);
  append_word(bytes, frame_crc(bytes));
  return bytes;
}

/// Makes the frames of a job one after another as a host sends them, damaged on request.
class FrameMaker {
 public:
  enum class Damage { none, in_content, on_the_way };

  /// A new job at line 0.
  void configure(std::uint64_t slots, std::uint64_t window, std::uint64_t lines) {
    slots_ = slots;
    window_ = window;
    lines_ = lines;
    restart_at_zero();
  }
  void restart_at_zero() { revolution_ = line_ = sequence_ = 0; }
  std::uint64_t revolution() const { return revolution_; }
  std::uint64_t line() const { return line_; }

  std::vector<std::uint8_t> next(Dice& dice, Damage damage) {
    const std::uint64_t first_slot = dice.word() % (slots_ - window_ + 1);
    std::vector<std::uint8_t> bits;
    for (std::uint64_t slot = 0; slot < window_; slot += 8) {
      const std::uint64_t unused = slot + 8 > window_ ? slot + 8 - window_ : 0;
      bits.push_back(static_cast<std::uint8_t>(dice.word() << unused));
    }
    std::vector<std::uint8_t> bytes = frame_content(sequence_, revolution_, line_, first_slot, bits);
    if (damage == Damage::in_content) {
      bytes[1 + dice.word() % (bytes.size() - 1)] ^= static_cast<std::uint8_t>(1U << (dice.word() % 8));
    }
    append_word(bytes, frame_crc(bytes));
    if (damage == Damage::on_the_way) {
      bytes[dice.word() % bytes.size()] ^= static_cast<std::uint8_t>(1U << (dice.word() % 8));
    }
    line_ = line_ + 1 >= lines_ ? 0 : line_ + 1;
    revolution_ += line_ == 0 ? 1 : 0;
    ++sequence_;
    return bytes;
  }

 private:
  std::uint64_t revolution_ = 0, line_ = 0, sequence_ = 0;
  std::uint64_t slots_ = 1, window_ = 0, lines_ = 1;
};

}  // namespace gravure::cosim
