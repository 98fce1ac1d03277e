#include "line_stream.hpp"

#include <algorithm>
#include <array>

#include "gravure/core/crc32c.hpp"
#include "gravure/fpga/frame_parser.hpp"
#include "gravure/fpga/pulse_gate.hpp"

namespace gravure::emulator {
namespace {

using fpga::FrameParser;

constexpr std::size_t kBeforeBits = 1 + FrameParser::kHeadBytes;
constexpr std::size_t kFirstSlot = 17;

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) noexcept {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) {
    value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  }
  return value;
}

std::size_t frame_bytes(const LineStream::Shape& shape) noexcept {
  return FrameParser::kFrameBytes + fpga::packed_bytes(shape.window_slots);
}

bool has_shape(std::span<const std::byte> frame, const LineStream::Shape& shape) noexcept {
  const std::uint64_t first_slot = word(frame, kFirstSlot);
  const std::size_t bits = fpga::packed_bytes(shape.window_slots);
  const unsigned used = shape.window_slots % 8;
  const bool clean = used == 0 || (std::to_integer<unsigned>(frame[kBeforeBits + bits - 1]) & (0xFFU >> used)) == 0;
  return word(frame, 1) == FrameParser::kKind && word(frame, 21) == bits && clean &&
         first_slot + shape.window_slots <= shape.slots_per_line;
}

bool checksum_fits(std::span<const std::byte> frame) noexcept {
  const std::size_t end = frame.size() - 4;
  return ~crc32c_continue(kCrc32cStart, frame.subspan(1, end - 1)) == word(frame, end);
}

}  // namespace

void LineStream::append(std::span<const std::byte> bytes) {
  if (begin_ > capacity_) {  // seldom enough to cost nothing a byte
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
    judged_ -= begin_;
    begin_ = 0;
  }
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

void LineStream::flush() noexcept {
  bytes_.clear();
  lines_.clear();
  begin_ = judged_ = 0;
}

void LineStream::set_place(Place place, std::uint32_t sequence) noexcept {
  next_ = place;
  sequence_ = sequence;
}

std::optional<std::span<std::byte>> LineStream::next_frame(const Shape& shape) noexcept {
  const std::span<std::byte> rest = std::span(bytes_).subspan(judged_);
  if (!rest.empty() && rest.front() != std::byte{FrameParser::kMark}) {
    return rest.first(1);
  }
  return rest.size() < frame_bytes(shape) ? std::nullopt : std::optional(rest.first(frame_bytes(shape)));
}

DeviceFault LineStream::judge_frame(const Shape& shape) {
  const std::span<const std::byte> frame = next_frame(shape).value_or(std::span<std::byte>{});
  if (frame.size() < 2) {
    return DeviceFault::shape;
  }
  if (word(frame, 5) != sequence_ || word(frame, 9) != next_.revolution || word(frame, 13) != next_.line) {
    return DeviceFault::sequence;
  }
  if (!has_shape(frame, shape)) {
    return DeviceFault::shape;
  }
  if (!checksum_fits(frame)) {
    return DeviceFault::checksum;
  }
  lines_.push_back({next_, word(frame, kFirstSlot), frame.size()});
  judged_ += frame.size();
  ++sequence_;
  next_.line = next_.line + 1 >= shape.lines_per_revolution ? 0 : next_.line + 1;
  next_.revolution += next_.line == 0 ? 1U : 0U;
  return DeviceFault::none;
}

void LineStream::drop_frame(const Shape& shape) {
  const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(judged_);
  bytes_.erase(first, first + static_cast<std::ptrdiff_t>(frame_bytes(shape)));
}

void LineStream::leave_line(std::span<std::byte> frame) noexcept {
  frame[kFirstSlot + 3] = std::byte{0x80};
}

void LineStream::repeat_frame(const Shape& shape) {
  const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(judged_);
  const std::vector<std::byte> frame(first, first + static_cast<std::ptrdiff_t>(frame_bytes(shape)));
  bytes_.insert(first, frame.begin(), frame.end());
}

LineStream::Line LineStream::front() const noexcept {
  const Entry& entry = lines_.front();
  return {entry.place, entry.first_slot,
          std::span(bytes_).subspan(begin_ + kBeforeBits, entry.frame_bytes - FrameParser::kFrameBytes)};
}

void LineStream::pop() noexcept {
  begin_ += lines_.front().frame_bytes;
  lines_.pop_front();
}

void cut_line(std::span<std::byte> bits, std::uint32_t first_slot, std::uint32_t slots) noexcept {
  const std::size_t kept = slots > first_slot ? slots - first_slot : 0;
  if (kept / 8 >= bits.size()) {
    return;
  }
  bits[kept / 8] &= static_cast<std::byte>(0xFF00U >> (kept % 8));
  std::fill(bits.begin() + static_cast<std::ptrdiff_t>(kept / 8) + 1, bits.end(), std::byte{0});
}

}  // namespace gravure::emulator
