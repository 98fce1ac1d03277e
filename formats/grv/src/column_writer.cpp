#include <algorithm>
#include <array>

#include "column_codec.hpp"
#include "column_table.hpp"
#include "hdf5_data.hpp"

namespace gravure::grv {

const ColumnShape& set_point_columns(bool focus_axis) {
  static const ColumnShape shape{"set_points", 8,
                                 "counts of X Y Z A C U V and of the path covered, as /plan says; in each chunk "
                                 "differenced three times down the rows"};
  static const ColumnShape with_focus{"set_points", 9,
                                      "counts of X Y Z A C U V W and of the path covered, as /plan says; in each chunk "
                                      "differenced three times down the rows"};
  return focus_axis ? with_focus : shape;
}

const ColumnShape& target_columns() {
  static const ColumnShape shape{"targets", 7,
                                 "path covered, x, y, z in 1e-9 mm, normal in 1e-12; in each chunk differenced three "
                                 "times down the rows"};
  return shape;
}

Result<void> ColumnWriter::open(hid_t group) {
  const std::array<hsize_t, 2> shape = {0, shape_.columns};
  const std::array<hsize_t, 2> most = {H5S_UNLIMITED, shape_.columns};
  const std::array<hsize_t, 2> chunk = {kRowsPerChunk, shape_.columns};
  const Handle space(H5Screate_simple(2, shape.data(), most.data()), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  H5Pset_chunk(creation.get(), 2, chunk.data());
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);
  herr_t status = 0;
  if (options_.compression != Compression::none) {
    status = H5Pset_shuffle(creation.get());
  }
  if (status >= 0 && options_.compression == Compression::zstd) {
    const auto level = static_cast<unsigned>(options_.zstd_level);
    status = H5Pset_filter(creation.get(), kZstdFilter, H5Z_FLAG_OPTIONAL, 1, &level);
  } else if (status >= 0 && options_.compression == Compression::deflate) {
    status = H5Pset_deflate(creation.get(), 1);
  }
  data_ = {H5Dcreate2(group, shape_.name.c_str(), H5T_STD_I64LE, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
           H5Dclose};
  if (status < 0 || !data_.valid()) {
    return write_failure("path/" + shape_.name);
  }
  return write_text_attribute(data_.get(), "unit", shape_.unit);
}

Result<void> ColumnWriter::put(hid_t group, Hdf5Channel& channel, std::span<const std::int64_t> values) {
  if (!data_.valid()) {
    GRAVURE_CHECK(open(group));
  }
  const std::size_t whole = kRowsPerChunk * shape_.columns;
  while (!values.empty()) {
    const std::size_t fits = std::min(values.size(), whole - pending_.size());
    pending_.insert(pending_.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(fits));
    values = values.subspan(fits);
    rows_ += static_cast<std::int64_t>(fits / shape_.columns);
    if (pending_.size() == whole) {
      GRAVURE_CHECK(write_chunk(channel));
    }
  }
  return {};
}

Result<void> ColumnWriter::write_chunk(Hdf5Channel& channel) {
  const std::array<hsize_t, 2> extent = {static_cast<hsize_t>(rows_), shape_.columns};
  const std::array<hsize_t, 2> place = {chunks_.size() * std::size_t{kRowsPerChunk}, 0};
  pending_.resize(kRowsPerChunk * shape_.columns);
  GRAVURE_TRY(const Packed packed, pack_columns(options_.compression, options_.zstd_level, shape_.columns, pending_));
  pending_.clear();
  const bool skipped = packed.raw && options_.compression != Compression::none;
  channel.watch(packed.bytes.data());
  if (H5Dset_extent(data_.get(), extent.data()) < 0 ||
      H5Dwrite_chunk(data_.get(), H5P_DEFAULT, skipped ? 2U : 0U, place.data(), packed.bytes.size(),
                     packed.bytes.data()) < 0) {
    return write_failure("path/" + shape_.name);
  }
  const std::optional<std::uint64_t> offset = channel.watched_offset();
  if (!offset) {
    return Error{ErrorCode::io, "HDF5 did not write path/" + shape_.name + " straight through"};
  }
  chunks_.push_back({*offset, packed.bytes.size(), hash_of(packed.bytes)});
  return {};
}

Result<void> ColumnWriter::finish(hid_t group, Hdf5Channel& channel) {
  if (rows_ == 0) {
    return {};
  }
  if (!pending_.empty()) {
    GRAVURE_CHECK(write_chunk(channel));
  }
  close();
  std::vector<std::uint64_t> table;
  for (const ColumnChunk& chunk : chunks_) {
    table.insert(table.end(), {chunk.offset_bytes, chunk.stored_bytes, chunk.checksum});
  }
  const std::array<hsize_t, 2> shape = {chunks_.size(), 3};
  return write_table<std::uint64_t>(group, (shape_.name + "_chunks").c_str(), table, shape,
                                    "bytes from the start of the file, bytes stored, their XXH3-64");
}

}  // namespace gravure::grv
