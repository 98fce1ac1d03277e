#include <hdf5.h>

#include <array>
#include <atomic>
#include <optional>
#include <utility>
#include <vector>

#include "byte_file.hpp"
#include "codec.hpp"
#include "column_table.hpp"
#include "gravure/core/file_output.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/raster/count.hpp"
#include "hdf5_channel.hpp"
#include "hdf5_data.hpp"
#include "hdf5_session.hpp"
#include "header_check.hpp"
#include "header_io.hpp"
#include "last_bytes.hpp"
#include "layout.hpp"
#include "path_rows.hpp"
#include "seal.hpp"

namespace gravure {
namespace grv {
namespace {

/// Everything of the open HDF5 file, made and used within an Hdf5Session; members close in reverse order.
struct OpenProgram {
  Handle file;
  Handle layers;
  Handle offset_table;
  Handle stored_table;
  Handle bits;
  Handle path;  ///< once there is something in it
};

Result<void> set_filter(hid_t creation, const GrvOptions& options) {
  herr_t status = 0;
  if (options.compression == Compression::zstd) {
    const auto level = static_cast<unsigned>(options.zstd_level);
    // Optional: a chunk may be stored raw, and programs without the filter can still read everything else.
    status = H5Pset_filter(creation, kZstdFilter, H5Z_FLAG_OPTIONAL, 1, &level);
  } else if (options.compression == Compression::deflate) {
    status = H5Pset_deflate(creation, 1);
  }
  if (status < 0) {
    return write_failure("the compression of layers/bits");
  }
  return {};
}

Result<Handle> create_bits(hid_t layers_group, const Layout& layout, const GrvOptions& options) {
  const std::array<hsize_t, 3> shape = {static_cast<hsize_t>(layout.layers),
                                        static_cast<hsize_t>(layout.lines_per_layer),
                                        static_cast<hsize_t>(layout.line_bytes)};
  const std::array<hsize_t, 3> chunk = {1, static_cast<hsize_t>(layout.lines_per_chunk), shape[2]};
  const Handle space = plain_space(shape);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  H5Pset_chunk(creation.get(), 3, chunk.data());
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);
  GRAVURE_CHECK(set_filter(creation.get(), options));
  Handle bits(H5Dcreate2(layers_group, "bits", H5T_STD_U8LE, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
              H5Dclose);
  if (!bits.valid()) {
    return write_failure("layers/bits");
  }
  GRAVURE_CHECK(write_text_attribute(bits.get(), "unit", "8 pulse slots, most significant bit first, 1 fires"));
  GRAVURE_CHECK(write_text_attribute(bits.get(), "axes", "layer, line in time order, byte in time order"));
  return bits;
}

/// The file with all that is known before the first chunk. The chunk tables come first, so that a file cut off later
/// still says which chunks are gone.
Result<OpenProgram> create_program(const std::shared_ptr<Hdf5Channel>& channel, const Layout& layout,
                                   const GrvOptions& options) {
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_userblock(creation.get(), Seal::kBytes);
  H5Pset_obj_track_times(creation.get(), false);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // The oldest structures: every HDF5 of the last fifteen years reads them.
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  if (!set_channel(access.get(), channel)) {
    return write_failure("through the HDF5 file driver");
  }
  OpenProgram program;
  program.file = {H5Fcreate(channel->file().path().c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose};
  if (!program.file.valid()) {
    return write_failure("the HDF5 file");
  }
  GRAVURE_CHECK(write_root(program.file.get(), options.focus_axis ? kFocusAxisFormatVersion : 1));
  GRAVURE_TRY(program.layers, create_group(program.file.get(), "layers"));
  const std::array<hsize_t, 2> tables = {static_cast<hsize_t>(layout.layers),
                                         static_cast<hsize_t>(layout.chunks_per_layer())};
  GRAVURE_TRY(program.offset_table, create_table(program.layers.get(), "offset_bytes", H5T_STD_U64LE, tables));
  GRAVURE_TRY(program.stored_table, create_table(program.layers.get(), "stored_bytes", H5T_STD_U64LE, tables));
  GRAVURE_CHECK(write_text_attribute(program.offset_table.get(), "unit", "bytes from the start of the file"));
  GRAVURE_CHECK(write_text_attribute(program.stored_table.get(), "unit", "bytes"));
  GRAVURE_TRY(program.bits, create_bits(program.layers.get(), layout, options));
  return program;
}

}  // namespace

/// The chunks of a program on their way into a file.
class GrvSink final : public LineSink {
 public:
  GrvSink(std::string path, std::shared_ptr<Hdf5Channel> channel, OpenProgram program, const Layout& layout,
          const GrvOptions& options)
      : path_(std::move(path)),
        channel_(std::move(channel)),
        program_(std::move(program)),
        layout_(layout),
        options_(options),
        tables_{std::vector<std::uint64_t>(count()), std::vector<std::uint64_t>(count())},
        checksums_(count()),
        fired_(count()),
        set_points_(set_point_columns(options.focus_axis), options),
        targets_(target_columns(), options) {}
  GrvSink(const GrvSink&) = delete;
  GrvSink& operator=(const GrvSink&) = delete;
  ~GrvSink() override {
    const Hdf5Session session;
    give_up();
  }

