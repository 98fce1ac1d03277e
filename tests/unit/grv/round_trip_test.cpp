#include <thread>

#include "gravure/formats/plan_json.hpp"
#include "grv_support.hpp"

namespace gravure {
namespace {

using namespace grv_test;

void expect_same_files(const std::vector<SourceImage>& found, const std::vector<SourceImage>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found[i].path, expected[i].path);
    EXPECT_EQ(found[i].page, expected[i].page);
    EXPECT_EQ(found[i].width, expected[i].width);
    EXPECT_EQ(found[i].height, expected[i].height);
    EXPECT_EQ(found[i].sha256, expected[i].sha256);
  }
}

void expect_same_header(const ProgramHeader& found, const ProgramHeader& expected) {
  EXPECT_EQ(plan_to_json(found.plan), plan_to_json(expected.plan));
  EXPECT_EQ(found.format_version, expected.format_version);
  EXPECT_EQ(found.job_text, expected.job_text);
  EXPECT_EQ(found.job_path, expected.job_path);
  EXPECT_EQ(found.fires, expected.fires);
  EXPECT_EQ(found.lines_along, expected.lines_along);
  EXPECT_EQ(found.layer_of_revolution, expected.layer_of_revolution);
  expect_same_files(found.sources, expected.sources);
  expect_same_files(found.files, expected.files);
  ASSERT_EQ(found.layers.size(), expected.layers.size());
  for (std::size_t i = 0; i < expected.layers.size(); ++i) {
    EXPECT_EQ(found.layers[i].starts_reverse, expected.layers[i].starts_reverse);
    EXPECT_EQ(found.layers[i].fired_pixels, expected.layers[i].fired_pixels);
    EXPECT_EQ(found.layers[i].source, expected.layers[i].source);
    EXPECT_EQ(found.layers[i].level, expected.layers[i].level);
  }
}

void expect_round_trip(const Program& program, const GrvOptions& options) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, program, options));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.grv"});
  auto source = open_grv(path);
  ASSERT_TRUE(source) << source.error().message;
  expect_same_header(source.value()->header(), program.header);
  auto bits = read_bits(*source.value());
  ASSERT_TRUE(bits) << bits.error().message;
  EXPECT_EQ(bits.value(), program.layers);
}

constexpr Compression kAll[] = {Compression::zstd, Compression::deflate, Compression::none};

TEST(Grv, GivesBackWhatWasPutForEveryWidthPictureAndCompression) {
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << test_seed());
  const std::vector<std::vector<Picture>> stacks = {
      {Picture::noise},
      {Picture::blank, Picture::dither},
      {Picture::stripes, Picture::noise, Picture::blank},
  };
  for (const Compression compression : kAll) {
    for (const std::int64_t pixels : {1, 7, 8, 9, 3500}) {
      for (const auto& stack : stacks) {
        SCOPED_TRACE(testing::Message() << pixels << " px, " << stack.size() << " layers, compression "
                                        << static_cast<int>(compression));
        // 41 lines in chunks of some 2000 bytes: one chunk, many, a shorter last one, lines longer than a chunk
        expect_round_trip(make_program(pixels, 41, stack), {.compression = compression, .chunk_bytes = 2000});
      }
    }
  }
}

TEST(Grv, GivesBackALineLongerThanAChunk) {
  const Program program = make_program(3500, 5, {Picture::noise, Picture::stripes});
  const Folder folder;
  auto sink = start(folder.file("a.grv"), program, {.chunk_bytes = 100});
  ASSERT_TRUE(sink);
  EXPECT_EQ(sink.value()->lines_per_chunk(), 1);
  expect_round_trip(program, {.chunk_bytes = 100});
}

TEST(Grv, GivesBackASingleLineOfASinglePixel) {
  for (const Compression compression : kAll) {
    expect_round_trip(make_program(1, 1, {Picture::noise}, false), {.compression = compression});
  }
}

TEST(Grv, GivesBackEmptyTextsAndNoSources) {
  Program program = make_program(9, 4, {Picture::noise});
  program.header.job_text.clear();
  program.header.job_path.clear();
  program.header.sources.clear();
  expect_round_trip(program, {});
}

TEST(Grv, GivesBackTheFilesThatTheJobNamesBesideItsImages) {
  Program program = make_program(9, 4, {Picture::noise});
  program.header.files = {{"field.grid", 0, 0, 0, std::string(64, 'a')},
                          {"../machines/of another folder.toml", 0, 0, 0, std::string(64, 'b')}};
  expect_round_trip(program, {});
  program.header.sources.clear();
  expect_round_trip(program, {});
}

TEST(Grv, GivesBackAJobTextWithNulAndTrailingZeros) {
  Program program = make_program(9, 4, {Picture::noise});
  program.header.job_text = std::string("a\0b\0\0", 5);
  expect_round_trip(program, {});
}

