#include "source_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "hdf5_data.hpp"
#include "hdf5_session.hpp"

namespace gravure::grv {
namespace {

constexpr std::size_t kHashBytes = 64;
constexpr std::size_t kMaxPathBytes = 65535;

/// A row as it lies in the file, without gaps.
struct Row {
  explicit Row(std::size_t path_bytes) : path(path_bytes) {}
  std::size_t path;
  std::size_t page_at() const { return path; }
  std::size_t width_at() const { return path + 8; }
  std::size_t height_at() const { return path + 16; }
  std::size_t hash_at() const { return path + 24; }
  std::size_t bytes() const { return path + 24 + kHashBytes; }
};

Handle row_type(const Row& row) {
  Handle type(H5Tcreate(H5T_COMPOUND, row.bytes()), H5Tclose);
  const Handle path = text_type(row.path);
  const Handle hash = text_type(kHashBytes);
  H5Tinsert(type.get(), "path", 0, path.get());
  H5Tinsert(type.get(), "page", row.page_at(), H5T_STD_I64LE);
  H5Tinsert(type.get(), "width", row.width_at(), H5T_STD_I64LE);
  H5Tinsert(type.get(), "height", row.height_at(), H5T_STD_I64LE);
  H5Tinsert(type.get(), "sha256", row.hash_at(), hash.get());
  return type;
}

void put_number(char* at, std::int64_t value) {
  for (int i = 0; i < 8; ++i) {
    at[i] = static_cast<char>(static_cast<unsigned char>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
}

std::int64_t get_number(const char* at) {
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(at[i])} << (8 * i);
  }
  return static_cast<std::int64_t>(value);
}

std::string get_text(const char* at, std::size_t bytes) {
  return {at, ::strnlen(at, bytes)};
}

Result<void> check_texts(const SourceImage& source) {
  const bool nul = source.path.find('\0') != std::string::npos || source.sha256.find('\0') != std::string::npos;
  if (nul || source.path.size() > kMaxPathBytes || source.sha256.size() > kHashBytes) {
    return Error{ErrorCode::bad_argument, "source \"" + source.path + "\": path and hash must hold no NUL, at most " +
                                              std::to_string(kMaxPathBytes) + " and 64 characters"};
  }
  return {};
}

}  // namespace

Result<void> write_sources(hid_t file, const char* name, const std::vector<SourceImage>& sources) {
  std::size_t longest = 1;
  for (const SourceImage& source : sources) {
    GRAVURE_CHECK(check_texts(source));
    longest = std::max(longest, source.path.size());
  }
  const Row row(longest);
  std::string rows(row.bytes() * sources.size(), '\0');
  char* at = rows.data();
  for (const SourceImage& source : sources) {
    source.path.copy(at, row.path);
    put_number(at + row.page_at(), source.page);
    put_number(at + row.width_at(), source.width);
    put_number(at + row.height_at(), source.height);
    source.sha256.copy(at + row.hash_at(), kHashBytes);
    at += row.bytes();
  }
  const Handle type = row_type(row);
  const std::array<hsize_t, 1> shape = {sources.size()};
  GRAVURE_TRY(const Handle table, create_table(file, name, type.get(), shape));
  GRAVURE_CHECK(write_values(table.get(), type.get(), rows.data(), name));
  return write_text_attribute(table.get(), "unit", "page from 0; width and height in pixels; sha256 of the file");
}

Result<std::vector<SourceImage>> read_sources(hid_t file, const char* name) {
  GRAVURE_TRY(const std::uint64_t count, count_rows(file, name));
  const Handle probe(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  const Handle stored(H5Dget_type(probe.get()), H5Tclose);
  const std::size_t bytes = stored.valid() ? H5Tget_size(stored.get()) : 0;
  if (bytes <= Row(0).bytes() || bytes > Row(kMaxPathBytes).bytes()) {
    return Error{ErrorCode::bad_file, std::string(name) + ": is no table of sources"};
  }
  const Row row(bytes - Row(0).bytes());
  const Handle type = row_type(row);
  const std::array<hsize_t, 1> shape = {count};
  GRAVURE_TRY(const Handle table, open_table(file, name, type.get(), shape));
  std::string rows(row.bytes() * static_cast<std::size_t>(count), '\0');
  GRAVURE_CHECK(read_values(table.get(), type.get(), rows.data(), name));
  std::vector<SourceImage> sources;
  for (const char* at = rows.data(); sources.size() < count; at += row.bytes()) {
    sources.push_back({get_text(at, row.path), get_number(at + row.page_at()), get_number(at + row.width_at()),
                       get_number(at + row.height_at()), get_text(at + row.hash_at(), kHashBytes)});
  }
  return sources;
}

}  // namespace gravure::grv
