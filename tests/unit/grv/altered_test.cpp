#include "gravure/formats/plan_json.hpp"
#include "grv_damage.hpp"

namespace gravure {
namespace {

using namespace grv_test;

/// A good program, changed through the HDF5 library: refused as it is, and refused with `naming` under a new seal.
void expect_change_refused(const std::function<void(hid_t)>& change, const std::string& naming,
                           ErrorCode code = ErrorCode::bad_file, bool bidirectional = true) {
  const Folder folder;
  const std::string path = folder.file("a.grv");
  expect_ok(write_program(path, make_program(70, 30, {Picture::noise, Picture::stripes}, bidirectional), {}));
  ASSERT_TRUE(open_grv(path));
  edit(path, change);
  expect_refused(path, ErrorCode::bad_file, "");
  reseal(path);
  expect_refused(path, code, naming);
}

template <class T>
std::function<void(hid_t)> overwrite(const char* name, hid_t native, std::size_t row, T value) {
  return [=](hid_t file) {
    const hid_t table = H5Dopen2(file, name, H5P_DEFAULT);
    ASSERT_GE(table, 0);
    std::vector<T> values(1000);
    ASSERT_GE(H5Dread(table, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    values[row] = value;
    ASSERT_GE(H5Dwrite(table, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Dclose(table);
  };
}

std::function<void(hid_t)> remove(const char* name) {
  return [name](hid_t file) { ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0); };
}

void set_number(hid_t object, const char* attribute, std::uint64_t value) {
  const hid_t id = H5Aopen(object, attribute, H5P_DEFAULT);
  ASSERT_GE(H5Awrite(id, H5T_NATIVE_UINT64, &value), 0);
  H5Aclose(id);
}

std::string read_plan_json(hid_t plan) {
  const hid_t type = H5Dget_type(plan);
  std::string json(H5Tget_size(type), '\0');
  H5Dread(plan, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, json.data());
  H5Tclose(type);
  return json;
}

/// Changes one digit of the increment in the plan's JSON.
void falsify_increment(hid_t file) {
  const hid_t plan = H5Dopen2(file, "plan", H5P_DEFAULT);
  const hid_t type = H5Dget_type(plan);
  std::string json = read_plan_json(plan);
  const std::size_t digit = json.find_first_of("0123456789", json.find("\"increment\""));
  ASSERT_NE(digit, std::string::npos);
  json[digit] = json[digit] == '9' ? '8' : static_cast<char>(json[digit] + 1);
  ASSERT_GE(H5Dwrite(plan, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, json.data()), 0);
  H5Tclose(type);
  H5Dclose(plan);
}

TEST(GrvAltered, IsRefusedForAWrongIncrementInThePlan) {
  expect_change_refused(falsify_increment, "plan");
}

TEST(GrvAltered, IsRefusedForAnIncrementShownOtherThanThePlanHasIt) {
  expect_change_refused(
      [](hid_t file) {
        const hid_t plan = H5Dopen2(file, "plan", H5P_DEFAULT);
        set_number(plan, "increment", 12345);
        H5Dclose(plan);
      },
      "attribute increment of /plan is 12345, its JSON says");
}

TEST(GrvAltered, IsRefusedForOneMissingLine) {
  expect_change_refused(
      [](hid_t file) {
        const hid_t bits = H5Dopen2(file, "layers/bits", H5P_DEFAULT);
        const hsize_t shape[3] = {2, 29, 9};
        ASSERT_GE(H5Dset_extent(bits, shape), 0);
        H5Dclose(bits);
      },
      "layers/bits: has 2 layers of 29 lines");
}

TEST(GrvAltered, IsRefusedForMissingParts) {
  for (const char* name : {"plan", "sources", "job/text", "job/path", "layers/bits", "layers/checksums",
                           "layers/chunk_fired_pixels", "layers/starts_reverse", "revolutions/layer"}) {
    SCOPED_TRACE(name);
    expect_change_refused(remove(name), "missing");
  }
}

TEST(GrvAltered, IsRefusedForTablesThatDoNotFit) {
  expect_change_refused(overwrite<std::uint32_t>("revolutions/layer", H5T_NATIVE_UINT32, 3, 2),
                        "layer of revolution 3 = 2: must be 0 to 1");
  expect_change_refused(overwrite<std::uint8_t>("layers/starts_reverse", H5T_NATIVE_UINT8, 0, 2),
                        "starts_reverse of layer 0 = 2");
  expect_change_refused(overwrite<std::uint8_t>("layers/starts_reverse", H5T_NATIVE_UINT8, 1, 1),
                        "layer 1: starts right to left", ErrorCode::bad_file, false);
  expect_change_refused(overwrite<std::int64_t>("layers/source", H5T_NATIVE_INT64, 1, 2), "layer 1: source = 2");
  expect_change_refused(overwrite<std::int64_t>("layers/source", H5T_NATIVE_INT64, 1, -1), "layer 1: source = -1");
  expect_change_refused(overwrite<std::int64_t>("layers/fired_pixels", H5T_NATIVE_INT64, 0, 1),
                        "layer 0: fired_pixels = 1");
  expect_change_refused(overwrite<std::int64_t>("layers/chunk_fired_pixels", H5T_NATIVE_INT64, 0, 1), "fired_pixels");
}

TEST(GrvAltered, IsRefusedForATableOfAnotherTypeOrShape) {
  const auto replace = [](const char* name, hid_t type, std::vector<hsize_t> shape) {
    return [=](hid_t file) {
      ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0);
      const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
      const hid_t table = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      ASSERT_GE(table, 0);
      H5Sclose(space);
      H5Dclose(table);
    };
  };
  expect_change_refused(replace("revolutions/layer", H5T_STD_U64LE, {5}), "has another type");
  expect_change_refused(replace("revolutions/layer", H5T_STD_U32LE, {4}), "has the size [4] instead of [5]");
  expect_change_refused(replace("revolutions/layer", H5T_STD_U32LE, {5}), "is not stored in one piece");
  expect_change_refused(replace("revolutions/layer", H5T_STD_U32LE, {5, 1}), "has the size [5][1]");
  expect_change_refused(replace("sources", H5T_STD_U32LE, {2}), "sources: is no table of sources");
  expect_change_refused(replace("plan", H5T_STD_U32LE, {2}), "plan: is no text");
  expect_change_refused(replace("layers/bits", H5T_STD_U8LE, {2, 30, 9}), "layers/bits: is no chunked table");
}

TEST(GrvAltered, IsAVersionMismatchForAnotherVersionInTheAttributes) {
  expect_change_refused(
      [](hid_t file) {
        const hid_t root = H5Gopen2(file, "/", H5P_DEFAULT);
        set_number(root, "format_version", 7);
        H5Gclose(root);
      },
      "attribute format_version is 7", ErrorCode::version_mismatch);
}

}  // namespace
}  // namespace gravure
