#include "seal.hpp"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>

#include "codec.hpp"
#include "gravure/core/units.hpp"

namespace gravure::grv {
namespace {

constexpr std::string_view kMagic = "gravure program\n";
constexpr std::string_view kShardMagic = "gravure shard  \n";
static_assert(kMagic.size() == kShardMagic.size());
constexpr std::size_t kOwnHashAt = Seal::kBytes - 8;  // magic, version and this stay in place in every version
constexpr std::size_t kReadBytes = std::size_t{1} << 15;

void put_integer(std::byte* at, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) {
    at[i] = static_cast<std::byte>(value >> (8 * i));
  }
}

std::uint64_t get_integer(const std::byte* at, int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) {
    value |= std::to_integer<std::uint64_t>(at[i]) << (8 * i);
  }
  return value;
}

std::int64_t get_signed(const std::byte* at) {
  return static_cast<std::int64_t>(get_integer(at, 8));
}

Error bad(const ByteFile& file, const std::string& what) {
  return {ErrorCode::bad_file, file.path() + ": " + what};
}

struct FreeState {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

/// Hashes ranges of a file one after the other.
class RangeHash {
 public:
  explicit RangeHash(const ByteFile& file) : file_(file), state_(XXH3_createState()), buffer_(kReadBytes) {
    XXH3_64bits_reset(state_.get());
  }
  Result<void> add(std::uint64_t begin, std::uint64_t end) {
    while (begin < end) {
      const std::span part(buffer_.data(), static_cast<std::size_t>(std::min<std::uint64_t>(end - begin, kReadBytes)));
      GRAVURE_CHECK(read_exactly(file_, begin, part));
      XXH3_64bits_update(state_.get(), part.data(), part.size());
      begin += part.size();
    }
    return {};
  }
  std::uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

 private:
  const ByteFile& file_;
  std::unique_ptr<XXH3_state_t, FreeState> state_;
  std::vector<std::byte> buffer_;
};

/// Chunk numbers by rising file offset.
std::vector<std::uint32_t> in_file_order(const ChunkTables& tables) {
  std::vector<std::uint32_t> order(tables.offset_bytes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&tables](std::uint32_t a, std::uint32_t b) { return tables.offset_bytes[a] < tables.offset_bytes[b]; });
  return order;
}

Result<std::vector<std::uint64_t>> read_table(const ByteFile& file, std::uint64_t at, std::size_t entries) {
  std::vector<std::byte> bytes(8 * entries);
  GRAVURE_CHECK(read_exactly(file, at, bytes));
  std::vector<std::uint64_t> table(entries);
  for (std::size_t i = 0; i < entries; ++i) {
    table[i] = get_integer(bytes.data() + 8 * i, 8);
  }
  return table;
}

/// Reads the tables, after making sure that the file is long enough to hold them: their size comes from the file.
Result<ChunkTables> read_tables(const ByteFile& file, const Seal& seal, std::uint64_t size) {
  const auto entries = static_cast<std::size_t>(seal.layout.chunks());
  for (const std::uint64_t at : {seal.offset_table_at, seal.stored_table_at}) {
    if (at < Seal::kBytes || at > size || (size - at) / 8 < entries) {
      return bad(file, "the chunk table at byte " + std::to_string(at) + " (" + std::to_string(entries) +
                           " chunks) lies beyond the end of the file at byte " + std::to_string(size) +
                           ": the file is cut off; get a whole copy");
    }
  }
  ChunkTables tables;
  GRAVURE_TRY(tables.offset_bytes, read_table(file, seal.offset_table_at, entries));
  GRAVURE_TRY(tables.stored_bytes, read_table(file, seal.stored_table_at, entries));
  if (hash_tables(tables) != seal.tables_hash) {
    return bad(file, "the chunk tables at bytes " + std::to_string(seal.offset_table_at) + " and " +
                         std::to_string(seal.stored_table_at) + " are damaged: get a good copy");
  }
  return tables;
}