TEST(Grv, CutsLayersIntoChunksOfAboutAQuarterMebibyteByDefault) {
  const Folder folder;
  auto sink = create_grv(folder.file("a.grv"), 1, 27'489, 438);
  ASSERT_TRUE(sink) << sink.error().message;
  const std::int64_t lines = sink.value()->lines_per_chunk();
  EXPECT_LE(lines * 438, std::int64_t{1} << 18);
  EXPECT_GE(lines * 438, std::int64_t{9} << 14);
}

TEST(Grv, GivesAnyChunkWithoutTheOthers) {
  const Program program = make_program(800, 100, {Picture::noise, Picture::dither});
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, program, {.chunk_bytes = 1000}));
  auto source = open_grv(path);
  ASSERT_TRUE(source);
  std::vector<ChunkAddress> order = addresses(program, source.value()->lines_per_chunk());
  std::shuffle(order.begin(), order.end(), std::mt19937(test_seed()));
  for (const ChunkAddress address : order) {
    const auto expected = lines_of(program, address, source.value()->lines_per_chunk());
    const auto chunk = source.value()->fetch(address);
    ASSERT_TRUE(chunk);
    EXPECT_EQ(chunk.value().fired_pixels, count_set({expected.begin(), expected.end()}));
    Bytes out(expected.size());
    expect_ok(source.value()->decode(chunk.value(), out));
    EXPECT_TRUE(std::equal(out.begin(), out.end(), expected.begin(), expected.end()));
  }
}

TEST(Grv, StoresAChunkRawWhereCompressionSavesLessThanATenth) {
  const Program program = make_program(800, 40, {Picture::noise, Picture::stripes});
  const Folder folder;
  for (const Compression compression : {Compression::zstd, Compression::deflate}) {
    auto sink = start(folder.file("a.grv"), program, {.compression = compression});
    ASSERT_TRUE(sink);
    const auto noise = sink.value()->encode({0, 0}, program.layers[0]);
    const auto stripes = sink.value()->encode({1, 0}, program.layers[1]);
    ASSERT_TRUE(noise && stripes);
    EXPECT_EQ(noise.value().filter_mask, 1U);
    EXPECT_EQ(noise.value().bytes, program.layers[0]);
    EXPECT_EQ(stripes.value().filter_mask, 0U);
    EXPECT_LT(stripes.value().bytes.size(), program.layers[1].size() / 10);
  }
}

TEST(Grv, WritesTheSameBytesForTheSameProgramWhateverTheThreads) {
  const Program program = make_program(800, 1000, {Picture::dither, Picture::stripes, Picture::noise});
  const Folder folder;
  const GrvOptions options{.chunk_bytes = 4000};
  expect_ok(write_program(folder.file("one.grv"), program, options));
  auto sink = start(folder.file("four.grv"), program, options);
  ASSERT_TRUE(sink);
  const std::int64_t per_chunk = sink.value()->lines_per_chunk();
  const auto all = addresses(program, per_chunk);
  std::vector<Result<StoredChunk>> chunks(all.size(), Result<StoredChunk>(StoredChunk{}));
  {
    std::vector<std::jthread> workers;
    for (std::size_t worker = 0; worker < 4; ++worker) {
      workers.emplace_back([&, worker] {
        for (std::size_t i = worker; i < all.size(); i += 4) {
          chunks[i] = sink.value()->encode(all[i], lines_of(program, all[i], per_chunk));
        }
      });
    }
  }
  for (const auto& chunk : chunks) {
    ASSERT_TRUE(chunk);
    expect_ok(sink.value()->put(chunk.value()));
  }
  expect_ok(sink.value()->finish(program.header));
  EXPECT_EQ(load(folder.file("one.grv")), load(folder.file("four.grv")));
}

TEST(Grv, DecodesOnSeveralThreads) {
  const Program program = make_program(800, 400, {Picture::dither, Picture::stripes});
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), program, {.chunk_bytes = 1000}));
  auto source = open_grv(folder.file("a.grv"));
  ASSERT_TRUE(source);
  const std::int64_t per_chunk = source.value()->lines_per_chunk();
  std::vector<StoredChunk> chunks;
  for (const ChunkAddress address : addresses(program, per_chunk)) {
    auto chunk = source.value()->fetch(address);
    ASSERT_TRUE(chunk);
    chunks.push_back(std::move(chunk).value());
  }
  std::vector<int> good(4, 0);
  {
    std::vector<std::jthread> workers;
    for (std::size_t worker = 0; worker < good.size(); ++worker) {
      workers.emplace_back([&, worker] {
        for (const StoredChunk& chunk : chunks) {
          const auto expected = lines_of(program, chunk.address, per_chunk);
          Bytes out(expected.size());
          const bool fine = static_cast<bool>(source.value()->decode(chunk, out));
          good[worker] += fine && std::equal(out.begin(), out.end(), expected.begin(), expected.end()) ? 1 : 0;
        }
      });
    }
  }
  EXPECT_EQ(good, std::vector<int>(4, static_cast<int>(chunks.size())));
}

}  // namespace
}  // namespace gravure
