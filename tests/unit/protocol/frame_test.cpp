#include "gravure/protocol/frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "dice.hpp"
#include "gravure/fpga/frame_parser.hpp"
#include "worked_bytes.hpp"

namespace gravure::protocol {
namespace {

using test::Dice;

static_assert(kFrameBytes == fpga::FrameParser::kFrameBytes, "host and board agree on the size of a frame");

std::vector<std::byte> bits_of(std::initializer_list<int> values) {
  std::vector<std::byte> bits;
  for (const int value : values) {
    bits.push_back(static_cast<std::byte>(value));
  }
  return bits;
}

std::vector<std::byte> frame_of(const FrameHead& head, std::span<const std::byte> bits) {
  std::vector<std::byte> stream;
  append_frame(stream, head, bits);
  return stream;
}

TEST(Frame, WritesTheWorkedBytesOfTheDocumentation) {
  EXPECT_EQ(frame_of({0, 0, 0, 9}, bits_of({0xFF, 0xE0})), worked_bytes("line frame"));
}

TEST(Frame, IsTakenByTheBoardsParser) {
  fpga::FrameParser parser;
  fpga::FrameParser::Inputs in;
  in.slots_per_line = 20;
  in.window_slots = 11;
  in.lines_per_revolution = 2;
  in.rst = true;
  parser.step(in);
  in.rst = false;
  for (int clock = 0; clock < 8; ++clock) {  // sums of the settings
    parser.step(in);
  }
  std::vector<std::byte> stream;
  append_frame(stream, {0, 0, 0, 9}, bits_of({0xFF, 0xE0}));
  append_frame(stream, {1, 0, 1, 3}, bits_of({0x12, 0x20}));
  append_frame(stream, {2, 1, 0, 0}, bits_of({0x00, 0x00}));
  int commits = 0;
  in.in_valid = true;
  for (std::size_t i = 0; i < stream.size() + 8; ++i) {
    in.in_valid = i < stream.size();
    in.in_data = in.in_valid ? std::to_integer<std::uint8_t>(stream[i]) : std::uint8_t{0};
    const auto out = parser.step(in);
    commits += out.commit ? 1 : 0;
    EXPECT_FALSE(out.sequence_error || out.shape_error || out.checksum_error) << "byte " << i;
  }
  EXPECT_EQ(commits, 3);
}

TEST(Frame, IsReadAsItWasWrittenWhereverTheStreamIsCut) {
  Dice dice;
  SCOPED_TRACE(Dice::note());
  for (int trial = 0; trial < 50; ++trial) {
    FrameHead head;
    for (std::uint32_t* field : {&head.sequence, &head.revolution, &head.line, &head.first_slot}) {
      *field = trial == 0 ? 0xFFFFFFFFU : static_cast<std::uint32_t>(dice.word());
    }
    std::vector<std::byte> bits(static_cast<std::size_t>(dice.between(0, 40)));
    std::generate(bits.begin(), bits.end(), [&] { return static_cast<std::byte>(dice.word()); });
    std::vector<std::byte> stream = frame_of(head, bits);
    const std::size_t size = stream.size();
    append_frame(stream, head, bits);
    for (std::size_t cut = 0; cut < size; ++cut) {
      const auto part = decode_frame(std::span(stream).first(cut));
      ASSERT_TRUE(part) << part.error().message;
      ASSERT_FALSE(part.value()) << "after " << cut << " of " << size << " bytes";
    }
    const auto whole = decode_frame(stream);
    ASSERT_TRUE(whole && whole.value());
    EXPECT_EQ(whole.value()->head, head);
    EXPECT_EQ(whole.value()->size(), size);
    EXPECT_TRUE(std::equal(bits.begin(), bits.end(), whole.value()->bits.begin(), whole.value()->bits.end()));
  }
}

TEST(Frame, EveryFlippedBitIsSeen) {
  const std::vector<std::byte> right = frame_of({4, 1, 2, 3}, bits_of({0xFF, 0xE0}));
  for (std::size_t bit = 0; bit < 8 * right.size(); ++bit) {
    std::vector<std::byte> wrong = right;
    wrong[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    const auto read = decode_frame(wrong);
    EXPECT_FALSE(read && read.value()) << "bit " << bit;  // a longer length waits for bytes
    EXPECT_TRUE(read || read.error().code == ErrorCode::device);
  }
}

TEST(Frame, RefusesALengthThatNoWindowHas) {
  std::vector<std::byte> stream = frame_of({}, {});
  const std::size_t length_at = 21;
  stream[length_at + 2] = std::byte{0x20};  // 2^21 bytes: the longest
  EXPECT_TRUE(decode_frame(stream));
  stream[length_at] = std::byte{1};
  const auto read = decode_frame(stream);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("2097153 bytes of bits, at most 2097152"), std::string::npos);
}

}  // namespace
}  // namespace gravure::protocol