Result<void> check_memory(const ByteFile& file, const Layout& layout, std::int64_t memory_bytes) {
  const std::int64_t need = kTableBytesPerChunk * layout.chunks();
  if (need <= memory_bytes) {
    return {};
  }
  return Error{ErrorCode::out_of_range, file.path() + ": memory budget of " + std::to_string(memory_bytes / kMiB) +
                                            " MiB: the tables of its " + std::to_string(layout.chunks()) +
                                            " chunks alone take " + std::to_string((need + kMiB - 1) / kMiB) +
                                            " MiB: raise --memory"};
}

Error cut_off(const ByteFile& file, const Seal& seal, const ChunkTables& tables, std::uint64_t size) {
  std::string what = "cut off at byte " + std::to_string(size) + " of " + std::to_string(seal.file_bytes);
  for (const std::uint32_t i : in_file_order(tables)) {
    const std::uint64_t begin = tables.offset_bytes[i];
    const std::uint64_t bytes = tables.stored_bytes[i];
    if (begin > size || bytes > size - begin) {
      what += "; first chunk lost: " + seal.layout.describe(seal.layout.address_of(i)) + " at byte " +
              std::to_string(begin);
      break;
    }
  }
  return bad(file, what + ": get a whole copy");
}

}  // namespace

std::array<std::byte, Seal::kBytes> encode_seal(const Seal& seal) {
  std::array<std::byte, Seal::kBytes> bytes = {};
  std::memcpy(bytes.data(), (seal.shard ? kShardMagic : kMagic).data(), kMagic.size());
  put_integer(&bytes[16], seal.format_version, 4);
  put_integer(&bytes[24], seal.file_bytes, 8);
  put_integer(&bytes[32], static_cast<std::uint64_t>(seal.layout.layers), 8);
  put_integer(&bytes[40], static_cast<std::uint64_t>(seal.layout.lines_per_layer), 8);
  put_integer(&bytes[48], static_cast<std::uint64_t>(seal.layout.line_bytes), 8);
  put_integer(&bytes[56], static_cast<std::uint64_t>(seal.layout.lines_per_chunk), 8);
  put_integer(&bytes[64], seal.offset_table_at, 8);
  put_integer(&bytes[72], seal.stored_table_at, 8);
  put_integer(&bytes[80], seal.tables_hash, 8);
  put_integer(&bytes[88], seal.surroundings_hash, 8);
  put_integer(&bytes[kOwnHashAt], hash_of(std::span(bytes).first(kOwnHashAt)), 8);
  return bytes;
}

Result<Seal> decode_seal(std::span<const std::byte, Seal::kBytes> bytes, const std::string& path) {
  const bool shard = std::memcmp(bytes.data(), kShardMagic.data(), kShardMagic.size()) == 0;
  if (!shard && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0) {
    return Error{
        ErrorCode::bad_file,
        path +
            ": is not a gravure program: make one with `gravure compile`, of a zones job with `gravure zones compile`"};
  }
  if (get_integer(&bytes[kOwnHashAt], 8) != hash_of(bytes.first(kOwnHashAt))) {
    return Error{ErrorCode::bad_file, path + ": the seal (bytes 0..511) is damaged: get a good copy"};
  }
  Seal seal;
  seal.shard = shard;
  seal.format_version = static_cast<std::uint32_t>(get_integer(&bytes[16], 4));
  if (seal.format_version < 1 || seal.format_version > kNewestFormatVersion) {
    return Error{ErrorCode::version_mismatch,
                 path + ": program format version " + std::to_string(seal.format_version) +
                     ", this gravure reads versions 1 to " + std::to_string(kNewestFormatVersion) +
                     ": compile the job again with this gravure, or use the one that made the file"};
  }
  seal.file_bytes = get_integer(&bytes[24], 8);
  seal.layout = {get_signed(&bytes[32]), get_signed(&bytes[40]), get_signed(&bytes[48]), get_signed(&bytes[56])};
  seal.offset_table_at = get_integer(&bytes[64], 8);
  seal.stored_table_at = get_integer(&bytes[72], 8);
  seal.tables_hash = get_integer(&bytes[80], 8);
  seal.surroundings_hash = get_integer(&bytes[88], 8);
  if (const auto checked = check_layout(seal.layout); !checked) {
    return Error{ErrorCode::bad_file, path + ": the seal contradicts itself: " + checked.error().message};
  }
  return seal;
}

