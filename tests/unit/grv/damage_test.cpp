#include <sys/stat.h>

#include "grv_damage.hpp"

namespace gravure {
namespace {

using namespace grv_test;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLeaksCounted = true;
#elif defined(__has_feature)
constexpr bool kLeaksCounted = __has_feature(address_sanitizer);
#else
constexpr bool kLeaksCounted = false;
#endif

/// Three layers in several chunks each, kept small so that every byte can be tried.
Program victim() {
  return make_program(70, 30, {Picture::noise, Picture::stripes, Picture::blank});
}

Bytes image_of(const Program& program, Compression compression) {
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), program, {.compression = compression, .chunk_bytes = 100}));
  return load(folder.file("a.grv"));
}

TEST(GrvDamage, IsNoticedForOneFlippedBitInAnyByte) {
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << test_seed());
  std::mt19937 random(test_seed());
  for (const Compression compression : {Compression::zstd, Compression::deflate, Compression::none}) {
    Bytes image = image_of(victim(), compression);
    ASSERT_TRUE(read_image(image));
    for (std::size_t at = 0; at < image.size(); ++at) {
      const std::byte flip = std::byte{1} << (random() % 8);
      image[at] ^= flip;
      const auto bits = read_image(image);
      image[at] ^= flip;
      ASSERT_FALSE(bits) << "byte " << at << ", bit mask " << std::to_integer<int>(flip);
      EXPECT_TRUE(bits.error().code == ErrorCode::bad_file) << at << ": " << bits.error().message;
    }
  }
}

/// What a bad disk or a careless editor leaves: runs of zeros, of 0xFF, of anything, bytes copied from elsewhere.
TEST(GrvDamage, IsNoticedForRunsOfOtherBytesAnywhere) {
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << test_seed());
  std::mt19937 random(test_seed());
  const Bytes good = image_of(victim(), Compression::zstd);
  for (int trial = 0; trial < 3000; ++trial) {
    Bytes image = good;
    const std::size_t length = 1 + random() % (trial % 2 == 0 ? 8 : 4096);
    const std::size_t at = random() % (image.size() - std::min(length, image.size() - 1));
    const std::size_t from = random() % (image.size() - std::min(length, image.size() - 1));
    const unsigned kind = random() % 4;
    for (std::size_t i = at; i < std::min(at + length, image.size()); ++i) {
      image[i] = kind == 0   ? std::byte{0}
                 : kind == 1 ? std::byte{0xFF}
                 : kind == 2 ? static_cast<std::byte>(random())
                             : good[(from + i - at) % good.size()];
    }
    const auto bits = read_image(image);
    ASSERT_EQ(static_cast<bool>(bits), image == good) << "trial " << trial << ": " << length << " bytes at " << at;
  }
}

TEST(GrvDamage, IsNoticedForEveryLengthOfATruncatedFile) {
  const Bytes image = image_of(victim(), Compression::zstd);
  std::size_t chunks_named = 0;
  for (std::size_t size = 0; size < image.size(); ++size) {
    const Bytes cut(image.begin(), image.begin() + static_cast<std::ptrdiff_t>(size));
    const auto bits = read_image(cut);
    ASSERT_FALSE(bits) << size;
    EXPECT_EQ(bits.error().code, ErrorCode::bad_file) << size << ": " << bits.error().message;
    chunks_named += bits.error().message.find("first chunk lost: layer ") != std::string::npos ? 1 : 0;
  }
  EXPECT_GT(chunks_named, 100U);  // the stretch of the file in which the chunks lie
}

TEST(GrvDamage, NamesTheFirstLostChunkOfATruncatedFile) {
  const Program program = victim();
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, program, {.chunk_bytes = 100}));
  auto file = grv::open_file(path, grv::OpenFor::reading, path);
  ASSERT_TRUE(file);
  const auto sealed = grv::verify_seal(*file.value());
  ASSERT_TRUE(sealed);
  const std::size_t lost = sealed.value().seal.layout.index_of({1, 1});
  std::filesystem::resize_file(path, sealed.value().tables.offset_bytes[lost] + 1);
  const std::int64_t per_chunk = sealed.value().seal.layout.lines_per_chunk;
  expect_refused(path, ErrorCode::bad_file,
                 "first chunk lost: layer 1, chunk 1 (lines " + std::to_string(per_chunk) + ".." +
                     std::to_string(2 * per_chunk - 1) + ") at byte " +
                     std::to_string(sealed.value().tables.offset_bytes[lost]));
}

