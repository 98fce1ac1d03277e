#include <sys/resource.h>

#include <csignal>
#include <functional>

#include "grv_support.hpp"

namespace gravure {
namespace {

using namespace grv_test;

template <class T>
void expect_error(const Result<T>& result, ErrorCode code, const std::string& naming) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, code) << result.error().message;
  EXPECT_NE(result.error().message.find(naming), std::string::npos) << result.error().message;
}

TEST(GrvSink, LeavesNothingWhenDestroyedBeforeFinish) {
  const Program program = make_program(800, 100, {Picture::noise, Picture::stripes});
  const Folder folder;
  {
    auto sink = start(folder.file("a.grv"), program, {});
    ASSERT_TRUE(sink);
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.grv")));
    expect_ok(put_all(*sink.value(), program));
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.grv")));
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(GrvSink, KeepsTheOldFileUntilTheNewOneIsFinished) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, make_program(16, 4, {Picture::noise}), {}));
  const Bytes before = load(path);
  const Program next = make_program(16, 5, {Picture::stripes});
  {
    auto sink = start(path, next, {});
    ASSERT_TRUE(sink);
    expect_ok(put_all(*sink.value(), next));
    EXPECT_EQ(load(path), before);
  }
  EXPECT_EQ(load(path), before);
  expect_ok(write_program(path, next, {}));
  EXPECT_EQ(open_grv(path).value()->header().plan.rotary.lines_per_revolution, 5);
}

TEST(GrvSink, RefusesSizesOutOfRange) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_error(create_grv(path, 0, 1, 1), ErrorCode::out_of_range, "layers = 0");
  expect_error(create_grv(path, 1, 0, 1), ErrorCode::out_of_range, "lines per layer = 0");
  expect_error(create_grv(path, 1, 1, 0), ErrorCode::out_of_range, "bytes per line = 0");
  expect_error(create_grv(path, -1, 1, 1), ErrorCode::out_of_range, "layers = -1");
  expect_error(create_grv(path, INT64_MAX, INT64_MAX, INT64_MAX), ErrorCode::out_of_range, "must be 1 to");
  expect_error(create_grv(path, INT64_MAX, 1, 1), ErrorCode::out_of_range, "layers = ");
  expect_error(create_grv(path, 1, INT64_MAX, 1), ErrorCode::out_of_range, "lines per layer = ");
  expect_error(create_grv(path, 1, 1, 1, {.zstd_level = 0}), ErrorCode::out_of_range, "zstd_level = 0");
  expect_error(create_grv(path, 1, 1, 1, {.zstd_level = 20}), ErrorCode::out_of_range, "zstd_level = 20");
  expect_error(create_grv(path, 1, 1, 1, {.chunk_bytes = 0}), ErrorCode::out_of_range, "chunk_bytes = 0");
  EXPECT_TRUE(folder.names().empty());
}

TEST(GrvSink, RefusesAFolderThatIsNotThere) {
  const Folder folder;
  expect_error(create_grv(folder.file("nowhere/a.grv"), 1, 1, 1), ErrorCode::io, "nowhere/a.grv");
}

TEST(GrvSink, RefusesAWrongMissingDuplicateOrAlteredChunkAndGoesOn) {
  const Program program = make_program(80, 30, {Picture::noise, Picture::stripes});
  const Folder folder;
  auto started = start(folder.file("a.grv"), program, {.chunk_bytes = 100});
  ASSERT_TRUE(started);
  LineSink& sink = *started.value();
  const auto lines = lines_of(program, {0, 0}, sink.lines_per_chunk());
  expect_error(sink.encode({2, 0}, lines), ErrorCode::bad_argument, "layer 2, chunk 0");
  expect_error(sink.encode({0, 3}, lines), ErrorCode::bad_argument, "layer 0, chunk 3");
  expect_error(sink.encode({-1, 0}, lines), ErrorCode::bad_argument, "layer -1");
  expect_error(sink.encode({0, 0}, lines.first(lines.size() - 1)), ErrorCode::bad_argument, "must be 100");
  const auto encoded = sink.encode({0, 0}, lines);
  ASSERT_TRUE(encoded);
  const StoredChunk& good = encoded.value();
  StoredChunk bad = good;
  bad.address = {0, 17};
  expect_error(sink.put(bad), ErrorCode::bad_argument, "layer 0, chunk 17: no such chunk");
  bad = good;
  bad.bytes.pop_back();
  expect_error(sink.put(bad), ErrorCode::bad_argument, "altered since encode()");
  bad = good;
  bad.filter_mask = 2;
  expect_error(sink.put(bad), ErrorCode::bad_argument, "altered since encode()");
  expect_error(sink.finish(program.header), ErrorCode::bad_argument, "layer 0, chunk 0 (lines 0..9): was not put");
  expect_ok(sink.put(good));
  expect_error(sink.put(good), ErrorCode::bad_argument, "put before");
  expect_error(sink.finish(program.header), ErrorCode::bad_argument, "layer 0, chunk 1 (lines 10..19): was not put");
  for (const ChunkAddress address : addresses(program, sink.lines_per_chunk())) {
    if (address.layer != 0 || address.chunk != 0) {
      const auto chunk = sink.encode(address, lines_of(program, address, sink.lines_per_chunk()));
      ASSERT_TRUE(chunk);
      expect_ok(sink.put(chunk.value()));
    }
  }
  expect_ok(sink.finish(program.header));
  expect_error(sink.finish(program.header), ErrorCode::bad_argument, "finished");
  expect_error(sink.put(good), ErrorCode::bad_argument, "finished");
}

