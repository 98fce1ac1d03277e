#include <hdf5.h>

#include <array>
#include <cstdio>

#include "gravure/formats/plan_json.hpp"
#include "grv_support.hpp"

namespace gravure {
namespace {

using namespace grv_test;

/// What other programs get: the library's own file driver and plain reading.
class PlainHdf5 {
 public:
  explicit PlainHdf5(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  PlainHdf5(const PlainHdf5&) = delete;
  PlainHdf5& operator=(const PlainHdf5&) = delete;
  ~PlainHdf5() { H5Fclose(file_); }
  hid_t file() const { return file_; }

  template <class T>
  std::vector<T> read(const char* name, hid_t native) const {
    const hid_t dataset = H5Dopen2(file_, name, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(H5Dread(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Sclose(space);
    H5Dclose(dataset);
    return values;
  }

 private:
  hid_t file_;
};

TEST(GrvInHdf5, ReadsTheSameBitsPlainlyForEveryCompression) {
  const Program program = make_program(801, 70, {Picture::noise, Picture::stripes});
  for (const Compression compression : {Compression::zstd, Compression::deflate, Compression::none}) {
    const Folder folder;
    expect_ok(write_program(folder.file("a.grv"), program, {.compression = compression, .chunk_bytes = 1500}));
    const PlainHdf5 plain(folder.file("a.grv"));
    const auto bits = plain.read<std::byte>("layers/bits", H5T_NATIVE_UINT8);
    Bytes expected = program.layers[0];
    expected.insert(expected.end(), program.layers[1].begin(), program.layers[1].end());
    EXPECT_EQ(bits, expected);
    EXPECT_EQ(plain.read<std::uint32_t>("revolutions/layer", H5T_NATIVE_UINT32), program.header.layer_of_revolution);
    EXPECT_EQ(plain.read<std::int64_t>("layers/fired_pixels", H5T_NATIVE_INT64)[1],
              program.header.layers[1].fired_pixels);
  }
}

TEST(GrvInHdf5, HasEachChunkWhereTheTablesSay) {
  const Program program = make_program(801, 70, {Picture::noise, Picture::stripes});
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), program, {.chunk_bytes = 1500}));
  const Bytes image = load(folder.file("a.grv"));
  const PlainHdf5 plain(folder.file("a.grv"));
  const auto offsets = plain.read<std::uint64_t>("layers/offset_bytes", H5T_NATIVE_UINT64);
  const auto sizes = plain.read<std::uint64_t>("layers/stored_bytes", H5T_NATIVE_UINT64);
  const hid_t bits = H5Dopen2(plain.file(), "layers/bits", H5P_DEFAULT);
  auto source = open_grv(folder.file("a.grv"));
  ASSERT_TRUE(source);
  std::size_t index = 0;
  for (const ChunkAddress address : addresses(program, source.value()->lines_per_chunk())) {
    const std::array<hsize_t, 3> place = {static_cast<hsize_t>(address.layer),
                                          static_cast<hsize_t>(address.chunk * source.value()->lines_per_chunk()), 0};
    hsize_t size = 0;
    ASSERT_GE(H5Dget_chunk_storage_size(bits, place.data(), &size), 0);
    EXPECT_EQ(size, sizes[index]);
    Bytes stored(size);
    std::uint32_t mask = 0;
    ASSERT_GE(H5Dread_chunk(bits, H5P_DEFAULT, place.data(), &mask, stored.data()), 0);
    EXPECT_TRUE(std::equal(stored.begin(), stored.end(), image.begin() + static_cast<std::ptrdiff_t>(offsets[index])));
    const auto fetched = source.value()->fetch(address);
    ASSERT_TRUE(fetched);
    EXPECT_EQ(fetched.value().bytes, stored);
    EXPECT_EQ(fetched.value().filter_mask, mask);
    ++index;
  }
  H5Dclose(bits);
}

std::string run(const std::string& command) {
  std::string output;
  std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) {
    output += buffer;
  }
  const int status = ::pclose(pipe);
  return status == 0 ? output : "status " + std::to_string(status) + ": " + output;
}

TEST(GrvInHdf5, IsShownByH5dumpWithNumbersAndUnits) {
  if (run("command -v h5dump").rfind("status", 0) == 0) {
    GTEST_SKIP() << "h5dump is not installed (package hdf5-tools)";
  }
  const Program program = make_program(801, 70, {Picture::noise, Picture::stripes});
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, program, {.compression = Compression::deflate}));
  const std::string header = run("h5dump -p -B -H '" + path + "'");
  for (const char* part : {"USERBLOCK_SIZE 512", "DATASET \"bits\"", "( 2, 70, 101 )", "COMPRESSION DEFLATE",
                           "ATTRIBUTE \"increment\"", "ATTRIBUTE \"seed_hz.unit\"", "DATASET \"layer\""}) {
    EXPECT_NE(header.find(part), std::string::npos) << part << " in\n" << header;
  }
  EXPECT_NE(run("h5dump -a /plan/seed_hz '" + path + "'").find("(0): 82000000"), std::string::npos);
  EXPECT_NE(run("h5dump -d /plan '" + path + "'").find("\"increment\": "), std::string::npos);
  EXPECT_NE(run("h5dump -d /sources '" + path + "'").find("layers/a.tif"), std::string::npos);
  EXPECT_NE(run("h5dump -d /layers/bits -s 0,0,0 -c 1,1,4 '" + path + "'").find("DATA {"), std::string::npos);
}

TEST(GrvInHdf5, KeepsNoTimeAnywhere) {
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), make_program(9, 3, {Picture::noise}), {}));
  const PlainHdf5 plain(folder.file("a.grv"));
  int objects = 0;
  const H5O_iterate_t look = [](hid_t, const char* name, const H5O_info_t* info, void* count) -> herr_t {
    EXPECT_EQ(info->atime + info->mtime + info->ctime + info->btime, 0) << name;
    ++*static_cast<int*>(count);
    return 0;
  };
  ASSERT_GE(H5Ovisit(plain.file(), H5_INDEX_NAME, H5_ITER_INC, look, &objects), 0);
  EXPECT_EQ(objects, 18);  // 4 groups, 14 datasets
}

TEST(GrvInHdf5, LeavesTheErrorPrinterOfTheApplicationAlone) {
  const H5E_auto2_t mine = [](hid_t, void*) -> herr_t { return 0; };
  H5E_auto2_t before = nullptr;
  void* before_data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &before_data);
  H5Eset_auto2(H5E_DEFAULT, mine, nullptr);
  const Folder folder;
  expect_ok(write_program(folder.file("a.grv"), make_program(9, 3, {Picture::noise}), {}));
  EXPECT_TRUE(open_grv(folder.file("a.grv")));
  H5E_auto2_t after = nullptr;
  void* after_data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &after, &after_data);
  EXPECT_EQ(after, mine);
  H5Eset_auto2(H5E_DEFAULT, before, before_data);
}

}  // namespace
}  // namespace gravure
