#include "reader.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "codec.hpp"
#include "column_table.hpp"
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

/// What is known of a program before its first chunk is read: the same for all of its readers.
struct OpenedProgram {
  std::shared_ptr<Hdf5Channel> channel;
  ProgramHeader header;
  Layout layout;
  ChunkTables tables;
  std::vector<std::uint64_t> checksums;
  std::vector<std::int64_t> fired;
  Compression compression = Compression::none;
  ColumnReader set_points;  ///< nothing of it read: readers read with copies
  ColumnReader targets;
  bool shard = false;
  std::uint32_t format_version = 0;

  /// Where the bits of a layer's chunk are; of no chunk where there is no such layer.
  ChunkAddress stored_at(ChunkAddress address) const {
    const std::vector<std::uint32_t>& bits_of_layer = header.bits_of_layer;
    if (bits_of_layer.empty()) {
      return address;
    }
    const bool there = address.layer >= 0 && address.layer < static_cast<std::int64_t>(bits_of_layer.size());
    return {there ? std::int64_t{bits_of_layer[static_cast<std::size_t>(address.layer)]} : -1, address.chunk};
  }
};

namespace {

Result<Compression> read_compression(hid_t creation) {
  const int filters = H5Pget_nfilters(creation);
  if (filters == 0) {
    return Compression::none;
  }
  unsigned flags = 0;
  std::size_t values = 0;
  unsigned config = 0;
  const H5Z_filter_t id = H5Pget_filter2(creation, 0, &flags, &values, nullptr, 0, nullptr, &config);
  if (filters == 1 && id == kZstdFilter) {
    return Compression::zstd;
  }
  if (filters == 1 && id == H5Z_FILTER_DEFLATE) {
    return Compression::deflate;
  }
  return Error{ErrorCode::bad_file, "layers/bits: compressed by HDF5 filter " + std::to_string(id) +
                                        ": must be 32015 (zstd), 1 (deflate) or none"};
}

/// The bits' shape and chunks must be those of the seal, so that other HDF5 programs see what we see.
Result<Compression> check_bits(hid_t file, const Layout& layout) {
  const Handle bits(H5Dopen2(file, "layers/bits", H5P_DEFAULT), H5Dclose);
  if (!bits.valid()) {
    return Error{ErrorCode::bad_file, "layers/bits: missing"};
  }
  const Handle space(H5Dget_space(bits.get()), H5Sclose);
  const Handle type(H5Dget_type(bits.get()), H5Tclose);
  const Handle creation(H5Dget_create_plist(bits.get()), H5Pclose);
  std::array<hsize_t, 3> shape = {};
  std::array<hsize_t, 3> chunk = {};
  if (H5Sget_simple_extent_ndims(space.get()) != 3 || H5Pget_layout(creation.get()) != H5D_CHUNKED ||
      H5Tequal(type.get(), H5T_STD_U8LE) <= 0 || H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr) != 3 ||
      H5Pget_chunk(creation.get(), 3, chunk.data()) != 3) {
    return Error{ErrorCode::bad_file, "layers/bits: is no chunked table [layers][lines][bytes] of bytes"};
  }
  const auto as_size = [](std::int64_t value) { return static_cast<hsize_t>(value); };
  const std::array<hsize_t, 3> expected = {as_size(layout.layers), as_size(layout.lines_per_layer),
                                           as_size(layout.line_bytes)};
  const std::array<hsize_t, 3> expected_chunk = {1, as_size(layout.lines_per_chunk), expected[2]};
  if (shape != expected || chunk != expected_chunk) {
    return Error{ErrorCode::bad_file, "layers/bits: has " + std::to_string(shape[0]) + " layers of " +
                                          std::to_string(shape[1]) + " lines of " + std::to_string(shape[2]) +
                                          " bytes, " + std::to_string(chunk[1]) + " lines a chunk, the seal says " +
                                          std::to_string(expected[0]) + ", " + std::to_string(expected[1]) + ", " +
                                          std::to_string(expected[2]) + ", " + std::to_string(expected_chunk[1])};
  }
  return read_compression(creation.get());
}

