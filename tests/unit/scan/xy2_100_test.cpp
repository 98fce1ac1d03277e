#include <gtest/gtest.h>

#include <algorithm>

#include "gravure/scan/xy2_100.hpp"
#include "roller.hpp"

namespace gravure::scan {
namespace {

constexpr FrameForm kForms[] = {FrameForm::bits16, FrameForm::bits18, FrameForm::bits20};

std::int32_t half_of(FrameForm form) {
  return std::int32_t{1} << (position_bits(form) - 1);
}

TEST(Xy2Frames, OfTheCentreAndTheEndsAreAsPublished) {
  // 0 0 1, 1000..., even: the control bit and the highest data bit are two ones, parity 0.
  EXPECT_EQ(encode_frame(FrameForm::bits16, 0), 0b0011'0000'0000'0000'0000U);
  EXPECT_EQ(encode_frame(FrameForm::bits16, -32768), 0b0010'0000'0000'0000'0001U);
  EXPECT_EQ(encode_frame(FrameForm::bits16, 32767), 0b0011'1111'1111'1111'1111U);
  // 1, 1000..., odd: parity 1.
  EXPECT_EQ(encode_frame(FrameForm::bits18, 0), 0b1100'0000'0000'0000'0001U);
  EXPECT_EQ(encode_frame(FrameForm::bits18, -131072), 0b1000'0000'0000'0000'0000U);
  // 0 1, 1000..., one one: 01; all ones: twenty, 00.
  EXPECT_EQ(encode_frame(FrameForm::bits20, 0), 0b0110'0000'0000'0000'0000'0001U);
  EXPECT_EQ(encode_frame(FrameForm::bits20, 524287), 0b0111'1111'1111'1111'1111'1100U);
}

/// A receiver of its own: takes the bits off the wire one after the other, first bit first.
std::int32_t receive(const std::string& wire, FrameForm form) {
  std::size_t at = 0;
  const auto take = [&wire, &at](int bits) {
    std::int32_t value = 0;
    for (int k = 0; k < bits; ++k) {
      value = 2 * value + (wire[at++] - '0');
    }
    return value;
  };
  const auto ones = std::count(wire.begin(), wire.end(), '1');
  switch (form) {
    case FrameForm::bits16:
      EXPECT_EQ(take(3), 1);
      EXPECT_EQ(ones % 2, 0);
      return take(16) - 32768;
    case FrameForm::bits18:
      EXPECT_EQ(take(1), 1);
      EXPECT_EQ(ones % 2, 1);
      return take(18) - 131072;
    case FrameForm::bits20:
      break;
  }
  EXPECT_EQ(take(2), 1);
  const auto counted = std::count(wire.begin() + 2, wire.begin() + 22, '1');
  const std::int32_t value = take(20) - 524288;
  EXPECT_EQ(take(2), counted % 4);
  return value;
}

TEST(Xy2Frames, AreReadBitByBitByAReceiverOfItsOwn) {
  for (const FrameForm form : kForms) {
    for (std::int32_t count = -half_of(form); count < half_of(form); count += 37) {
      const std::uint32_t word = encode_frame(form, count);
      std::string wire;
      for (int bit = frame_bits(form) - 1; bit >= 0; --bit) {
        wire.push_back((word >> bit & 1U) != 0 ? '1' : '0');
      }
      ASSERT_EQ(receive(wire, form), count);
      ASSERT_EQ(word >> frame_bits(form), 0U);
    }
  }
}

TEST(Xy2Frames, EveryPositionComesBack) {
  for (const FrameForm form : kForms) {
    for (std::int32_t count = -half_of(form); count < half_of(form); ++count) {
      const auto decoded = decode_frame(form, encode_frame(form, count));
      ASSERT_TRUE(decoded && decoded.value() == count) << count;
    }
  }
}

TEST(Xy2Frames, EveryFlippedBitIsSeen) {
  for (const FrameForm form : kForms) {
    for (std::int32_t count = -half_of(form); count < half_of(form); count += 1009) {
      for (int bit = 0; bit < 32; ++bit) {
        const auto decoded = decode_frame(form, encode_frame(form, count) ^ 1U << bit);
        ASSERT_FALSE(decoded) << count << " bit " << bit;
        ASSERT_EQ(decoded.error().code, ErrorCode::bad_file);
      }
    }
  }
}

TEST(Xy2Frames, AreChosenByResolution) {
  EXPECT_EQ(frame_form_for(12).value(), FrameForm::bits16);
  EXPECT_EQ(frame_form_for(16).value(), FrameForm::bits16);
  EXPECT_EQ(frame_form_for(17).value(), FrameForm::bits18);
  EXPECT_EQ(frame_form_for(20).value(), FrameForm::bits20);
  EXPECT_FALSE(frame_form_for(21));
}

LineTrajectory roller(int resolution_bits) {
  kinematics::ScanHead head = test::roller_head();
  head.resolution_bits = resolution_bits;
  return make_line_trajectory(test::roller_timing(), test::roller_geometry(test::roller_timing(), head), {}).value();
}

TEST(Xy2Stream, OfALineComesBackAsItsSetPoints) {
  for (const FrameForm form : kForms) {
    const LineTrajectory trajectory = roller(position_bits(form));
    for (const Direction direction : {Direction::forward, Direction::reverse}) {
      const auto frames = frames_of(trajectory, direction, form);
      ASSERT_TRUE(frames) << frames.error().message;
      const std::string bytes = encode_stream({form, frames.value()});
      EXPECT_EQ(bytes.size(), 16U + 6 * 270);
      const auto stream = decode_stream(bytes);
      ASSERT_TRUE(stream) << stream.error().message;
      EXPECT_EQ(stream.value().form, form);
      ASSERT_EQ(stream.value().frames.size(), 270U);
      for (std::size_t k = 0; k < 270; ++k) {
        const SetPoint& point = trajectory.set_points(direction)[k];
        EXPECT_EQ(stream.value().frames[k], (FramePosition{point.u_count, point.v_count}));
      }
    }
  }
  EXPECT_EQ(frame_rate_hz(test::roller_timing()), 100'000) << "20 slots of 0.5 us: what XY2-100 heads take";
}

TEST(Xy2Stream, NarrowScannersAreShiftedUpAndWideOnesRefused) {
  const LineTrajectory trajectory = roller(16);
  const auto frames = frames_of(trajectory, Direction::forward, FrameForm::bits20).value();
  EXPECT_EQ(frames[100].u_count, 16 * trajectory.forward[100].u_count);
  const auto refused = frames_of(roller(20), Direction::forward, FrameForm::bits18);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("resolution_bits = 20"), std::string::npos) << refused.error().message;
}

TEST(Xy2Stream, DamageIsNamedByFrameAndChannel) {
  const std::string good = encode_stream({FrameForm::bits16, {{1, 2}, {3, 4}, {5, 6}}});
  ASSERT_TRUE(decode_stream(good));
  std::string damaged = good;
  damaged[16 + 6 + 5] = static_cast<char>(damaged[16 + 6 + 5] ^ 4);
  const auto refused = decode_stream(damaged);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("frame 1, channel V"), std::string::npos) << refused.error().message;
  for (std::size_t cut = 0; cut < good.size(); ++cut) {
    EXPECT_FALSE(decode_stream(good.substr(0, cut))) << cut;
  }
  EXPECT_FALSE(decode_stream(good + "x"));
  for (const std::size_t at : {0U, 5U, 6U, 7U, 8U, 15U}) {
    std::string other = good;
    other[at] = static_cast<char>(other[at] ^ 2);
    EXPECT_FALSE(decode_stream(other)) << at;
  }
  std::string version = good;
  version[4] = 2;
  EXPECT_EQ(decode_stream(version).error().code, ErrorCode::version_mismatch);
}

TEST(Xy2Stream, RefusesSetPointsBeyondTheFieldAndNamesTheFirst) {
  const std::vector<SetPoint> inside = {{0, 0, -32'768, 32'767}, {0, 0, 0, 0}};
  EXPECT_TRUE(frames_of(inside, 16, FrameForm::bits16));
  for (const SetPoint& beyond : {SetPoint{0, 0, 32'768, 0}, SetPoint{0, 0, 0, -32'769}}) {
    std::vector<SetPoint> points = inside;
    points.push_back(beyond);
    points.push_back(beyond);
    const auto refused = frames_of(points, 16, FrameForm::bits20);
    ASSERT_FALSE(refused) << "not shifted into the wider frame either";
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
    EXPECT_NE(refused.error().message.find("set-point 2 at"), std::string::npos) << refused.error().message;
  }
}

TEST(Xy2Stream, WritesStreamsInPieces) {
  const FrameStream stream{FrameForm::bits18, {{1, -2}, {131'071, -131'072}, {0, 3}}};
  std::string pieces = encode_stream_start(stream.form, 3);
  append_frames(stream.form, {stream.frames[0]}, pieces);
  append_frames(stream.form, {stream.frames[1], stream.frames[2]}, pieces);
  EXPECT_EQ(pieces, encode_stream(stream));
  EXPECT_EQ(decode_stream(pieces).value().frames, stream.frames);
}

}  // namespace
}  // namespace gravure::scan
