#pragma once

#include <hdf5.h>

#include <array>
#include <functional>

#include "byte_file.hpp"
#include "grv_support.hpp"
#include "reader.hpp"
#include "seal.hpp"

namespace gravure::grv_test {

/// Opens bytes and reads every chunk.
inline Result<std::vector<Bytes>> read_image(const Bytes& image) {
  GRAVURE_TRY(const auto source, grv::open_program(grv::open_image(image)));
  return read_bits(*source);
}

/// Changes a program through the HDF5 library, as a stranger would.
inline void edit(const std::string& path, const std::function<void(hid_t)>& change) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  change(file);
  ASSERT_GE(H5Fclose(file), 0);
}

/// Puts a new seal on a changed program: what the checks behind the seal are for.
inline void reseal(const std::string& path, const std::function<void(grv::Seal&)>& change_seal = {}) {
  auto file = grv::open_file(path, grv::OpenFor::writing, path);
  ASSERT_TRUE(file);
  std::array<std::byte, grv::Seal::kBytes> bytes = {};
  ASSERT_TRUE(file.value()->read(0, bytes));
  auto seal = grv::decode_seal(bytes, path);
  ASSERT_TRUE(seal) << seal.error().message;
  if (change_seal) {
    change_seal(seal.value());
    expect_ok(file.value()->write(0, grv::encode_seal(seal.value())));
    expect_ok(file.value()->flush());
    return;
  }
  const auto entries = static_cast<std::size_t>(seal.value().layout.chunks());
  const auto table = [&](std::uint64_t at) {
    std::vector<std::uint64_t> values(entries);
    EXPECT_TRUE(file.value()->read(at, std::as_writable_bytes(std::span(values))));  // little-endian, as this machine
    return values;
  };
  const grv::ChunkTables tables{table(seal.value().offset_table_at), table(seal.value().stored_table_at)};
  expect_ok(grv::write_seal(*file.value(), seal.value().layout, tables, seal.value().offset_table_at,
                            seal.value().stored_table_at));
}

inline void expect_refused(const std::string& path, ErrorCode code, const std::string& naming) {
  const auto source = open_grv(path);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, code) << source.error().message;
  EXPECT_NE(source.error().message.find(naming), std::string::npos) << source.error().message;
  EXPECT_EQ(source.error().message.rfind(path, 0), 0U) << source.error().message;
}

}  // namespace gravure::grv_test
