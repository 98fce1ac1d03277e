#include "gravure/pipeline/merge.hpp"

#include <xxhash.h>

#include <algorithm>

#include "pipeline_support.hpp"

namespace gravure::test {
namespace {

constexpr std::int64_t kLines = 11;  // odd: revolutions start in turn to the right and to the left
constexpr std::int64_t kPixels = 21;

/// A job of as many revolutions as layers, and some of them as a shard.
struct Parts {
  std::vector<MemoryProgram> programs;
  std::vector<MemorySource> sources;
  std::vector<MergePart> parts;

  void add(MemoryProgram program) {
    for (auto& [address, chunk] : program.chunks) {  // as a sink that writes a file does
      chunk.checksum = XXH3_64bits(chunk.bytes.data(), chunk.bytes.size());
    }
    programs.push_back(std::move(program));
  }
  std::span<const MergePart> all() {
    sources.clear();
    parts.clear();
    sources.reserve(programs.size());
    for (const MemoryProgram& program : programs) {
      sources.emplace_back(program);
      parts.push_back({&sources.back(), "part" + std::to_string(parts.size())});
    }
    return parts;
  }
};

/// A job of a stack. `pictures[i]` is what layer i shows: layers of one number show the same, from files of their own.
struct Stack {
  explicit Stack(const std::vector<int>& pictures)
      : stack(random_stack(images, SampleType::bit, LinesAlong::rows, kLines, kPixels,
                           static_cast<std::int64_t>(pictures.size()), Dice::seed())),
        header(header_for(stack, true)) {
    header.layer_of_revolution.clear();
    for (std::size_t layer = 0; layer < pictures.size(); ++layer) {
      images.at(stack.layers[layer].path) = images.at(stack.layers[static_cast<std::size_t>(pictures[layer])].path);
      header.layers[layer].source = static_cast<std::int64_t>(layer);
      header.layers[layer].starts_reverse = layer % 2 != 0;
      header.sources.push_back({stack.layers[layer].path, 0, kPixels, kLines, "a" + std::to_string(layer)});
      header.layer_of_revolution.push_back(static_cast<std::uint32_t>(layer));
    }
  }
  MemoryImages images;
  LayerStack stack;
  ProgramHeader header;
};

MemoryProgram shard_of(const Stack& job, std::int64_t first, std::int64_t end) {
  LayerStack stack = job.stack;
  ProgramHeader header = job.header;
  const auto take = [&](auto list) { return decltype(list)(list.begin() + first, list.begin() + end); };
  stack.layers = take(stack.layers);
  header.layers = take(header.layers);
  header.sources = take(header.sources);
  header.layer_of_revolution.clear();
  for (std::size_t r = 0; r < header.layers.size(); ++r) {
    header.layer_of_revolution.push_back(static_cast<std::uint32_t>(r));
    header.layers[r].source = static_cast<std::int64_t>(r);
  }
  header.shard = Shard{first, end, static_cast<std::int64_t>(job.stack.layers.size())};
  Compiled compiled = compile_stack(header, stack, job.images, 4);
  EXPECT_TRUE(compiled.result);
  return std::move(compiled.program);
}

LayerNumber one_each(std::int64_t revolution) {
  return {static_cast<std::uint32_t>(revolution), revolution};
}

MemoryProgram write(const MergedProgram& merged, std::span<const MergePart> parts) {
  MemoryProgram whole;
  whole.lines_per_chunk = 4;
  MemorySink sink(whole);
  const Result<void> written = write_merged(merged, parts, sink, nullptr, nullptr);
  EXPECT_TRUE(written) << (written ? "" : written.error().message);
  return whole;
}

TEST(Merge, GivesWhatOneCompileGivesWhateverTheOrderOfTheShards) {
  SCOPED_TRACE(Dice::note());
  Stack job({0, 1, 2, 3, 4});
  const Compiled whole = compile_stack(job.header, job.stack, job.images, 4);
  ASSERT_TRUE(whole.result);
  Parts parts;
  parts.add(shard_of(job, 3, 5));
  parts.add(shard_of(job, 0, 1));
  parts.add(shard_of(job, 1, 3));
  const Result<MergedProgram> merged = join_parts(parts.all(), one_each);
  ASSERT_TRUE(merged) << merged.error().message;
  const MemoryProgram made = write(merged.value(), parts.parts);
  EXPECT_EQ(made.order, whole.program.order);
  ASSERT_EQ(made.header.layers.size(), 5U);
  EXPECT_FALSE(made.header.shard);
  EXPECT_EQ(made.header.layer_of_revolution, job.header.layer_of_revolution);
  for (const auto& [address, chunk] : whole.program.chunks) {
    EXPECT_EQ(made.chunks.at(address).bytes, chunk.bytes);
  }
  for (std::size_t layer = 0; layer < 5; ++layer) {
    EXPECT_EQ(made.header.layers[layer].fired_pixels, whole.program.header.layers[layer].fired_pixels);
    EXPECT_EQ(made.header.layers[layer].source, static_cast<std::int64_t>(layer));
    EXPECT_EQ(made.header.sources[layer].sha256, job.header.sources[layer].sha256);
  }
}

TEST(Merge, TakesALayerThatTwoShardsHaveFromTheFirst) {
  Stack job({0, 1, 2, 3});
  Parts parts;
  parts.add(shard_of(job, 0, 2));
  parts.add(shard_of(job, 2, 4));
  const Result<MergedProgram> merged = join_parts(parts.all(), [](std::int64_t revolution) {
    return LayerNumber{static_cast<std::uint32_t>(revolution % 3), revolution};
  });
  ASSERT_TRUE(merged) << merged.error().message;
  EXPECT_EQ(merged.value().layers.size(), 3U);
  EXPECT_EQ(merged.value().header.layer_of_revolution, (std::vector<std::uint32_t>{0, 1, 2, 0}));
}

TEST(Merge, NamesTheRevolutionsThatAreMissingOrThereTwice) {
  Stack job({0, 1, 2, 3, 4});
  struct Row {
    std::vector<std::pair<int, int>> shards;
    const char* says;
  };
  for (const Row& row :
       {Row{{{0, 2}, {3, 5}}, "revolution 2 of the job is in none"},
        Row{{{1, 5}}, "revolution 0 of the job is in none"}, Row{{{0, 3}}, "revolutions 3 to 4 of the job are in none"},
        Row{{{0, 3}, {2, 5}}, "revolution 2: in part0 and in part1"},
        Row{{{0, 5}, {1, 3}}, "revolutions 1 to 2: in part0 and in part1"},
        Row{{{0, 5}, {0, 5}}, "revolutions 0 to 4: in part0 and in part1"}}) {
    Parts parts;
    for (const auto& [first, end] : row.shards) {
      parts.add(shard_of(job, first, end));
    }
    const Result<MergedProgram> merged = join_parts(parts.all(), one_each);
    ASSERT_FALSE(merged) << row.says;
    EXPECT_EQ(merged.error().code, ErrorCode::bad_argument);
    EXPECT_NE(merged.error().message.find(row.says), std::string::npos) << merged.error().message;
  }
}

TEST(Merge, RefusesShardsOfAnImageThatChangedInBetween) {
  Stack job({0, 1});
  Parts parts;
  parts.add(shard_of(job, 0, 1));
  parts.add(shard_of(job, 1, 2));
  const Result<MergedProgram> merged = join_parts(parts.all(), [](std::int64_t) {
    return LayerNumber{0, 0};
  });  // both say: image 0
  ASSERT_FALSE(merged);
  EXPECT_EQ(merged.error().code, ErrorCode::bad_file);
  EXPECT_NE(merged.error().message.find("changed"), std::string::npos) << merged.error().message;
}

TEST(Merge, RefusesAShardWhoseStoredBitsWereAlteredByName) {
  SCOPED_TRACE(Dice::note());
  Stack job({0, 1, 2});
  Parts parts;
  parts.add(shard_of(job, 0, 1));
  parts.add(shard_of(job, 1, 3));
  const Result<MergedProgram> merged = join_parts(parts.all(), one_each);
  ASSERT_TRUE(merged);
  for (auto& [address, chunk] : parts.programs[1].chunks) {
    for (std::byte& byte : {std::ref(chunk.bytes.front()), std::ref(chunk.bytes.back())}) {
      byte ^= std::byte{0x10};
      MemoryProgram whole;
      whole.lines_per_chunk = 4;
      MemorySink sink(whole);
      const Result<void> written = write_merged(merged.value(), parts.parts, sink, nullptr, nullptr);
      ASSERT_FALSE(written);
      EXPECT_EQ(written.error().code, ErrorCode::bad_file);
      EXPECT_NE(written.error().message.find("part1: layer " + std::to_string(address.first) + ", chunk " +
                                             std::to_string(address.second) + ": altered"),
                std::string::npos)
          << written.error().message;
      EXPECT_EQ(whole.finished, 0);
      byte ^= std::byte{0x10};
    }
  }
  EXPECT_EQ(write(merged.value(), parts.parts).finished, 1) << "undamaged again";
}

TEST(ShareBits, StoresEqualPicturesOnceWhicheverWayTheirLinesAreStored) {
  SCOPED_TRACE(Dice::note());
  const std::vector<int> pictures = {0, 1, 0,
                                     1, 4, 0};  // 1 and 3 start to the left, 0 and 2 to the right; 5 to the left
  Stack job(pictures);
  Parts parts;
  parts.add(shard_of(job, 0, 2));
  parts.add(shard_of(job, 2, 6));
  Result<MergedProgram> merged = join_parts(parts.all(), one_each);
  ASSERT_TRUE(merged);
  EXPECT_TRUE(may_share_bits(merged.value().header));
  const Result<void> shared = share_equal_bits(merged.value(), parts.parts, nullptr);
  ASSERT_TRUE(shared) << shared.error().message;
  EXPECT_EQ(merged.value().header.bits_of_layer, (std::vector<std::uint32_t>{0, 1, 0, 1, 2, 0}));
  EXPECT_EQ(merged.value().bits.size(), 3U);
  const MemoryProgram made = write(merged.value(), parts.parts);
  // Each layer, read as its header says, is still its picture.
  for (std::size_t layer = 0; layer < pictures.size(); ++layer) {
    for (std::int64_t line = 0; line < kLines; ++line) {
      EXPECT_EQ(made.line(made.header.bits_of_layer[layer], line),
                naive_line(made.header, job.stack, job.images, static_cast<std::int64_t>(layer), line))
          << "layer " << layer << ", line " << line;
    }
  }
}

TEST(ShareBits, LeavesPicturesApartThatDifferInOnePixel) {
  Stack job({0, 0, 0});
  MemoryImages::Image& image = job.images.at(job.stack.layers[1].path);
  const auto before = image.samples;
  image.samples = [before](std::int64_t y, std::int64_t x) {  // as bright, but the last two pixels change places
    const bool swapped = y == kLines - 1 && x >= kPixels - 2;
    return before(y, swapped ? 2 * kPixels - 3 - x : x);
  };
  const auto apart = before(kLines - 1, kPixels - 1) != before(kLines - 1, kPixels - 2);
  Parts parts;
  parts.add(shard_of(job, 0, 3));
  Result<MergedProgram> merged = join_parts(parts.all(), one_each);
  ASSERT_TRUE(merged);
  ASSERT_TRUE(share_equal_bits(merged.value(), parts.parts, nullptr));
  EXPECT_EQ(merged.value().header.bits_of_layer,
            apart ? (std::vector<std::uint32_t>{0, 1, 0}) : (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(ShareBits, StopsWhenCancelled) {
  Stack job({0, 0});
  Parts parts;
  parts.add(shard_of(job, 0, 2));
  Result<MergedProgram> merged = join_parts(parts.all(), one_each);
  ASSERT_TRUE(merged);
  CancelToken cancel;
  cancel.cancel();
  const Result<void> shared = share_equal_bits(merged.value(), parts.parts, &cancel);
  ASSERT_FALSE(shared);
  EXPECT_EQ(shared.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace gravure::test
