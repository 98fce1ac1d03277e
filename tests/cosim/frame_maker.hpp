#pragma once

#include <cstdint>
#include <vector>

#include "stimulus.hpp"

namespace gravure::cosim {

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
    bytes_.clear();
    append(0xA5, 1);
    append(0x01565247, 4);
    append(sequence_, 4);
    append(revolution_, 4);
    append(line_, 4);
    append(dice.word() % (slots_ - window_ + 1), 4);
    append((window_ + 7) / 8, 4);
    for (std::uint64_t slot = 0; slot < window_; slot += 8) {
      const std::uint64_t unused = slot + 8 > window_ ? slot + 8 - window_ : 0;
      append((dice.word() << unused) & 0xFFU, 1);
    }
    if (damage == Damage::in_content) {
      bytes_[1 + dice.word() % (bytes_.size() - 1)] ^= static_cast<std::uint8_t>(1U << (dice.word() % 8));
    }
    append(crc(), 4);
    if (damage == Damage::on_the_way) {
      bytes_[dice.word() % bytes_.size()] ^= static_cast<std::uint8_t>(1U << (dice.word() % 8));
    }
    line_ = line_ + 1 >= lines_ ? 0 : line_ + 1;
    revolution_ += line_ == 0 ? 1 : 0;
    ++sequence_;
    return bytes_;
  }

 private:
  void append(std::uint64_t value, int count) {
    for (int byte = 0; byte < count; ++byte) {
      bytes_.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(8 * byte)));
    }
  }

  std::uint32_t crc() const {
    std::uint32_t state = ~0U;
    for (std::size_t at = 1; at < bytes_.size(); ++at) {
      state ^= bytes_[at];
      for (int bit = 0; bit < 8; ++bit) {
        state = (state >> 1U) ^ ((state & 1U) != 0 ? 0x82F63B78U : 0U);
      }
    }
    return ~state;
  }

  std::vector<std::uint8_t> bytes_;
  std::uint64_t revolution_ = 0, line_ = 0, sequence_ = 0;
  std::uint64_t slots_ = 1, window_ = 0, lines_ = 1;
};

}  // namespace gravure::cosim
