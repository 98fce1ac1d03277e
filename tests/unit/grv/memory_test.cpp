#include "counted_memory.hpp"
#include "grv_support.hpp"

namespace gravure {
namespace {

using namespace grv_test;
using test::held_bytes;
using test::peak_bytes;

constexpr std::int64_t kLines = 20'000;  // a chunk each
constexpr std::int64_t kTableBytes = 32 * kLines;
constexpr std::int64_t kUnbounded = std::int64_t{1} << 40;

class GrvMemory : public testing::Test {
 protected:
  void SetUp() override {
    expect_ok(write_program(path_, program_, {.compression = Compression::none, .chunk_bytes = 1}));
    ASSERT_TRUE(open_grv(path_));  // what the HDF5 library keeps for good is there before anything is counted
  }

  Program program_ = make_program(8, kLines, {Picture::noise});
  Folder folder_;
  std::string path_ = folder_.file("a.grv");
};

TEST_F(GrvMemory, HoldsItsTablesOnceHoweverManyReadIt) {
  const std::int64_t before = held_bytes;
  const Result<GrvProgram> opened = GrvProgram::open(path_, kUnbounded);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened.value().table_bytes(), kTableBytes);
  const std::int64_t one = held_bytes - before;
  EXPECT_GE(one, kTableBytes) << "the meter does not run";
  EXPECT_LT(one, kTableBytes + kTableBytes / 10);
  std::vector<std::unique_ptr<LineSource>> readers;
  for (int i = 0; i < 8; ++i) {
    readers.push_back(opened.value().reader());
  }
  EXPECT_LT(held_bytes - before - one, kTableBytes / 20);
  for (const std::unique_ptr<LineSource>& reader : readers) {
    EXPECT_EQ(&reader->header(), &opened.value().header());
    const auto bits = read_bits(*reader);
    ASSERT_TRUE(bits) << bits.error().message;
    EXPECT_EQ(bits.value(), program_.layers);
  }
}

TEST_F(GrvMemory, ReadersLiveOnWithoutTheProgramTheyCameFrom) {
  std::unique_ptr<LineSource> reader;
  {
    const Result<GrvProgram> opened = GrvProgram::open(path_, kUnbounded);
    ASSERT_TRUE(opened) << opened.error().message;
    reader = opened.value().reader();
  }
  const auto bits = read_bits(*reader);
  ASSERT_TRUE(bits) << bits.error().message;
  EXPECT_EQ(bits.value(), program_.layers);
}

TEST_F(GrvMemory, IsRefusedBeforeTablesAreReadThatDoNotFitTheBudget) {
  ASSERT_TRUE(GrvProgram::open(path_, kTableBytes));
  const std::int64_t before = held_bytes;
  peak_bytes = before;
  const Result<GrvProgram> refused = GrvProgram::open(path_, kTableBytes - 1);
  EXPECT_LT(peak_bytes - before, kTableBytes / 8);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_range);
  EXPECT_EQ(refused.error().message,
            path_ + ": memory budget of 0 MiB: the tables of its 20000 chunks alone take 1 MiB: raise --memory");
}

}  // namespace
}  // namespace gravure
