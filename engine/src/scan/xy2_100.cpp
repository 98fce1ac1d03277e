#include "gravure/scan/xy2_100.hpp"

#include <fmt/format.h>

#include <bit>
#include <cassert>

namespace gravure::scan {
namespace {

constexpr std::string_view kMagic = "GXY2";
constexpr unsigned char kVersion = 1;
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kFrameBytes = 6;

constexpr std::uint32_t kControl16 = 0b001;
constexpr std::uint32_t kControl18 = 0b1;
constexpr std::uint32_t kControl20 = 0b01;

std::uint32_t ones_of(std::uint32_t word) noexcept {
  return static_cast<std::uint32_t>(std::popcount(word));
}

/// Everything before the check bits -> the check bits.
std::uint32_t check_bits(FrameForm form, std::uint32_t rest) noexcept {
  switch (form) {
    case FrameForm::bits16:
      return ones_of(rest) & 1U;  // even over all twenty
    case FrameForm::bits18:
      return (ones_of(rest) & 1U) ^ 1U;  // odd over all twenty
    case FrameForm::bits20:
      break;
  }
  return ones_of(rest & 0xFFFFFU) & 3U;
}

std::uint32_t control_of(FrameForm form) noexcept {
  return form == FrameForm::bits16 ? kControl16 : form == FrameForm::bits18 ? kControl18 : kControl20;
}

unsigned check_width(FrameForm form) noexcept {
  return form == FrameForm::bits20 ? 2 : 1;
}

void append_word(std::string& bytes, std::uint32_t word) {
  for (const unsigned shift : {16U, 8U, 0U}) {
    bytes.push_back(static_cast<char>(word >> shift & 0xFFU));
  }
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) noexcept {
  std::uint32_t word = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    word = word << 8U | static_cast<unsigned char>(bytes[at + k]);
  }
  return word;
}

Error wrong(const std::string& text) {
  return {ErrorCode::bad_file, "XY2-100 stream: " + text};
}

}  // namespace

int position_bits(FrameForm form) noexcept {
  return form == FrameForm::bits16 ? 16 : form == FrameForm::bits18 ? 18 : 20;
}

int frame_bits(FrameForm form) noexcept {
  return form == FrameForm::bits20 ? 24 : 20;
}

Result<FrameForm> frame_form_for(int resolution_bits) {
  for (const FrameForm form : {FrameForm::bits16, FrameForm::bits18, FrameForm::bits20}) {
    if (resolution_bits <= position_bits(form)) {
      return form;
    }
  }
  return Error{
      ErrorCode::out_of_range,
      fmt::format("scan: resolution_bits = {}: XY2-100 and XY3-100 frames carry up to 20 here", resolution_bits)};
}

std::uint32_t encode_frame(FrameForm form, std::int32_t count) noexcept {
  const auto bits = static_cast<unsigned>(position_bits(form));
  const std::int64_t position = std::int64_t{count} + (std::int64_t{1} << (bits - 1));
  assert(position >= 0 && position < std::int64_t{1} << bits);
  const std::uint32_t rest = control_of(form) << bits | static_cast<std::uint32_t>(position);
  return rest << check_width(form) | check_bits(form, rest);
}

Result<std::int32_t> decode_frame(FrameForm form, std::uint32_t word) {
  const auto bits = static_cast<unsigned>(position_bits(form));
  const std::uint32_t rest = word >> check_width(form);
  if (rest >> bits != control_of(form)) {
    return wrong(fmt::format("frame {:#x} does not begin with the control bits of a {}-bit position", word, bits));
  }
  if ((word & ((1U << check_width(form)) - 1U)) != check_bits(form, rest)) {
    return wrong(fmt::format("frame {:#x} has wrong {}", word, form == FrameForm::bits20 ? "check bits" : "parity"));
  }
  const std::uint32_t position = rest & ((1U << bits) - 1U);
  return static_cast<std::int32_t>(position) - (std::int32_t{1} << (bits - 1));
}

Result<std::vector<FramePosition>> frames_of(const LineTrajectory& trajectory, Direction direction, FrameForm form) {
  return frames_of(trajectory.set_points(direction), trajectory.path.geometry().machine.head.resolution_bits, form);
}