std::uint64_t hash_tables(const ChunkTables& tables) {
  const std::unique_ptr<XXH3_state_t, FreeState> state(XXH3_createState());
  XXH3_64bits_reset(state.get());
  for (const auto* table : {&tables.offset_bytes, &tables.stored_bytes}) {
    for (const std::uint64_t value : *table) {
      std::byte bytes[8];
      put_integer(bytes, value, 8);
      XXH3_64bits_update(state.get(), bytes, sizeof bytes);
    }
  }
  return XXH3_64bits_digest(state.get());
}

Result<std::uint64_t> hash_surroundings(const ByteFile& file, const Layout& layout, const ChunkTables& tables,
                                        std::uint64_t file_bytes) {
  RangeHash hash(file);
  std::uint64_t end = Seal::kBytes;
  for (const std::uint32_t i : in_file_order(tables)) {
    const std::uint64_t begin = tables.offset_bytes[i];
    const std::uint64_t bytes = tables.stored_bytes[i];
    if (bytes < 1 || bytes > static_cast<std::uint64_t>(layout.chunk_bytes()) || begin < end || begin > file_bytes ||
        bytes > file_bytes - begin) {
      return bad(file, layout.describe(layout.address_of(i)) + " at byte " + std::to_string(begin) + ", " +
                           std::to_string(bytes) +
                           " bytes: overlaps its neighbour, is longer than a chunk can be, or "
                           "lies outside the file");
    }
    GRAVURE_CHECK(hash.add(end, begin));
    end = begin + bytes;
  }
  GRAVURE_CHECK(hash.add(end, file_bytes));
  return hash.digest();
}

Result<void> write_seal(ByteFile& file, const Layout& layout, const ChunkTables& tables, std::uint64_t offset_table_at,
                        std::uint64_t stored_table_at, bool shard, std::uint32_t format_version) {
  Seal seal;
  seal.shard = shard;
  seal.format_version = format_version;
  seal.layout = layout;
  seal.offset_table_at = offset_table_at;
  seal.stored_table_at = stored_table_at;
  seal.tables_hash = hash_tables(tables);
  GRAVURE_TRY(seal.file_bytes, file.size());
  GRAVURE_TRY(seal.surroundings_hash, hash_surroundings(file, layout, tables, seal.file_bytes));
  // The tables must lie where the seal says, or no reader could use them.
  GRAVURE_CHECK(read_tables(file, seal, seal.file_bytes));
  GRAVURE_CHECK(file.write(0, encode_seal(seal)));
  return file.flush();
}

Result<Sealed> verify_seal(const ByteFile& file, std::int64_t memory_bytes) {
  GRAVURE_TRY(const std::uint64_t size, file.size());
  std::array<std::byte, Seal::kBytes> bytes = {};
  GRAVURE_TRY(const std::size_t got, file.read(0, bytes));
  if (got < bytes.size() && (got < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0)) {
    return bad(file, "only " + std::to_string(size) + " bytes long: not a program, or one cut off in its seal");
  }
  Sealed sealed;
  GRAVURE_TRY(sealed.seal, decode_seal(bytes, file.path()));
  const Seal& seal = sealed.seal;
  GRAVURE_CHECK(check_memory(file, seal.layout, memory_bytes));
  GRAVURE_TRY(sealed.tables, read_tables(file, seal, std::min(size, seal.file_bytes)));
  if (size < seal.file_bytes) {
    return cut_off(file, seal, sealed.tables, size);
  }
  if (size > seal.file_bytes) {
    return bad(file, std::to_string(size - seal.file_bytes) + " bytes too long (from byte " +
                         std::to_string(seal.file_bytes) + " on): get a good copy");
  }
  GRAVURE_TRY(const std::uint64_t hash, hash_surroundings(file, seal.layout, sealed.tables, size));
  if (hash != seal.surroundings_hash) {
    return bad(file,
               "altered outside its chunks (plan, job, tables or HDF5 structure): its checksum does not hold; "
               "get a good copy, or compile the job again");
  }
  return sealed;
}

}  // namespace gravure::grv
