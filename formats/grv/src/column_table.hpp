#pragma once

#include <hdf5.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "byte_file.hpp"
#include "codec.hpp"
#include "gravure/core/error.hpp"
#include "gravure/formats/grv.hpp"
#include "hdf5_channel.hpp"
#include "hdf5_session.hpp"

namespace gravure::grv {

/// A table of a path program, /path/<name>: rows of 64-bit numbers in chunks (column_codec.hpp), of which
/// /path/<name>_chunks says the place in the file, the bytes stored and their XXH3-64.
struct ColumnChunk {
  std::uint64_t offset_bytes = 0;
  std::uint64_t stored_bytes = 0;
  std::uint64_t checksum = 0;
};

struct ColumnShape {
  std::string name;
  std::size_t columns = 0;
  std::string unit;
};
/// Set-points (in the order of kPathAxes, with W or without, then the path covered) and wanted points.
const ColumnShape& set_point_columns(bool focus_axis);
const ColumnShape& target_columns();

inline constexpr std::int64_t kRowsPerChunk = 4096;

/// Writes such a table row by row. Everything but the constructor is called within an Hdf5Session; messages name the
/// object, the caller puts the file's name in front.
class ColumnWriter {
 public:
  ColumnWriter(ColumnShape shape, const GrvOptions& options) : shape_(std::move(shape)), options_(options) {}
  std::int64_t rows() const noexcept { return rows_; }
  /// Whole rows.
  Result<void> put(hid_t group, Hdf5Channel& channel, std::span<const std::int64_t> values);
  /// Writes what is left and the table of the chunks; closes. Nothing where there are no rows.
  Result<void> finish(hid_t group, Hdf5Channel& channel);
  void close() { data_.reset(); }

 private:
  Result<void> open(hid_t group);
  Result<void> write_chunk(Hdf5Channel& channel);

  ColumnShape shape_;
  GrvOptions options_;
  Handle data_;
  std::vector<std::int64_t> pending_;
  std::vector<ColumnChunk> chunks_;
  std::int64_t rows_ = 0;
};

/// Reads one: its place in the file is known, so that the HDF5 library has no part in reading. Copies read for
/// themselves; the table of the chunks is held once for all of them.
class ColumnReader {
 public:
  /// Within an Hdf5Session. bad_file where the table is not there in this size.
  static Result<ColumnReader> open(hid_t file, const ColumnShape& shape, std::int64_t rows, std::uint64_t file_bytes);
  ColumnReader() = default;

  std::int64_t rows() const noexcept { return rows_; }
  /// Rows from `first` on into all of `out`; the chunk last unpacked is kept. bad_file names the chunk that is damaged,
  /// bad_argument rows that are not there.
  Result<void> read(const ByteFile& file, std::int64_t first, std::span<std::int64_t> out);

 private:
  Result<void> load(const ByteFile& file, std::int64_t chunk);

  ColumnShape shape_;
  std::int64_t rows_ = 0;
  std::int64_t rows_per_chunk_ = kRowsPerChunk;
  Compression compression_ = Compression::none;
  std::shared_ptr<const std::vector<ColumnChunk>> chunks_;
  std::int64_t loaded_ = -1;
  std::vector<std::int64_t> values_;
};

}  // namespace gravure::grv