Result<std::vector<FramePosition>> frames_of(const std::vector<SetPoint>& points, int bits, FrameForm form) {
  if (bits > position_bits(form)) {
    return Error{
        ErrorCode::out_of_range,
        fmt::format("scan: resolution_bits = {}: a frame of {} bits would round the set-points; take a wider frame "
                    "or plan with resolution_bits = {}",
                    bits, position_bits(form), position_bits(form))};
  }
  const std::int32_t factor = std::int32_t{1} << static_cast<unsigned>(position_bits(form) - bits);
  const std::int32_t half = std::int32_t{1} << static_cast<unsigned>(bits - 1);
  const auto is_inside = [half](std::int32_t count) { return count >= -half && count < half; };
  std::vector<FramePosition> frames;
  frames.reserve(points.size());
  for (const SetPoint& point : points) {
    if (!is_inside(point.u_count) || !is_inside(point.v_count)) {
      return Error{ErrorCode::out_of_range,
                   fmt::format("scan: set-point {} at U = {}, V = {} counts: frames carry {} to {}, the field of "
                               "scanner.field_mm; take a shorter turn, a larger field or fewer pixels",
                               frames.size(), point.u_count, point.v_count, -half, half - 1)};
    }
    frames.push_back({point.u_count * factor, point.v_count * factor});
  }
  return frames;
}

Rational frame_rate_hz(const LineTiming& timing) {
  return ratio(timing.fpga_hz, Integer(timing.ticks_per_slot) * timing.slots_per_microvector);
}

std::string encode_stream_start(FrameForm form, std::uint64_t frames) {
  std::string bytes(kMagic);
  bytes.push_back(static_cast<char>(kVersion));
  bytes.push_back(static_cast<char>(position_bits(form)));
  bytes.append(2, '\0');
  for (unsigned shift = 0; shift < 64; shift += 8) {
    bytes.push_back(static_cast<char>(frames >> shift & 0xFFU));
  }
  return bytes;
}

void append_frames(FrameForm form, const std::vector<FramePosition>& frames, std::string& bytes) {
  for (const FramePosition& frame : frames) {
    append_word(bytes, encode_frame(form, frame.u_count));
    append_word(bytes, encode_frame(form, frame.v_count));
  }
}

std::string encode_stream(const FrameStream& stream) {
  std::string bytes = encode_stream_start(stream.form, stream.frames.size());
  bytes.reserve(kHeaderBytes + kFrameBytes * stream.frames.size());
  append_frames(stream.form, stream.frames, bytes);
  return bytes;
}

Result<FrameStream> decode_stream(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes || bytes.substr(0, kMagic.size()) != kMagic) {
    return wrong("no header: must begin with \"GXY2\" and have at least 16 bytes");
  }
  const auto byte = [bytes](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
  if (byte(4) != kVersion) {
    return Error{ErrorCode::version_mismatch,
                 fmt::format("XY2-100 stream: version {}: this build reads {}", byte(4), kVersion)};
  }
  const auto form = frame_form_for(byte(5));
  if (!form || position_bits(form.value()) != byte(5) || byte(6) != 0 || byte(7) != 0) {
    return wrong(fmt::format("{} position bits: must be 16, 18 or 20, and two zero bytes after it", byte(5)));
  }
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    count |= std::uint64_t{byte(8 + k)} << (8 * k);
  }
  const std::size_t body = bytes.size() - kHeaderBytes;
  if (body % kFrameBytes != 0 || count != body / kFrameBytes) {
    return wrong(fmt::format("{} bytes for {} frames of {} bytes", body, count, kFrameBytes));
  }
  FrameStream stream{form.value(), {}};
  stream.frames.reserve(static_cast<std::size_t>(count));
  for (std::size_t at = kHeaderBytes; at < bytes.size(); at += kFrameBytes) {
    const auto u = decode_frame(stream.form, word_at(bytes, at));
    const auto v = decode_frame(stream.form, word_at(bytes, at + 3));
    if (!u || !v) {
      return Error{ErrorCode::bad_file, fmt::format("{} (frame {}, channel {})", (u ? v : u).error().message,
                                                    (at - kHeaderBytes) / kFrameBytes, u ? "V" : "U")};
    }
    stream.frames.push_back({u.value(), v.value()});
  }
  return stream;
}

}  // namespace gravure::scan
