#include "gravure/formats/waves.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "gravure/fpga/edge_stream.hpp"

namespace gravure::formats {
namespace {

using fpga::AbEdge;
using fpga::AbPins;
using fpga::AbRegisters;

constexpr AbRegisters kPublished{.bits = 6, .prescaler = 3, .increment = 7};

TEST(CsvEdges, GivesThePublishedEdges) {
  std::string csv;
  append_csv_header(csv);
  stream_edges(kPublished, 0, 36, [&csv](const AbEdge& edge) {
    append_csv_edge(csv, edge);
    return true;
  });
  EXPECT_EQ(csv, "tick,a,b\n9,0,1\n15,1,1\n21,1,0\n30,0,0\n36,0,1\n");
}

TEST(CsvEdges, WritesTheLargestClock) {
  std::string csv;
  append_csv_edge(csv, {~std::uint64_t{0}, {true, false}});
  EXPECT_EQ(csv, "18446744073709551615,1,0\n");
}

std::string published_vcd(const VcdTime& time) {
  auto writer = VcdWriter::make(time);
  EXPECT_TRUE(writer);
  std::string vcd;
  EXPECT_TRUE(writer.value().begin(vcd, 0, AbPins{}));
  stream_edges(kPublished, 0, 36, [&](const AbEdge& edge) { return bool(writer.value().edge(vcd, edge)); });
  EXPECT_TRUE(writer.value().end(vcd, 36));
  return vcd;
}

TEST(VcdWriter, WritesThePublishedEdges) {
  EXPECT_EQ(published_vcd({.timescale = "10 ns"}), R"($comment 1 FPGA tick = 1/1 x 10 ns, times rounded down $end
$timescale 10 ns $end
$scope module ab $end
$var wire 1 ! a $end
$var wire 1 " b $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
0!
0"
$end
#9
1"
#15
1!
#21
0"
#30
0!
#36
1"
)");
}

/// 164 MHz: one tick is 250000/41 ps.
TEST(VcdWriter, ScalesTicksExactlyAndRoundsDown) {
  const std::string vcd = published_vcd({.timescale = "1 ps", .units_num = 250'000, .units_den = 41});
  EXPECT_NE(vcd.find("1 FPGA tick = 250000/41 x 1 ps"), std::string::npos);
  EXPECT_NE(vcd.find("\n#54878\n1\"\n"), std::string::npos);  // 9 ticks = 54878.05 ps
}

TEST(VcdWriter, StartsWithThePinsAsTheyStand) {
  auto writer = VcdWriter::make({});
  std::string vcd;
  ASSERT_TRUE(writer.value().begin(vcd, 21, {true, false}));
  EXPECT_NE(vcd.find("#21\n$dumpvars\n1!\n0\"\n$end\n"), std::string::npos);
}

TEST(VcdWriter, RefusesATimescaleViewersDoNotKnow) {
  for (const char* timescale : {"", "2 ns", "1000 ps", "1ns", "1 ", "1 h", "1 ns ", "10  ns"}) {
    const auto writer = VcdWriter::make({.timescale = timescale});
    ASSERT_FALSE(writer) << timescale;
    EXPECT_EQ(writer.error().code, ErrorCode::bad_argument);
    EXPECT_NE(writer.error().message.find("timescale"), std::string::npos);
  }
}

TEST(VcdWriter, RefusesATimescaleCoarserThanATick) {
  for (const VcdTime& time : {VcdTime{"1 ns", 1, 2}, VcdTime{"1 ns", 1, 0}, VcdTime{"1 ns", 0, 1}}) {
    const auto writer = VcdWriter::make(time);
    ASSERT_FALSE(writer);
    EXPECT_EQ(writer.error().code, ErrorCode::bad_argument);
  }
}

TEST(VcdWriter, RefusesATimeBeyondSixtyFourBits) {
  auto writer = VcdWriter::make({.timescale = "1 fs", .units_num = 6'000'000});
  std::string vcd;
  const auto result = writer.value().edge(vcd, {~std::uint64_t{0}, {false, true}});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::out_of_range);
  EXPECT_TRUE(vcd.empty());
}

TEST(WaveDump, WritesVectorsAndSharesATimeBetweenSignals) {
  auto dump = WaveDump::make({}, "machine", {{.name = "gate"}, {.name = "line", .bits = 32}});
  ASSERT_TRUE(dump);
  std::string vcd;
  const std::array<std::uint64_t, 2> first = {0, 0};
  ASSERT_TRUE(dump.value().begin(vcd, 5, first));
  const std::size_t head = vcd.size();
  EXPECT_NE(vcd.find("$scope module machine $end\n$var wire 1 ! gate $end\n$var wire 32 \" line $end\n"),
            std::string::npos);
  EXPECT_NE(vcd.find("#5\n$dumpvars\n0!\nb0 \"\n$end\n"), std::string::npos);
  ASSERT_TRUE(dump.value().change(vcd, 5, 0, 1));
  ASSERT_TRUE(dump.value().change(vcd, 9, 0, 0));
  ASSERT_TRUE(dump.value().change(vcd, 9, 1, 10));
  ASSERT_TRUE(dump.value().change(vcd, 11, 1, 10));
  ASSERT_TRUE(dump.value().end(vcd, 12));
  EXPECT_EQ(vcd.substr(head), "1!\n#9\n0!\nb1010 \"\n#12\n");
}

TEST(WaveDump, GivesNoTimeTwiceWhereTheLastChangeIsTheEnd) {
  auto dump = WaveDump::make({}, "machine", {{.name = "gate"}});
  ASSERT_TRUE(dump);
  const std::array<std::uint64_t, 1> first = {0};
  std::string vcd;
  ASSERT_TRUE(dump.value().begin(vcd, 5, first));
  const std::size_t head = vcd.size();
  ASSERT_TRUE(dump.value().end(vcd, 5));
  EXPECT_EQ(vcd.substr(head), "");
  ASSERT_TRUE(dump.value().change(vcd, 9, 0, 1));
  ASSERT_TRUE(dump.value().end(vcd, 9));
  EXPECT_EQ(vcd.substr(head), "#9\n1!\n");
}

TEST(WaveDump, RefusesSignalsThatViewersCannotShow) {
  for (const WaveSignal& signal : {WaveSignal{"", 1}, WaveSignal{"a b", 1}, WaveSignal{"a", 0}, WaveSignal{"a", 65}}) {
    const auto dump = WaveDump::make({}, "machine", {signal});
    ASSERT_FALSE(dump);
    EXPECT_EQ(dump.error().code, ErrorCode::bad_argument);
  }
  EXPECT_FALSE(WaveDump::make({}, "machine", std::vector<WaveSignal>(WaveDump::kMaxSignals + 1, {.name = "a"})));
}

}  // namespace
}  // namespace gravure::formats