TEST(GrvDamage, NamesTheChunkLinesAndPlaceOfAFlippedBit) {
  const Program program = victim();
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, program, {.chunk_bytes = 100}));
  Bytes image = load(path);
  const auto sealed = grv::verify_seal(*grv::open_image(image));
  ASSERT_TRUE(sealed);
  const std::uint64_t at = sealed.value().tables.offset_bytes[sealed.value().seal.layout.index_of({0, 2})];
  image[at] ^= std::byte{1};
  save(path, image);
  auto source = open_grv(path);
  ASSERT_TRUE(source) << "chunks are verified when they are read";
  Bytes out(lines_of(program, {0, 2}, source.value()->lines_per_chunk()).size());
  const auto chunk = source.value()->fetch({0, 2});
  ASSERT_TRUE(chunk);
  const auto decoded = source.value()->decode(chunk.value(), out);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, ErrorCode::bad_file);
  EXPECT_NE(decoded.error().message.find("layer 0, chunk 2 (lines "), std::string::npos) << decoded.error().message;
  EXPECT_NE(decoded.error().message.find("at byte " + std::to_string(at)), std::string::npos);
}

TEST(GrvDamage, IsNoticedForAppendedBytes) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, victim(), {}));
  Bytes image = load(path);
  image.push_back(std::byte{0});
  save(path, image);
  expect_refused(path, ErrorCode::bad_file, "1 bytes too long");
}

TEST(GrvDamage, IsNoticedForOtherFilesFoldersAndPipes) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_refused(path, ErrorCode::bad_file, "cannot open");
  save(path, {});
  expect_refused(path, ErrorCode::bad_file, "only 0 bytes");
  save(path, Bytes(4000, std::byte{'x'}));
  expect_refused(path, ErrorCode::bad_file, "is not a gravure program");
  const hid_t plain = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(H5Fclose(plain), 0);
  expect_refused(path, ErrorCode::bad_file, "is not a gravure program");
  std::filesystem::create_directory(folder.file("b.grv"));
  expect_refused(folder.file("b.grv"), ErrorCode::bad_file, "is not a regular file");
  ASSERT_EQ(::mkfifo(folder.file("c.grv").c_str(), 0600), 0);
  expect_refused(folder.file("c.grv"), ErrorCode::bad_file, "is not a regular file");
}

TEST(GrvDamage, IsAVersionMismatchForAnotherFormatVersion) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  for (const std::uint32_t version : {0U, kNewestFormatVersion + 1}) {
    expect_ok(write_program(path, victim(), {}));
    reseal(path, [version](grv::Seal& seal) { seal.format_version = version; });
    expect_refused(path, ErrorCode::version_mismatch,
                   "program format version " + std::to_string(version) + ", this gravure reads versions 1 to 2");
  }
  expect_ok(write_program(path, victim(), {}));
  reseal(path, [](grv::Seal& seal) { seal.format_version = kFocusAxisFormatVersion; });
  expect_refused(path, ErrorCode::version_mismatch, "attribute format_version is 1, the seal says 2");
}

TEST(GrvDamage, IsNoticedForASealThatLies) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  const auto lie = [&](const std::function<void(grv::Seal&)>& change, const std::string& naming) {
    expect_ok(write_program(path, victim(), {.chunk_bytes = 100}));
    reseal(path, change);
    expect_refused(path, ErrorCode::bad_file, naming);
  };
  lie([](grv::Seal& seal) { seal.layout.layers = 0; }, "layers = 0");
  lie([](grv::Seal& seal) { seal.layout.layers = std::int64_t{1} << 27; }, "chunks per layer");
  lie([](grv::Seal& seal) { seal.layout.layers = 1'000'000; }, "beyond the end of the file");
  lie([](grv::Seal& seal) { seal.layout.line_bytes = INT64_MAX; }, "bytes per line");
  lie([](grv::Seal& seal) { seal.layout.lines_per_layer = INT64_MAX; }, "lines per layer");
  lie([](grv::Seal& seal) { seal.layout.lines_per_chunk = -1; }, "lines per chunk");
  lie([](grv::Seal& seal) { seal.layout.line_bytes += 1; }, "layers/bits: has 3 layers of 30 lines of 9 bytes");
  lie([](grv::Seal& seal) { seal.layout.lines_per_layer -= 1; }, "layers/bits: has 3 layers of 30 lines of 9 bytes");
  lie([](grv::Seal& seal) { seal.offset_table_at = UINT64_MAX - 7; }, "beyond the end of the file");
  lie([](grv::Seal& seal) { seal.stored_table_at += 8; }, "chunk tables");
  lie([](grv::Seal& seal) { seal.file_bytes += 1; }, "cut off at byte");
  lie([](grv::Seal& seal) { seal.file_bytes -= 1; }, "1 bytes too long");
}