void expect_header_refused(const std::function<void(Program&)>& change, const std::string& naming) {
  Program program = make_program(77, 30, {Picture::noise, Picture::stripes});
  const Folder folder;
  auto sink = start(folder.file("a.grv"), program, {});
  ASSERT_TRUE(sink);
  expect_ok(put_all(*sink.value(), program));
  change(program);
  expect_error(sink.value()->finish(program.header), ErrorCode::bad_argument, naming);
  sink = Error{};
  EXPECT_TRUE(folder.names().empty());
}

TEST(GrvSink, RefusesAHeaderThatDoesNotFitTheChunks) {
  expect_header_refused([](Program& p) { p.header.format_version = 2; }, "format_version = 2");
  expect_header_refused([](Program& p) { p.header.plan = small_plan(77, 31, 5); }, "lines per layer = 30: must be 31");
  expect_header_refused([](Program& p) { p.header.plan = small_plan(81, 30, 5); }, "bytes per line = 10: must be 11");
  expect_header_refused([](Program& p) { p.header.layers.pop_back(); }, "layers in the header = 1");
  expect_header_refused([](Program& p) { p.header.layer_of_revolution.pop_back(); }, "revolutions in the table = 4");
  expect_header_refused([](Program& p) { p.header.layer_of_revolution[4] = 2; }, "layer of revolution 4 = 2");
  expect_header_refused([](Program& p) { p.header.layers[1].source = 2; }, "layer 1: source = 2");
  expect_header_refused([](Program& p) { p.header.layers[1].fired_pixels += 1; }, "layer 1: fired_pixels = ");
  expect_header_refused([](Program& p) { p.header.plan = small_plan(77, 30, 5, false); }, "layer 1: starts right");
  expect_header_refused([](Program& p) { p.header.plan = small_plan(73, 30, 5); }, "bits set beyond its last pixel");
}

TEST(GrvSink, RefusesSourceTextsThatCannotBeStoredAndLeavesNothing) {
  for (const bool path : {true, false}) {
    Program program = make_program(8, 3, {Picture::noise});
    (path ? program.header.sources[0].path : program.header.sources[0].sha256) = std::string("a\0b", 3);
    const Folder folder;
    expect_error(write_program(folder.file("a.grv"), program, {}), ErrorCode::bad_argument, "source \"");
    EXPECT_TRUE(folder.names().empty());
  }
}

/// No file may grow beyond this while one of these lives: the nearest thing to a full disk without a disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::uint64_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_ = {};
  void (*handler_)(int) = nullptr;
};

TEST(GrvSink, ReportsAFullDiskAndLeavesNothingWhereverItFills) {
  const Program program = make_program(800, 200, {Picture::noise, Picture::noise});
  const GrvOptions options{.chunk_bytes = 2000};
  std::uint64_t whole = 0;
  {
    const Folder folder;
    expect_ok(write_program(folder.file("a.grv"), program, options));
    whole = std::filesystem::file_size(folder.file("a.grv"));
  }
  for (std::uint64_t room = 0; room < whole; room += room < whole - 12'000 && room > 12'000 ? 1777 : 97) {
    const Folder folder;
    Result<void> written;
    {
      const FileSizeLimit limit(room);
      written = write_program(folder.file("a.grv"), program, options);
    }
    ASSERT_FALSE(written) << room;
    EXPECT_EQ(written.error().code, ErrorCode::io);
    EXPECT_NE(written.error().message.find("a.grv: cannot"), std::string::npos) << written.error().message;
    EXPECT_NE(written.error().message.find("File too large"), std::string::npos) << written.error().message;
    EXPECT_TRUE(folder.names().empty()) << room;
  }
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), program, options));  // nothing of the failures is left in the library
  EXPECT_TRUE(open_grv(folder.file("a.grv")));
}

}  // namespace
}  // namespace gravure
