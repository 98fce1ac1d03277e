#include "hdf5_data.hpp"

#include <algorithm>

namespace gravure::grv {
namespace {

/// Texts longer than this are no attributes of ours.
constexpr std::size_t kMaxAttributeBytes = 4096;

Error unreadable(const std::string& name, const std::string& why) {
  return {ErrorCode::bad_file, name + ": " + why};
}

/// Contiguous, all there, and no longer than the file.
bool storage_is_whole(hid_t dataset, std::uint64_t bytes) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  const Handle file(H5Iget_file_id(dataset), H5Fclose);
  hsize_t file_bytes = 0;
  return creation.valid() && H5Pget_layout(creation.get()) == H5D_CONTIGUOUS &&
         H5Pget_external_count(creation.get()) == 0 && H5Dget_storage_size(dataset) == bytes &&
         H5Fget_filesize(file.get(), &file_bytes) >= 0 && bytes <= file_bytes;
}

/// 0 where the object is no text of fixed length.
std::size_t text_bytes(hid_t type) {
  return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 ? H5Tget_size(type) : 0;
}

}  // namespace

Error write_failure(const std::string& what) {
  return {ErrorCode::io, "cannot write " + what + ": " + hdf5_reason()};
}

Handle text_type(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(1, bytes));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

Handle plain_space(std::span<const hsize_t> shape) {
  if (shape.empty()) {
    return {H5Screate(H5S_SCALAR), H5Sclose};
  }
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}

Result<Handle> create_group(hid_t parent, const char* name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  Handle group(H5Gcreate2(parent, name, H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Gclose);
  if (!group.valid()) {
    return write_failure(name);
  }
  return group;
}

Result<Handle> create_table(hid_t parent, const char* name, hid_t stored_type, std::span<const hsize_t> shape) {
  const Handle space = plain_space(shape);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  H5Pset_layout(creation.get(), H5D_CONTIGUOUS);
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);
  Handle dataset(H5Dcreate2(parent, name, stored_type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) {
    return write_failure(name);
  }
  return dataset;
}

Result<void> write_values(hid_t dataset, hid_t memory_type, const void* values, const std::string& name) {
  if (values != nullptr && H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    return write_failure(name);
  }
  return {};
}

Result<void> write_attribute(hid_t object, const std::string& name, hid_t stored, hid_t native, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), stored, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.get(), native, value) < 0) {
    return write_failure("attribute " + name);
  }
  return {};
}

Result<void> write_text_attribute(hid_t object, const std::string& name, std::string_view text) {
  const Handle type = text_type(text.size());
  const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
  return write_attribute(object, name, type.get(), type.get(), padded.data());
}

Result<Handle> write_text(hid_t parent, const char* name, std::string_view text) {
  const Handle type = text_type(text.size());
  GRAVURE_TRY(Handle dataset, create_table(parent, name, type.get(), {}));
  const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
  GRAVURE_CHECK(write_values(dataset.get(), type.get(), padded.data(), name));
  GRAVURE_CHECK(write_attribute<std::uint64_t>(dataset.get(), "bytes", text.size()));
  return dataset;
}

Result<Handle> open_table(hid_t parent, const char* name, hid_t stored_type, std::span<const hsize_t> shape) {
  Handle dataset(H5Dopen2(parent, name, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) {
    return unreadable(name, "missing");
  }
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  std::vector<hsize_t> found(H5S_MAX_RANK);
  const int rank = H5Sget_simple_extent_dims(space.get(), found.data(), nullptr);
  found.resize(rank < 0 ? 0 : static_cast<std::size_t>(rank));
  if (rank < 0 || !std::equal(found.begin(), found.end(), shape.begin(), shape.end())) {
    std::string sizes;
    for (const hsize_t extent : found) {
      sizes += "[" + std::to_string(extent) + "]";
    }
    sizes += " instead of ";
    for (const hsize_t extent : shape) {
      sizes += "[" + std::to_string(extent) + "]";
    }
    return unreadable(name, "has the size " + sizes);
  }
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  if (!type.valid() || H5Tequal(type.get(), stored_type) <= 0) {
    return unreadable(name, "has another type than this format version prescribes");
  }
  std::uint64_t bytes = H5Tget_size(type.get());
  for (const hsize_t extent : shape) {
    if (extent != 0 && bytes > UINT64_MAX / extent) {
      return unreadable(name, "is larger than any file");
    }
    bytes *= extent;
  }
  if (!storage_is_whole(dataset.get(), bytes)) {
    return unreadable(name, "is not stored in one piece");
  }
  return dataset;
}

Result<void> read_values(hid_t dataset, hid_t memory_type, void* values, const std::string& name) {
  if (values != nullptr && H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    return unreadable(name, "cannot be read: " + hdf5_reason());
  }
  return {};
}

Result<std::uint64_t> count_rows(hid_t parent, const char* name) {
  const Handle dataset(H5Dopen2(parent, name, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) {
    return unreadable(name, "missing");
  }
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  hsize_t rows = 0;
  if (H5Sget_simple_extent_ndims(space.get()) != 1 || H5Sget_simple_extent_dims(space.get(), &rows, nullptr) < 0) {
    return unreadable(name, "is no one-dimensional table");
  }
  return std::uint64_t{rows};
}

Result<void> read_attribute(hid_t object, const std::string& name, hid_t stored, hid_t native, void* value) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) {
    return unreadable("attribute " + name, "missing");
  }
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tequal(type.get(), stored) <= 0 || H5Sget_simple_extent_type(space.get()) != H5S_SCALAR) {
    return unreadable("attribute " + name, "has another type than this format version prescribes");
  }
  if (H5Aread(attribute.get(), native, value) < 0) {
    return unreadable("attribute " + name, "cannot be read: " + hdf5_reason());
  }
  return {};
}

Result<std::string> read_text_attribute(hid_t object, const std::string& name) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) {
    return unreadable("attribute " + name, "missing");
  }
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const std::size_t bytes = text_bytes(type.get());
  if (bytes < 1 || bytes > kMaxAttributeBytes) {
    return unreadable("attribute " + name, "is no text");
  }
  std::string text(bytes, '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) {
    return unreadable("attribute " + name, "cannot be read: " + hdf5_reason());
  }
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

Result<std::string> read_text(hid_t parent, const char* name) {
  const Handle probe(H5Dopen2(parent, name, H5P_DEFAULT), H5Dclose);
  if (!probe.valid()) {
    return unreadable(name, "missing");
  }
  const Handle type(H5Dget_type(probe.get()), H5Tclose);
  const std::size_t stored = text_bytes(type.get());
  if (stored < 1) {
    return unreadable(name, "is no text");
  }
  GRAVURE_TRY(const Handle dataset, open_table(parent, name, type.get(), {}));
  GRAVURE_TRY(const auto bytes, read_attribute<std::uint64_t>(dataset.get(), "bytes"));
  if (bytes > stored || std::max<std::uint64_t>(1, bytes) != stored) {
    return unreadable(name, "is " + std::to_string(stored) + " bytes long instead of " + std::to_string(bytes));
  }
  std::string text(stored, '\0');
  GRAVURE_CHECK(read_values(dataset.get(), type.get(), text.data(), name));
  text.resize(static_cast<std::size_t>(bytes));
  return text;
}

}  // namespace gravure::grv
