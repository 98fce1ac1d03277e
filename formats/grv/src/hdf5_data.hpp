#pragma once

#include <hdf5.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "hdf5_session.hpp"

namespace gravure::grv {

/// Attributes, tables and texts of an HDF5 file. Everything here is called within an Hdf5Session.
///
/// Writing fails with io and the library's reason; reading with bad_file. Both name the object, the caller puts the
/// file's name in front. Nothing written carries a time, all numbers are little-endian, all texts are UTF-8 of fixed
/// length: the same content gives the same bytes.

template <class T>
struct Hdf5Type;
template <>
struct Hdf5Type<std::uint8_t> {
  static hid_t stored() { return H5T_STD_U8LE; }
  static hid_t native() { return H5T_NATIVE_UINT8; }
};
template <>
struct Hdf5Type<std::int32_t> {
  static hid_t stored() { return H5T_STD_I32LE; }
  static hid_t native() { return H5T_NATIVE_INT32; }
};
template <>
struct Hdf5Type<std::uint32_t> {
  static hid_t stored() { return H5T_STD_U32LE; }
  static hid_t native() { return H5T_NATIVE_UINT32; }
};
template <>
struct Hdf5Type<std::uint64_t> {
  static hid_t stored() { return H5T_STD_U64LE; }
  static hid_t native() { return H5T_NATIVE_UINT64; }
};
template <>
struct Hdf5Type<std::int64_t> {
  static hid_t stored() { return H5T_STD_I64LE; }
  static hid_t native() { return H5T_NATIVE_INT64; }
};

/// An io error saying what failed and the library's reason.
Error write_failure(const std::string& what);
/// The type of a text of at most `bytes` bytes (at least one).
Handle text_type(std::size_t bytes);
Handle plain_space(std::span<const hsize_t> shape);

/// Creates a group that keeps no time stamp.
Result<Handle> create_group(hid_t parent, const char* name);
/// Creates a contiguous dataset, its space in the file reserved at once. `plain` is for tables; bits have their own
/// list.
Result<Handle> create_table(hid_t parent, const char* name, hid_t stored_type, std::span<const hsize_t> shape);
Result<void> write_values(hid_t dataset, hid_t memory_type, const void* values, const std::string& name);

Result<void> write_text_attribute(hid_t object, const std::string& name, std::string_view text);
Result<void> write_attribute(hid_t object, const std::string& name, hid_t stored, hid_t native, const void* value);
template <class T>
Result<void> write_attribute(hid_t object, const std::string& name, T value) {
  return write_attribute(object, name, Hdf5Type<T>::stored(), Hdf5Type<T>::native(), &value);
}

/// A table with its unit and what it says.
template <class T>
Result<void> write_table(hid_t parent, const char* name, std::span<const T> values, std::span<const hsize_t> shape,
                         std::string_view unit) {
  GRAVURE_TRY(const Handle table, create_table(parent, name, Hdf5Type<T>::stored(), shape));
  GRAVURE_CHECK(write_values(table.get(), Hdf5Type<T>::native(), values.data(), name));
  return write_text_attribute(table.get(), "unit", unit);
}

/// A text, byte for byte (its length is an attribute: HDF5 texts cannot be empty).
Result<Handle> write_text(hid_t parent, const char* name, std::string_view text);

/// What a dataset must be like to be read.
Result<Handle> open_table(hid_t parent, const char* name, hid_t stored_type, std::span<const hsize_t> shape);
Result<void> read_values(hid_t dataset, hid_t memory_type, void* values, const std::string& name);
/// Number of rows of a one-dimensional dataset.
Result<std::uint64_t> count_rows(hid_t parent, const char* name);

/// Reads a table of exactly this shape and type. Contiguous storage, all of it in the file, is a condition: so memory
/// is bounded by the file's size.
template <class T>
Result<std::vector<T>> read_table(hid_t parent, const char* name, std::span<const hsize_t> shape) {
  GRAVURE_TRY(const Handle table, open_table(parent, name, Hdf5Type<T>::stored(), shape));
  std::size_t count = 1;
  for (const hsize_t extent : shape) {
    count *= static_cast<std::size_t>(extent);
  }
  std::vector<T> values(count);
  GRAVURE_CHECK(read_values(table.get(), Hdf5Type<T>::native(), values.data(), name));
  return values;
}

Result<void> read_attribute(hid_t object, const std::string& name, hid_t stored, hid_t native, void* value);
template <class T>
Result<T> read_attribute(hid_t object, const std::string& name) {
  T value = 0;
  GRAVURE_CHECK(read_attribute(object, name, Hdf5Type<T>::stored(), Hdf5Type<T>::native(), &value));
  return value;
}
Result<std::string> read_text_attribute(hid_t object, const std::string& name);
Result<std::string> read_text(hid_t parent, const char* name);

}  // namespace gravure::grv
