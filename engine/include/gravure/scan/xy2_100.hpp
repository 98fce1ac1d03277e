#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/exact.hpp"
#include "gravure/scan/line_trajectory.hpp"

namespace gravure::scan {

/// The published frames that carry positions (docs/formats/xy2_100.md has the sources). Positions are offset binary:
/// 0 is the negative end of the field.
enum class FrameForm : std::uint8_t {
  bits16,  ///< XY2-100: 20 bits: 0 0 1, 16 data, even parity over all
  bits18,  ///< XY2-100 Enhanced: 20 bits: 1, 18 data, odd parity over all
  bits20,  ///< XY3-100, the successor: 24 bits: 0 1, 20 data, two bits counting the ones of the data
};

/// 16, 18 or 20.
int position_bits(FrameForm form) noexcept;
/// On the wire: 20, 20 or 24.
int frame_bits(FrameForm form) noexcept;
/// The form that carries so many bits exactly, the smallest; out_of_range above 20.
Result<FrameForm> frame_form_for(int resolution_bits);

/// Both channels of one frame; counts are signed, 0 is the centre of the field.
struct FramePosition {
  std::int32_t u_count = 0;
  std::int32_t v_count = 0;
  bool operator==(const FramePosition&) const = default;
};

/// The frame of one channel, first bit on the wire highest. Counts beyond the form's range are a caller's bug.
std::uint32_t encode_frame(FrameForm form, std::int32_t count) noexcept;

/// And back. Fails with bad_file where bits stand that are not of this form, or the parity is wrong.
Result<std::int32_t> decode_frame(FrameForm form, std::uint32_t word);

/// The frames of one line, one a set-point; counts of fewer bits than the frame's are shifted up. Fails with
/// out_of_range where the scanner's resolution_bits exceed the form's, and where a set-point lies beyond the field:
/// nothing is rounded or clamped here.
Result<std::vector<FramePosition>> frames_of(const LineTrajectory& trajectory, Direction direction, FrameForm form);
/// Of any set-points of a scanner of so many bits.
Result<std::vector<FramePosition>> frames_of(const std::vector<SetPoint>& points, int resolution_bits, FrameForm form);

/// How often the set-points come. XY2-100 heads take 100 kHz at its 2 MHz clock.
Rational frame_rate_hz(const LineTiming& timing);

/// A file of frames.
struct FrameStream {
  FrameForm form = FrameForm::bits16;
  std::vector<FramePosition> frames;
};

/// "GXY2", version 1, the position bits, two zero bytes, the number of frames (8 bytes, lowest first), then for each
/// frame U and V in 3 bytes each, highest first, the frame in the low bits.
std::string encode_stream(const FrameStream& stream);
/// The same in pieces: what stands before so many frames, and frames.
std::string encode_stream_start(FrameForm form, std::uint64_t frames);
void append_frames(FrameForm form, const std::vector<FramePosition>& frames, std::string& bytes);

/// Checks every frame. Fails with bad_file (version_mismatch for another version), naming the frame and the channel.
Result<FrameStream> decode_stream(std::string_view bytes);

}  // namespace gravure::scan