Result<void> read_path(hid_t file, OpenedProgram& opened, std::uint64_t file_bytes) {
  const std::optional<PathPlan>& path = opened.header.plan.path;
  if (!path) {
    return {};
  }
  GRAVURE_TRY(opened.set_points, ColumnReader::open(file, set_point_columns(path->has_focus_axis()),
                                                    set_points_of(opened.header.plan), file_bytes));
  if (path->targets > 0) {
    GRAVURE_TRY(opened.targets, ColumnReader::open(file, target_columns(), path->targets, file_bytes));
  }
  return {};
}

Result<void> read_contents(hid_t file, OpenedProgram& opened, std::uint64_t file_bytes) {
  const Layout& layout = opened.layout;
  GRAVURE_TRY(opened.header, read_header(file, layout, opened.shard, opened.format_version));
  GRAVURE_TRY(opened.compression, check_bits(file, layout));
  const std::array<hsize_t, 2> shape = {static_cast<hsize_t>(layout.layers),
                                        static_cast<hsize_t>(layout.chunks_per_layer())};
  GRAVURE_TRY(opened.checksums, read_table<std::uint64_t>(file, "layers/checksums", shape));
  GRAVURE_TRY(opened.fired, read_table<std::int64_t>(file, "layers/chunk_fired_pixels", shape));
  GRAVURE_CHECK(check_header(opened.header, layout, opened.fired, ErrorCode::bad_file));
  return read_path(file, opened, file_bytes);
}

/// Reads what HDF5 has to say; the file has been verified before, so that the library meets no damaged structure.
Result<void> read_hdf5(OpenedProgram& opened) {
  const std::shared_ptr<Hdf5Channel>& channel = opened.channel;
  const Hdf5Session session;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG);
  const std::string& path = channel->file().path();
  if (!set_channel(access.get(), channel)) {
    return Error{ErrorCode::io, path + ": the HDF5 file driver is not available: " + hdf5_reason()};
  }
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file.valid()) {
    const Error unreadable{ErrorCode::bad_file, path + ": HDF5 cannot read it: " + hdf5_reason()};
    return channel->failure().value_or(unreadable);
  }
  GRAVURE_TRY(const std::uint64_t file_bytes, channel->file().size());
  if (const auto read = read_contents(file.get(), opened, file_bytes); !read) {
    return channel->failure().value_or(Error{read.error().code, path + ": " + read.error().message});
  }
  return {};
}

}  // namespace

/// A verified program file. Chunks are read straight from their places in the file, without the HDF5 library.
class GrvSource final : public LineSource {
 public:
  explicit GrvSource(std::shared_ptr<const OpenedProgram> opened)
      : opened_(std::move(opened)), set_points_(opened_->set_points), targets_(opened_->targets) {}

  const ProgramHeader& header() const noexcept override { return opened_->header; }
  std::int64_t lines_per_chunk() const noexcept override { return opened_->layout.lines_per_chunk; }
  Result<StoredChunk> fetch(ChunkAddress address) override;
  Result<void> decode(const StoredChunk& chunk, std::span<std::byte> out) const override;
  Result<void> read_set_points(std::int64_t first, std::span<PathSetPoint> out) override;
  Result<void> read_targets(std::int64_t first, std::span<PathTarget> out) override;

 private:
  std::string place(ChunkAddress address) const;
  Error damaged(ChunkAddress address, const std::string& why) const {
    return {ErrorCode::bad_file, place(address) + ": " + why + ": get a good copy, or compile the job again"};
  }
  Result<void> unpack_whole(const StoredChunk& chunk, std::span<std::byte> out) const;
  Result<void> unpack_partial(const StoredChunk& chunk, std::span<std::byte> out) const;

  const ByteFile& file() const noexcept { return opened_->channel->file(); }

  std::shared_ptr<const OpenedProgram> opened_;
  ColumnReader set_points_;
  ColumnReader targets_;
};

std::string GrvSource::place(ChunkAddress address) const {
  const std::size_t index = opened_->layout.index_of(opened_->stored_at(address));
  return file().path() + ": " + opened_->layout.describe(address) + " at byte " +
         std::to_string(opened_->tables.offset_bytes[index]);
}