  /// finish() puts the file in its place; else that is the caller's.
  void commits(FileOutput output) { output_ = std::move(output); }

  std::int64_t lines_per_chunk() const noexcept override { return layout_.lines_per_chunk; }
  Result<StoredChunk> encode(ChunkAddress address, std::span<const std::byte> lines) const override;
  Result<void> put(const StoredChunk& chunk) override;
  Result<void> put_set_points(std::span<const PathSetPoint> next) override;
  Result<void> put_targets(std::span<const PathTarget> next) override;
  Result<void> finish(const ProgramHeader& header) override;

 private:
  std::size_t count() const { return static_cast<std::size_t>(layout_.chunks()); }
  Error refuse(const std::string& what) const { return {ErrorCode::bad_argument, path_ + ": " + what}; }
  Result<void> check_open() const;
  Result<void> check_chunk(const StoredChunk& chunk) const;
  Result<void> check_complete(const ProgramHeader& header) const;
  Result<void> write_all(const ProgramHeader& header);
  Result<void> write_chunk_tables();
  Result<void> put_rows(ColumnWriter& table, std::span<const std::int64_t> rows);
  Result<void> write_path();
  Error fail(const Error& error);
  void give_up();

  std::string path_;
  std::optional<FileOutput> output_;
  std::shared_ptr<Hdf5Channel> channel_;
  OpenProgram program_;
  Layout layout_;
  GrvOptions options_;
  ChunkTables tables_;  ///< stored_bytes 0: not put yet
  std::vector<std::uint64_t> checksums_;
  std::vector<std::int64_t> fired_;
  ColumnWriter set_points_;
  ColumnWriter targets_;
  mutable std::atomic<std::uint8_t> last_bytes_{0};  ///< of all lines encoded, OR-ed
};

Result<StoredChunk> GrvSink::encode(ChunkAddress address, std::span<const std::byte> lines) const {
  if (!layout_.contains(address)) {
    return refuse(layout_.describe(address) + ": there are " + std::to_string(layout_.layers) + " layers of " +
                  std::to_string(layout_.chunks_per_layer()) + " chunks");
  }
  const auto bytes = static_cast<std::size_t>(layout_.lines_in(address.chunk) * layout_.line_bytes);
  if (lines.size() != bytes) {
    return refuse(layout_.describe(address) + ": " + std::to_string(lines.size()) + " bytes, must be " +
                  std::to_string(bytes));
  }
  last_bytes_.fetch_or(merge_last_bytes(lines, layout_.line_bytes), std::memory_order_relaxed);
  const auto whole = static_cast<std::size_t>(layout_.chunk_bytes());
  thread_local std::vector<std::byte> padded;
  if (bytes < whole) {
    padded.reserve(whole);
    padded.assign(lines.begin(), lines.end());
    padded.resize(whole, std::byte{0});
  }
  GRAVURE_TRY(Packed packed, pack(options_.compression, options_.zstd_level,
                                  bytes < whole ? std::span<const std::byte>(padded) : lines));
  StoredChunk chunk;
  chunk.address = address;
  chunk.bytes = std::move(packed.bytes);
  chunk.filter_mask = packed.raw && options_.compression != Compression::none ? 1U : 0U;
  chunk.checksum = hash_of(chunk.bytes);
  chunk.fired_pixels = raster::popcount(lines);
  return chunk;
}

Result<void> GrvSink::check_open() const {
  if (!program_.file.valid()) {
    return refuse("finished, or given up after an earlier error: start again");
  }
  return {};
}

Result<void> GrvSink::check_chunk(const StoredChunk& chunk) const {
  if (!layout_.contains(chunk.address)) {
    return refuse(layout_.describe(chunk.address) + ": no such chunk");
  }
  if (tables_.stored_bytes[layout_.index_of(chunk.address)] != 0) {
    return refuse(layout_.describe(chunk.address) + ": put before");
  }
  const auto whole = static_cast<std::size_t>(layout_.chunk_bytes());
  const bool raw = chunk.filter_mask != 0 || options_.compression == Compression::none;
  const bool size_fits = raw ? chunk.bytes.size() == whole : !chunk.bytes.empty() && chunk.bytes.size() < whole;
  if (!size_fits || chunk.filter_mask > 1) {
    return refuse(layout_.describe(chunk.address) + ": altered since encode()");
  }
  return {};
}

/// Prefers what the operating system said to what HDF5 made of it, closes the file and removes it.
Error GrvSink::fail(const Error& error) {
  Error told = channel_->failure().value_or(Error{error.code, path_ + ": " + error.message});
  give_up();
  return told;
}

void GrvSink::give_up() {
  channel_->abandon();
  set_points_.close();
  targets_.close();
  program_ = {};
  output_.reset();
}

Result<void> GrvSink::put(const StoredChunk& chunk) {
  GRAVURE_CHECK(check_open());
  GRAVURE_CHECK(check_chunk(chunk));
  const Hdf5Session session;
  const std::array<hsize_t, 3> place = {static_cast<hsize_t>(chunk.address.layer),
                                        static_cast<hsize_t>(layout_.first_line(chunk.address.chunk)), 0};
  channel_->watch(chunk.bytes.data());
  if (H5Dwrite_chunk(program_.bits.get(), H5P_DEFAULT, chunk.filter_mask, place.data(), chunk.bytes.size(),
                     chunk.bytes.data()) < 0 ||
      channel_->failure()) {
    return fail(write_failure(layout_.describe(chunk.address)));
  }
  const std::optional<std::uint64_t> offset = channel_->watched_offset();
  if (!offset) {
    return fail({ErrorCode::io, "HDF5 did not write " + layout_.describe(chunk.address) + " straight through"});
  }
  const std::size_t index = layout_.index_of(chunk.address);
  tables_.offset_bytes[index] = *offset;
  tables_.stored_bytes[index] = chunk.bytes.size();
  checksums_[index] = chunk.checksum;
  fired_[index] = chunk.fired_pixels;
  return {};
}

Result<void> GrvSink::put_rows(ColumnWriter& table, std::span<const std::int64_t> rows) {
  const Hdf5Session session;
  if (!program_.path.valid()) {
    Result<Handle> group = create_group(program_.file.get(), "path");
    if (!group) {
      return fail(group.error());
    }
    program_.path = std::move(group).value();
  }
  if (const auto put = table.put(program_.path.get(), *channel_, rows); !put || channel_->failure()) {
    return fail(put ? write_failure("path") : put.error());
  }
  return {};
}

Result<void> GrvSink::put_set_points(std::span<const PathSetPoint> next) {
  GRAVURE_CHECK(check_open());
  return put_rows(set_points_, rows_of(next, options_.focus_axis));
}

Result<void> GrvSink::put_targets(std::span<const PathTarget> next) {
  GRAVURE_CHECK(check_open());
  const auto rows = rows_of(next);
  if (!rows) {
    return refuse(rows.error().message);
  }
  return put_rows(targets_, rows.value());
}

Result<void> GrvSink::write_path() {
  if (!program_.path.valid()) {
    return {};
  }
  GRAVURE_CHECK(set_points_.finish(program_.path.get(), *channel_));
  return targets_.finish(program_.path.get(), *channel_);
}

Result<void> GrvSink::check_complete(const ProgramHeader& header) const {
  for (std::size_t i = 0; i < count(); ++i) {
    if (tables_.stored_bytes[i] == 0) {
      return refuse(layout_.describe(layout_.address_of(i)) + ": was not put");
    }
  }
  if (header.format_version != format_version_of(header.plan)) {
    return refuse("format_version = " + std::to_string(header.format_version) + ": this gravure writes " +
                  std::to_string(format_version_of(header.plan)) + " with such a plan");
  }
  if (options_.focus_axis != (header.plan.path && header.plan.path->has_focus_axis())) {
    return refuse(std::string("the plan has ") + (options_.focus_axis ? "no" : "a") +
                  " focus axis, its set-points were put " + (options_.focus_axis ? "with" : "without") + " W");
  }
  if (const auto checked = check_header(header, layout_, fired_, ErrorCode::bad_argument); !checked) {
    return refuse(checked.error().message);
  }
  const std::int64_t targets = header.plan.path ? header.plan.path->targets : 0;
  if (set_points_.rows() != set_points_of(header.plan) || targets_.rows() != targets) {
    return refuse(std::to_string(set_points_.rows()) + " set-points and " + std::to_string(targets_.rows()) +
                  " wanted points were put: the plan has " + std::to_string(set_points_of(header.plan)) + " and " +
                  std::to_string(targets));
  }
  if ((last_bytes_.load() & unused_bits(header.plan.line.pixels)) != 0) {
    return refuse("a line has bits set beyond its last pixel, number " + std::to_string(header.plan.line.pixels - 1));
  }
  return {};
}

Result<void> GrvSink::write_chunk_tables() {
  const std::array<hsize_t, 2> shape = {static_cast<hsize_t>(layout_.layers),
                                        static_cast<hsize_t>(layout_.chunks_per_layer())};
  GRAVURE_CHECK(
      write_values(program_.offset_table.get(), H5T_NATIVE_UINT64, tables_.offset_bytes.data(), "layers/offset_bytes"));
  GRAVURE_CHECK(
      write_values(program_.stored_table.get(), H5T_NATIVE_UINT64, tables_.stored_bytes.data(), "layers/stored_bytes"));
  GRAVURE_CHECK(write_table<std::uint64_t>(program_.layers.get(), "checksums", checksums_, shape,
                                           "XXH3-64 of the chunk as stored"));
  return write_table<std::int64_t>(program_.layers.get(), "chunk_fired_pixels", fired_, shape, "pixels");
}

Result<void> GrvSink::write_all(const ProgramHeader& header) {
  GRAVURE_CHECK(write_chunk_tables());
  GRAVURE_CHECK(write_path());
  GRAVURE_CHECK(write_header(program_.file.get(), program_.layers.get(), header));
  const haddr_t offset_table_at = H5Dget_offset(program_.offset_table.get());
  const haddr_t stored_table_at = H5Dget_offset(program_.stored_table.get());
  if (H5Fflush(program_.file.get(), H5F_SCOPE_GLOBAL) < 0) {
    return write_failure("the end of the file");
  }
  OpenProgram closing = std::move(program_);
  closing.path.reset();
  closing.bits.reset();
  closing.stored_table.reset();
  closing.offset_table.reset();
  closing.layers.reset();
  if (!closing.file.reset() || channel_->failure()) {
    return write_failure("the end of the file");
  }
  return write_seal(channel_->file(), layout_, tables_, offset_table_at, stored_table_at, header.shard.has_value(),
                    header.format_version);
}

Result<void> GrvSink::finish(const ProgramHeader& header) {
  GRAVURE_CHECK(check_open());
  GRAVURE_CHECK(check_complete(header));
  {
    const Hdf5Session session;
    if (const auto written = write_all(header); !written) {
      return fail(written.error());
    }
  }
  return output_ ? output_->commit() : Result<void>();
}

namespace {

Result<Layout> checked_layout(std::int64_t layers, std::int64_t lines_per_layer, std::int64_t line_bytes,
                              const GrvOptions& options) {
  if (options.zstd_level < 1 || options.zstd_level > 19) {
    return Error{ErrorCode::out_of_range, "zstd_level = " + std::to_string(options.zstd_level) + ": must be 1 to 19"};
  }
  return make_layout(layers, lines_per_layer, line_bytes, options.chunk_bytes);
}

Result<std::unique_ptr<GrvSink>> begin_sink(const FileOutput& output, const Layout& layout, const GrvOptions& options) {
  const std::string& path = output.path();
  GRAVURE_TRY(auto file, open_file(output.temporary_path(), OpenFor::writing, path));
  auto channel = std::make_shared<Hdf5Channel>(std::move(file));
  const Hdf5Session session;
  auto program = create_program(channel, layout, options);
  if (!program || channel->failure()) {
    const Error error = program ? write_failure("the HDF5 file") : program.error();
    return channel->failure().value_or(Error{error.code, path + ": " + error.message});
  }
  return std::make_unique<GrvSink>(path, channel, std::move(program).value(), layout, options);
}

}  // namespace
}  // namespace grv

Result<std::unique_ptr<LineSink>> create_grv(const std::string& path, std::int64_t layers, std::int64_t lines_per_layer,
                                             std::int64_t line_bytes, const GrvOptions& options) {
  GRAVURE_TRY(const grv::Layout layout, grv::checked_layout(layers, lines_per_layer, line_bytes, options));
  GRAVURE_TRY(FileOutput output, FileOutput::create(path));
  GRAVURE_TRY(std::unique_ptr<grv::GrvSink> sink, grv::begin_sink(output, layout, options));
  sink->commits(std::move(output));
  return std::unique_ptr<LineSink>(std::move(sink));
}

Result<std::unique_ptr<LineSink>> stage_grv(const FileOutput& output, std::int64_t layers, std::int64_t lines_per_layer,
                                            std::int64_t line_bytes, const GrvOptions& options) {
  GRAVURE_TRY(const grv::Layout layout, grv::checked_layout(layers, lines_per_layer, line_bytes, options));
  GRAVURE_TRY(std::unique_ptr<grv::GrvSink> sink, grv::begin_sink(output, layout, options));
  return std::unique_ptr<LineSink>(std::move(sink));
}

}  // namespace gravure