/// A file whose structure somebody changed and sealed again. The seal does not stop that (docs/decisions/
/// grv_integrity.md); the library behind it must still not be led astray by an address or size of all ones, where HDF5
/// 1.10.8 reads through our driver: each is refused, or leads to the program as it was.
TEST(GrvDamage, UnderANewSealDoesNotCrashWithWordsOfAllOnes) {
  if (kLeaksCounted) {
    GTEST_SKIP() << "HDF5 leaks what it had opened of such a file, which the address sanitizer would count as ours";
  }
  const Bytes good = image_of(victim(), Compression::zstd);
  const auto sealed = grv::verify_seal(*grv::open_image(good));
  ASSERT_TRUE(sealed);
  const auto bits = read_image(good);
  std::vector<bool> in_chunk(good.size());
  const grv::ChunkTables& tables = sealed.value().tables;
  for (std::size_t i = 0; i < tables.offset_bytes.size(); ++i) {
    std::fill_n(in_chunk.begin() + static_cast<std::ptrdiff_t>(tables.offset_bytes[i]), tables.stored_bytes[i], true);
  }
  int refused = 0;
  for (std::size_t at = grv::Seal::kBytes; at + 8 <= good.size(); at += 8) {
    if (in_chunk[at] || in_chunk[at + 7]) {
      continue;
    }
    Bytes image = good;
    std::fill_n(image.begin() + static_cast<std::ptrdiff_t>(at), 8, std::byte{0xFF});
    const auto hash = grv::hash_surroundings(*grv::open_image(image), sealed.value().seal.layout, tables, image.size());
    ASSERT_TRUE(hash);
    grv::Seal seal = sealed.value().seal;
    seal.surroundings_hash = hash.value();
    const auto front = grv::encode_seal(seal);
    std::copy(front.begin(), front.end(), image.begin());
    const auto read = read_image(image);
    refused += read ? 0 : 1;
    if (read) {
      ASSERT_EQ(read.value(), bits.value()) << "byte " << at;
    }
  }
  EXPECT_GT(refused, 500);
}

TEST(GrvDamage, IsNoticedForChunksThatOverlapOrLieOutside) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  const auto lie = [&](std::size_t entry, bool in_sizes, std::uint64_t value) {
    expect_ok(write_program(path, victim(), {.chunk_bytes = 100}));
    Bytes image = load(path);
    auto sealed = grv::verify_seal(*grv::open_image(image));
    ASSERT_TRUE(sealed);
    auto& tables = sealed.value().tables;
    auto& seal = sealed.value().seal;
    (in_sizes ? tables.stored_bytes : tables.offset_bytes)[entry] = value;
    seal.tables_hash = grv::hash_tables(tables);
    const std::uint64_t at = (in_sizes ? seal.stored_table_at : seal.offset_table_at) + 8 * entry;
    for (std::size_t i = 0; i < 8; ++i) {
      image[at + i] = static_cast<std::byte>(value >> (8 * i));
    }
    const auto front = grv::encode_seal(seal);
    std::copy(front.begin(), front.end(), image.begin());
    save(path, image);
    expect_refused(path, ErrorCode::bad_file, "lies outside the file");
  };
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{511}, std::uint64_t{1} << 40, UINT64_MAX}) {
    lie(1, false, offset);
  }
  for (const std::uint64_t bytes : {std::uint64_t{0}, std::uint64_t{1000}, UINT64_MAX}) {
    lie(1, true, bytes);
  }
}

}  // namespace
}  // namespace gravure