Result<StoredChunk> GrvSource::fetch(ChunkAddress address) {
  const ChunkAddress stored = opened_->stored_at(address);
  if (!opened_->layout.contains(stored)) {
    return Error{ErrorCode::bad_argument, file().path() + ": " + opened_->layout.describe(address) + ": there are " +
                                              std::to_string(opened_->header.layers.size()) + " layers of " +
                                              std::to_string(opened_->layout.chunks_per_layer()) + " chunks"};
  }
  const std::size_t index = opened_->layout.index_of(stored);
  StoredChunk chunk;
  chunk.address = address;
  chunk.bytes.resize(static_cast<std::size_t>(opened_->tables.stored_bytes[index]));
  // Compressed chunks are shorter than raw ones by a tenth at least, so the length tells which it is.
  const bool raw = chunk.bytes.size() == static_cast<std::size_t>(opened_->layout.chunk_bytes());
  chunk.filter_mask = raw && opened_->compression != Compression::none ? 1U : 0U;
  chunk.checksum = opened_->checksums[index];
  chunk.fired_pixels = opened_->fired[index];
  GRAVURE_TRY(const std::size_t got, file().read(opened_->tables.offset_bytes[index], chunk.bytes));
  if (got != chunk.bytes.size()) {
    return damaged(address, "the file has become shorter since it was opened");
  }
  return chunk;
}

Result<void> GrvSource::unpack_whole(const StoredChunk& chunk, std::span<std::byte> out) const {
  const bool raw = chunk.filter_mask != 0 || opened_->compression == Compression::none;
  if (const auto unpacked = unpack(opened_->compression, raw, chunk.bytes, out); !unpacked) {
    return damaged(chunk.address, unpacked.error().message);
  }
  return {};
}

Result<void> GrvSource::unpack_partial(const StoredChunk& chunk, std::span<std::byte> out) const {
  thread_local std::vector<std::byte> whole;
  whole.resize(static_cast<std::size_t>(opened_->layout.chunk_bytes()));
  GRAVURE_CHECK(unpack_whole(chunk, whole));
  const auto rest = std::span(whole).subspan(out.size());
  if (std::any_of(rest.begin(), rest.end(), [](std::byte byte) { return byte != std::byte{0}; })) {
    return damaged(chunk.address, "pixels fire behind the last line");
  }
  std::copy_n(whole.begin(), out.size(), out.begin());
  return {};
}

Result<void> GrvSource::decode(const StoredChunk& chunk, std::span<std::byte> out) const {
  const Layout& layout = opened_->layout;
  const bool known = layout.contains(opened_->stored_at(chunk.address));
  const auto bytes = known ? static_cast<std::size_t>(layout.lines_in(chunk.address.chunk) * layout.line_bytes) : 0;
  if (!known || out.size() != bytes) {
    return Error{ErrorCode::bad_argument, file().path() + ": " + layout.describe(chunk.address) +
                                              ": no such chunk, or room for " + std::to_string(out.size()) +
                                              " bytes instead of " + std::to_string(bytes)};
  }
  const std::size_t index = layout.index_of(opened_->stored_at(chunk.address));
  if (hash_of(chunk.bytes) != opened_->checksums[index]) {
    return damaged(chunk.address, "altered, its checksum does not hold");
  }
  const bool whole = bytes == static_cast<std::size_t>(layout.chunk_bytes());
  GRAVURE_CHECK(whole ? unpack_whole(chunk, out) : unpack_partial(chunk, out));
  if ((merge_last_bytes(out, layout.line_bytes) & unused_bits(opened_->header.plan.line.pixels)) != 0) {
    return damaged(chunk.address, "bits are set beyond the last pixel of a line");
  }
  if (raster::popcount(out) != opened_->fired[index]) {
    return damaged(chunk.address, std::to_string(raster::popcount(out)) + " pixels fire, the table says " +
                                      std::to_string(opened_->fired[index]));
  }
  return {};
}

