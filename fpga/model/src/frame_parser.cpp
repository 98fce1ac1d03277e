#include "gravure/fpga/frame_parser.hpp"

#include <utility>

namespace gravure::fpga {
namespace {

constexpr unsigned kPlaceMask = 0x1F'FFFF;

std::uint8_t byte_of(std::uint32_t word, unsigned number) noexcept {
  return static_cast<std::uint8_t>(word >> (8 * number));
}

}  // namespace

void FrameParser::reset(bool all) noexcept {
  part_ = Part::idle;
  place_ = 0;
  compare_ = false;
  ended_ = false;
  bad_sequence_ = bad_shape_ = bad_checksum_ = false;
  new_first_slot_ = 0;
  out_.sequence_error = out_.shape_error = out_.checksum_error = false;
  out_.rollback = true;
  if (all) {
    out_ = {.rollback = true};
    sequence_ = 0;
  }
}

void FrameParser::enter(Part part) noexcept {
  part_ = part;
  place_ = 0;
}

void FrameParser::take_first_slot(std::uint8_t byte, unsigned number) noexcept {
  if (number == 3) {
    bad_shape_ = bad_shape_ || byte != 0;
    return;
  }
  const unsigned shift = 8 * number;
  new_first_slot_ = (new_first_slot_ & ~(0xFFU << shift)) | (std::uint32_t{byte} << shift);
}

void FrameParser::take_head(const Inputs& in, unsigned place) noexcept {
  compare_ = true;
  head_place_ = place;
  head_byte_ = in.in_data;
  if (place / 4 == 4) {
    take_first_slot(in.in_data, place % 4);
  }
  if (place == kHeadBytes - 1) {
    enter(in.window_slots == 0 ? Part::check : Part::bits);
  }
}

/// The clock after a byte of the head.
void FrameParser::compare_head() noexcept {
  const std::uint32_t expected[] = {kKind, sequence_, out_.revolution, out_.line, 0, sums_.window_bytes};
  const unsigned field = head_place_ / 4;
  const bool wrong = field != 4 && head_byte_ != byte_of(expected[field], head_place_ % 4);
  bool& flag = field >= 1 && field <= 3 ? bad_sequence_ : bad_shape_;
  flag = flag || wrong;
}

void FrameParser::take_bits(const Inputs& in, unsigned place) noexcept {
  out_.push = true;
  out_.push_data = in.in_data;
  if (place == sums_.last_place) {
    const unsigned used = in.window_slots % 8U;
    bad_shape_ = bad_shape_ || (used != 0 && (in.in_data & (0xFFU >> used)) != 0);
    enter(Part::check);
  }
}

/// The clock after a frame's last byte.
void FrameParser::judge(const Inputs& in) noexcept {
  const bool shape = bad_shape_ || !window_fits_;
  out_.sequence_error = bad_sequence_;
  out_.shape_error = !bad_sequence_ && shape;
  out_.checksum_error = !bad_sequence_ && !shape && bad_checksum_;
  out_.rollback = bad();
  out_.commit = out_.line_valid = !out_.rollback;
  if (!out_.commit) {
    return;
  }
  out_.first_slot = new_first_slot_;
  ++sequence_;
  out_.odd = (((out_.revolution & in.lines_per_revolution) ^ out_.line) & 1U) != 0;
  out_.line = last_line_ ? 0 : sums_.next_line;
  out_.revolution += last_line_ ? 1U : 0U;
}

void FrameParser::take_check(const Inputs& in, unsigned place, std::uint32_t crc) noexcept {
  bad_checksum_ = bad_checksum_ || in.in_data != byte_of(crc, place % 4);
  if (place == 3) {
    part_ = Part::idle;
    ended_ = true;
  }
}

void FrameParser::take(const Inputs& in, std::uint32_t crc) noexcept {
  const unsigned place = place_;
  place_ = (place_ + 1) & kPlaceMask;
  switch (part_) {
    case Part::idle:
      bad_sequence_ = bad_shape_ = bad_checksum_ = false;
      out_.shape_error = in.in_data != kMark;
      enter(out_.shape_error ? Part::idle : Part::head);
      break;
    case Part::head:
      take_head(in, place);
      break;
    case Part::bits:
      take_bits(in, place);
      break;
    case Part::check:
      take_check(in, place, crc);
      break;
  }
}

FrameParser::Outputs FrameParser::step(const Inputs& now) noexcept {
  Inputs in = now;  // the byte of the clock before
  in.in_valid = byte_valid_;
  in.in_data = byte_data_;
  byte_valid_ = now.in_valid && !now.rst && !now.clear;
  byte_data_ = now.in_data;
  const bool stopped = out_.sequence_error || out_.shape_error || out_.checksum_error || (ended_ && bad());
  const bool taken = in.in_valid && !stopped;
  const std::uint32_t crc = crc_;  // of the bytes before this clock
  crc_ = checksum_
             .step({.rst = in.rst,
                    .start = in.in_valid && part_ == Part::idle,
                    .valid = in.in_valid && (part_ == Part::head || part_ == Part::bits),
                    .data = in.in_data})
             .crc;
  const Sums sums{.window_end = new_first_slot_ + in.window_slots,
                  .next_line = out_.line + 1,
                  .window_bytes = (in.window_slots + 7U) / 8U,
                  .last_place = (sums_.window_bytes - 1) & kPlaceMask};
  const bool window_fits = sums_.window_end <= in.slots_per_line;
  const bool last_line = sums_.next_line >= in.lines_per_revolution;
  out_.push = out_.commit = out_.rollback = out_.line_valid = false;
  if (in.rst || in.clear) {
    reset(in.rst);
  } else {
    if (std::exchange(compare_, false)) {
      compare_head();
    }
    if (ended_) {
      judge(in);
    }
    ended_ = false;
    if (taken) {
      take(in, crc);
    }
  }
  sums_ = sums;
  window_fits_ = window_fits;
  last_line_ = last_line;
  if (in.position_load && !in.rst) {
    out_.revolution = in.position_revolution;
    out_.line = in.position_line;
    sequence_ = 0;
  }
  return out_;
}

}  // namespace gravure::fpga
