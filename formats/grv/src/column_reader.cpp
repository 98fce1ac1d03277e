#include <algorithm>
#include <array>
#include <utility>

#include "column_codec.hpp"
#include "column_table.hpp"
#include "hdf5_data.hpp"

namespace gravure::grv {
namespace {

constexpr std::int64_t kMostRowsPerChunk = std::int64_t{1} << 20U;

Error bad_table(const ColumnShape& shape, const std::string& why) {
  return {ErrorCode::bad_file, "path/" + shape.name + ": " + why};
}

Result<Compression> compression_of(hid_t creation, const ColumnShape& shape) {
  const int filters = H5Pget_nfilters(creation);
  if (filters == 0) {
    return Compression::none;
  }
  std::array<H5Z_filter_t, 2> ids{};
  for (unsigned i = 0; i < ids.size(); ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    unsigned config = 0;
    ids[i] = H5Pget_filter2(creation, i, &flags, &values, nullptr, 0, nullptr, &config);
  }
  if (filters == 2 && ids[0] == H5Z_FILTER_SHUFFLE && ids[1] == kZstdFilter) {
    return Compression::zstd;
  }
  if (filters == 2 && ids[0] == H5Z_FILTER_SHUFFLE && ids[1] == H5Z_FILTER_DEFLATE) {
    return Compression::deflate;
  }
  return bad_table(shape, "goes through other HDF5 filters than shuffle and zstd, shuffle and deflate, or none");
}

struct Opened {
  std::int64_t rows_per_chunk = 0;
  Compression compression = Compression::none;
};

Result<Opened> open_data(hid_t file, const ColumnShape& shape, std::int64_t rows) {
  const Handle data(H5Dopen2(file, ("path/" + shape.name).c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.valid()) {
    return bad_table(shape, "missing");
  }
  const Handle space(H5Dget_space(data.get()), H5Sclose);
  const Handle type(H5Dget_type(data.get()), H5Tclose);
  const Handle creation(H5Dget_create_plist(data.get()), H5Pclose);
  std::array<hsize_t, 2> found{};
  std::array<hsize_t, 2> chunk{};
  if (H5Sget_simple_extent_ndims(space.get()) != 2 || H5Pget_layout(creation.get()) != H5D_CHUNKED ||
      H5Tequal(type.get(), H5T_STD_I64LE) <= 0 || H5Sget_simple_extent_dims(space.get(), found.data(), nullptr) != 2 ||
      H5Pget_chunk(creation.get(), 2, chunk.data()) != 2) {
    return bad_table(shape, "is no chunked table of 64-bit numbers");
  }
  if (found[0] != static_cast<hsize_t>(rows) || found[1] != shape.columns || chunk[1] != shape.columns ||
      chunk[0] < 1 || chunk[0] > kMostRowsPerChunk) {
    return bad_table(shape, "has " + std::to_string(found[0]) + " rows of " + std::to_string(found[1]) + ", " +
                                std::to_string(chunk[0]) + " a chunk: must be " + std::to_string(rows) + " of " +
                                std::to_string(shape.columns) + ", 1 to " + std::to_string(kMostRowsPerChunk));
  }
  GRAVURE_TRY(const Compression compression, compression_of(creation.get(), shape));
  return Opened{static_cast<std::int64_t>(chunk[0]), compression};
}

}  // namespace

Result<ColumnReader> ColumnReader::open(hid_t file, const ColumnShape& shape, std::int64_t rows,
                                        std::uint64_t file_bytes) {
  ColumnReader reader;
  reader.shape_ = shape;
  reader.rows_ = rows;
  GRAVURE_TRY(const Opened opened, open_data(file, shape, rows));
  reader.rows_per_chunk_ = opened.rows_per_chunk;
  reader.compression_ = opened.compression;
  const std::int64_t chunks = (rows + opened.rows_per_chunk - 1) / opened.rows_per_chunk;
  const std::array<hsize_t, 2> table_shape = {static_cast<hsize_t>(chunks), 3};
  GRAVURE_TRY(const auto table,
              read_table<std::uint64_t>(file, ("path/" + shape.name + "_chunks").c_str(), table_shape));
  const std::uint64_t whole = static_cast<std::uint64_t>(opened.rows_per_chunk) * shape.columns * sizeof(std::int64_t);
  std::vector<ColumnChunk> places;
  places.reserve(table.size() / 3);
  for (std::size_t i = 0; i < table.size(); i += 3) {
    const ColumnChunk chunk{table[i], table[i + 1], table[i + 2]};
    if (chunk.stored_bytes < 1 || chunk.stored_bytes > whole || chunk.stored_bytes > file_bytes ||
        chunk.offset_bytes > file_bytes - chunk.stored_bytes) {
      return bad_table(shape, "chunk " + std::to_string(i / 3) + " lies outside the file or is longer than a chunk");
    }
    places.push_back(chunk);
  }
  reader.chunks_ = std::make_shared<const std::vector<ColumnChunk>>(std::move(places));
  return reader;
}

Result<void> ColumnReader::load(const ByteFile& file, std::int64_t chunk) {
  const ColumnChunk& place = (*chunks_)[static_cast<std::size_t>(chunk)];
  const auto damaged = [&](const std::string& why) {
    const std::int64_t first = chunk * rows_per_chunk_;
    return Error{ErrorCode::bad_file, file.path() + ": path/" + shape_.name + ", chunk " + std::to_string(chunk) +
                                          " (rows " + std::to_string(first) + ".." +
                                          std::to_string(std::min(first + rows_per_chunk_, rows_) - 1) + ") at byte " +
                                          std::to_string(place.offset_bytes) + ": " + why +
                                          ": get a good copy, or compile the job again"};
  };
  loaded_ = -1;
  std::vector<std::byte> stored(static_cast<std::size_t>(place.stored_bytes));
  GRAVURE_CHECK(read_exactly(file, place.offset_bytes, stored));
  if (hash_of(stored) != place.checksum) {
    return damaged("altered, its checksum does not hold");
  }
  values_.resize(static_cast<std::size_t>(rows_per_chunk_) * shape_.columns);
  const bool raw = stored.size() == values_.size() * sizeof(std::int64_t);
  if (const auto unpacked = unpack_columns(compression_, raw, shape_.columns, stored, values_); !unpacked) {
    return damaged(unpacked.error().message);
  }
  loaded_ = chunk;
  return {};
}

Result<void> ColumnReader::read(const ByteFile& file, std::int64_t first, std::span<std::int64_t> out) {
  const auto count = static_cast<std::int64_t>(out.size() / std::max<std::size_t>(1, shape_.columns));
  if (first < 0 || count > rows_ || first > rows_ - count) {
    return Error{ErrorCode::bad_argument, file.path() + ": rows " + std::to_string(first) + ".." +
                                              std::to_string(first + count - 1) + " of path/" + shape_.name +
                                              ": there are " + std::to_string(rows_)};
  }
  for (std::int64_t row = first; row < first + count;) {
    const std::int64_t chunk = row / rows_per_chunk_;
    if (chunk != loaded_) {
      GRAVURE_CHECK(load(file, chunk));
    }
    const std::int64_t inside = row - chunk * rows_per_chunk_;
    const std::int64_t take = std::min(rows_per_chunk_ - inside, first + count - row);
    const auto from = values_.begin() + inside * static_cast<std::int64_t>(shape_.columns);
    std::copy_n(from, take * static_cast<std::int64_t>(shape_.columns),
                out.begin() + (row - first) * static_cast<std::int64_t>(shape_.columns));
    row += take;
  }
  return {};
}

}  // namespace gravure::grv