Result<void> GrvSource::read_set_points(std::int64_t first, std::span<PathSetPoint> out) {
  const Plan& plan = opened_->header.plan;
  const bool focus_axis = plan.path && plan.path->has_focus_axis();
  std::vector<std::int64_t> rows(out.size() * set_point_columns(focus_axis).columns);
  GRAVURE_CHECK(set_points_.read(file(), first, rows));
  set_points_from(rows, focus_axis, out);
  return {};
}

Result<void> GrvSource::read_targets(std::int64_t first, std::span<PathTarget> out) {
  std::vector<std::int64_t> rows(out.size() * target_columns().columns);
  GRAVURE_CHECK(targets_.read(file(), first, rows));
  targets_from(rows, out);
  return {};
}

namespace {

Result<std::shared_ptr<const OpenedProgram>> open_any(std::unique_ptr<ByteFile> file, std::int64_t memory_bytes) {
  auto opened = std::make_shared<OpenedProgram>();
  opened->channel = std::make_shared<Hdf5Channel>(std::move(file));
  GRAVURE_TRY(Sealed sealed, verify_seal(opened->channel->file(), memory_bytes));
  opened->layout = sealed.seal.layout;
  opened->shard = sealed.seal.shard;
  opened->format_version = sealed.seal.format_version;
  opened->tables = std::move(sealed.tables);
  GRAVURE_CHECK(read_hdf5(*opened));
  return std::shared_ptr<const OpenedProgram>(std::move(opened));
}

Result<std::shared_ptr<const OpenedProgram>> open_whole(std::unique_ptr<ByteFile> file, std::int64_t memory_bytes) {
  GRAVURE_TRY(std::shared_ptr<const OpenedProgram> opened, open_any(std::move(file), memory_bytes));
  if (const std::optional<Shard> shard = opened->header.shard) {
    return Error{ErrorCode::bad_file, opened->channel->file().path() + ": is a shard, revolutions " +
                                          std::to_string(shard->first) + " to " + std::to_string(shard->end - 1) +
                                          " of " + std::to_string(opened->header.plan.job.revolutions) +
                                          ": put all shards of the job together with `gravure merge`"};
  }
  return opened;
}

constexpr std::int64_t kUnbounded = std::numeric_limits<std::int64_t>::max();

}  // namespace

Result<GrvPart> open_part(std::unique_ptr<ByteFile> file) {
  GRAVURE_TRY(std::shared_ptr<const OpenedProgram> opened, open_any(std::move(file), kUnbounded));
  const Compression compression = opened->compression;
  return GrvPart{std::make_unique<GrvSource>(std::move(opened)), compression};
}

Result<std::unique_ptr<LineSource>> open_program(std::unique_ptr<ByteFile> file) {
  GRAVURE_TRY(std::shared_ptr<const OpenedProgram> opened, open_whole(std::move(file), kUnbounded));
  return std::unique_ptr<LineSource>(std::make_unique<GrvSource>(std::move(opened)));
}

}  // namespace grv

Result<std::unique_ptr<LineSource>> open_grv(const std::string& path) {
  GRAVURE_TRY(auto file, grv::open_file(path, grv::OpenFor::reading, path));
  return grv::open_program(std::move(file));
}

Result<GrvProgram> GrvProgram::open(const std::string& path, std::int64_t memory_bytes) {
  GRAVURE_TRY(auto file, grv::open_file(path, grv::OpenFor::reading, path));
  GRAVURE_TRY(std::shared_ptr<const grv::OpenedProgram> opened, grv::open_whole(std::move(file), memory_bytes));
  return GrvProgram(std::move(opened));
}

const ProgramHeader& GrvProgram::header() const noexcept {
  return opened_->header;
}

std::unique_ptr<LineSource> GrvProgram::reader() const {
  return std::make_unique<grv::GrvSource>(opened_);
}

std::int64_t GrvProgram::table_bytes() const noexcept {
  return grv::kTableBytesPerChunk * opened_->layout.chunks();
}

Result<GrvPart> open_grv_part(const std::string& path) {
  GRAVURE_TRY(auto file, grv::open_file(path, grv::OpenFor::reading, path));
  return grv::open_part(std::move(file));
}

}  // namespace gravure
