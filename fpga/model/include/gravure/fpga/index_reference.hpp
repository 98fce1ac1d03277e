#pragma once

#include <algorithm>
#include <cstdint>

namespace gravure::fpga {

/// Bit-exact model of fpga/rtl/index_reference.v (BITS = 48, W = 16): measures the axis against the plan once per
/// revolution and hands out what it is off, up to `limit` clocks a line.
class IndexReference {
 public:
  struct Inputs {
    bool rst = false;
    bool clear = false;
    bool enable = false;
    bool index = false;  ///< the pin
    bool line_end = false;
    std::uint64_t revolution = 0;  ///< clocks by the plan, 48 bits
    std::uint16_t window = 0;      ///< largest error that is corrected
    std::uint8_t limit = 0;        ///< clocks a line; stands while enabled
  };
  struct Outputs {
    bool adjust = false;
    std::uint16_t amount = 0;  ///< 9 bits, two's complement: clocks by which lines get longer
    std::uint32_t error = 0;   ///< 18 bits, two's complement: clocks the last index was late
    bool referenced = false;
    bool lost = false;  ///< an index was missing or out of place; sticky until clear
    friend bool operator==(const Outputs&, const Outputs&) = default;
  };

  Outputs step(const Inputs& in) noexcept {
    const bool edge = (pin_ & 6U) == 2U;
    const bool referenced = out_.referenced;
    const bool free = !turn_ && !turned_;
    const bool serve = wanted_ && settled_ && !turn_;
    const bool lost = in.enable && referenced && ((edge && early_) || missing_);
    const std::int64_t reach = in.window;
    const std::int64_t ahead = ahead_;
    const int part = part_;
    const int part_less = part_less_;
    pin_ = in.rst ? 7U : ((pin_ << 1U) | (in.index ? 1U : 0U)) & 7U;
    part_ = std::clamp<int>(pending_, -int{in.limit}, in.limit);
    part_less_ = (pending_ > in.limit ? limit_ : part_) - 1;
    limit_ = in.limit;
    out_.adjust = false;
    if (in.rst || !in.enable) {
      out_.referenced = missing_ = take_ = turn_ = turned_ = wanted_ = settled_ = false;
      ahead_ = pending_ = 0;
      if (in.rst) {
        out_.error = out_.amount = 0;
      }
    } else {
      ahead_ = signed_of(static_cast<std::uint64_t>(ahead) + change(turn_, serve, part_less), 48);
      out_.referenced = referenced || turn_;
      settled_ = !turn_ && !serve;
      if (take_) {
        out_.error = static_cast<std::uint32_t>(-ahead) & 0x3FFFFU;
        pending_ = static_cast<int>(signed_of(out_.error, 18));
      } else if (serve) {
        pending_ -= part;
      }
      if (serve && part != 0) {
        out_.adjust = true;
        out_.amount = static_cast<std::uint16_t>(part & 0x1FF);
      }
      wanted_ = in.line_end ? referenced : wanted_ && !serve;
      const bool missing = missing_;
      missing_ = referenced && late_ && free && !missing;
      take_ = referenced && edge && near_ && free && !missing;
      turned_ = turn_;
      turn_ = referenced ? free && (missing || (edge && near_)) : edge && free;
    }
    near_ = ahead <= reach && ahead >= -reach;
    early_ = ahead > reach;
    late_ = ahead < -reach;
    revolution_less_ = in.revolution - 1;
    out_.lost = !in.rst && !in.clear && (out_.lost || lost);
    return out_;
  }

 private:
  friend class SynchroEvents;

  static std::int64_t signed_of(std::uint64_t value, unsigned bits) noexcept {
    return static_cast<std::int64_t>(value << (64U - bits)) >> (64U - bits);
  }
  std::uint64_t change(bool turn, bool serve, int part_less) const noexcept {
    if (turn) {
      return revolution_less_;
    }
    return static_cast<std::uint64_t>(std::int64_t{serve ? part_less : out_.referenced ? -1 : 0});
  }

  unsigned pin_ = 7;
  std::int64_t ahead_ = 0;  ///< clocks of the plan until the next index; 48 bits
  std::uint64_t revolution_less_ = 0;
  bool near_ = false;  ///< where `ahead` was a clock ago
  bool early_ = false;
  bool late_ = false;
  bool missing_ = false;
  bool take_ = false;
  bool turn_ = false;  ///< decided one clock before it is taken
  bool turned_ = false;
  int pending_ = 0;  ///< 18 bits
  int part_ = 0;
  int part_less_ = 0;  ///< that less the clock it is taken in
  int limit_ = 0;      ///< of the clock before
  bool wanted_ = false;
  bool settled_ = false;
  Outputs out_;
};

}  // namespace gravure::fpga
