#include <functional>

#include "grv_support.hpp"

namespace gravure {
namespace {

using namespace grv_test;

/// Four layers, of which the first and the third, and the second and the fourth, share their bits.
Program sharing_program() {
  Program program = make_program(100, 23, {Picture::noise, Picture::stripes}, false);
  ProgramHeader& header = program.header;
  header.layers.push_back(header.layers[0]);
  header.layers.push_back(header.layers[1]);
  header.layers[2].source = 1;
  header.layers[3].level = 9;
  header.layer_of_revolution = {0, 1, 2, 3, 2};
  header.bits_of_layer = {0, 1, 0, 1};
  return program;
}

TEST(GrvParts, GivesTheSharedBitsForEachLayerThatUsesThem) {
  const Folder folder;
  const Program program = sharing_program();
  for (const Compression compression : {Compression::zstd, Compression::deflate, Compression::none}) {
    expect_ok(write_program(folder.file("a.grv"), program, {.compression = compression, .chunk_bytes = 100}));
    const auto source = open_grv(folder.file("a.grv"));
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(source.value()->header().bits_of_layer, program.header.bits_of_layer);
    EXPECT_EQ(source.value()->header().layers[3].level, 9);
    const auto bits = read_bits(*source.value());
    ASSERT_TRUE(bits) << bits.error().message;
    EXPECT_EQ(bits.value(),
              (std::vector<Bytes>{program.layers[0], program.layers[1], program.layers[0], program.layers[1]}));
    const auto beyond = source.value()->fetch({4, 0});
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().code, ErrorCode::bad_argument);
  }
}

TEST(GrvParts, RefusesLayersWhoseSharingCannotBe) {
  const Folder folder;
  const auto refused = [&](const std::function<void(ProgramHeader&)>& spoil) {
    Program program = sharing_program();
    spoil(program.header);
    const Result<void> written = write_program(folder.file("a.grv"), program, {});
    EXPECT_FALSE(written);
    return written ? ErrorCode::io : written.error().code;
  };
  EXPECT_EQ(refused([](ProgramHeader& header) { header.bits_of_layer[2] = 2; }), ErrorCode::bad_argument);
  EXPECT_EQ(refused([](ProgramHeader& header) { header.bits_of_layer = {1, 0, 0, 1}; }), ErrorCode::bad_argument);
  EXPECT_EQ(refused([](ProgramHeader& header) { header.bits_of_layer = {0, 0, 0, 0}; }), ErrorCode::bad_argument);
  EXPECT_EQ(refused([](ProgramHeader& header) { header.bits_of_layer.pop_back(); }), ErrorCode::bad_argument);
  EXPECT_EQ(refused([](ProgramHeader& header) { header.layers[2].fired_pixels += 1; }), ErrorCode::bad_argument);
  EXPECT_EQ(refused([](ProgramHeader& header) { header.layer_of_revolution[4] = 4; }), ErrorCode::bad_argument);
}

Program shard_program(std::int64_t first, std::int64_t end) {
  Program program = make_program(100, 23, {Picture::noise, Picture::stripes});
  ProgramHeader& header = program.header;
  header.shard = Shard{first, end, 7};
  header.layer_of_revolution.resize(static_cast<std::size_t>(end - first));
  return program;
}

TEST(GrvParts, OpensAShardOnlyWhereShardsAreWanted) {
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), shard_program(1, 4), {.compression = Compression::none}));
  const auto refused = open_grv(folder.file("a.grv"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::bad_file);
  EXPECT_NE(refused.error().message.find("revolutions 1 to 3 of 5: put all"), std::string::npos)
      << refused.error().message;
  const auto part = open_grv_part(folder.file("a.grv"));
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_EQ(part.value().compression, Compression::none);
  EXPECT_EQ(part.value().lines->header().shard, (Shard{1, 4, 7}));
  EXPECT_EQ(part.value().lines->header().layer_of_revolution.size(), 3U);
}

TEST(GrvParts, OpensAProgramAsAPartToo) {
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), make_program(9, 4, {Picture::noise}), {}));
  const auto part = open_grv_part(folder.file("a.grv"));
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_FALSE(part.value().lines->header().shard);
}

TEST(GrvParts, RefusesAShardOfRevolutionsThatTheJobHasNot) {
  const Folder folder;
  for (const Shard& shard : {Shard{-1, 2, 1}, Shard{2, 2, 1}, Shard{3, 6, 1}, Shard{0, 2, 0}}) {
    Program program = shard_program(0, 3);
    program.header.shard = shard;
    program.header.layer_of_revolution.resize(
        static_cast<std::size_t>(std::max<std::int64_t>(0, shard.end - shard.first)));
    const Result<void> written = write_program(folder.file("a.grv"), program, {});
    ASSERT_FALSE(written) << shard.first << " to " << shard.end;
    EXPECT_EQ(written.error().code, ErrorCode::bad_argument);
  }
}

TEST(GrvParts, RefusesAShardThatIsGivenOutForAProgram) {
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), shard_program(0, 5), {}));
  expect_ok(write_program(folder.file("b.grv"), make_program(100, 23, {Picture::noise, Picture::stripes}), {}));
  Bytes shard = load(folder.file("a.grv"));
  const Bytes program = load(folder.file("b.grv"));
  std::copy_n(program.begin(), 16, shard.begin());
  save(folder.file("a.grv"), shard);
  const auto source = open_grv(folder.file("a.grv"));
  ASSERT_FALSE(source);  // the seal's own checksum covers its name
  EXPECT_EQ(source.error().code, ErrorCode::bad_file);
}

}  // namespace
}  // namespace gravure
