#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "byte_file.hpp"
#include "gravure/core/error.hpp"
#include "layout.hpp"

namespace gravure::grv {

/// The first 512 bytes of a program file, an HDF5 user block: what is needed to verify every byte of the file before
/// the HDF5 library interprets any of it. docs/formats/grv.md has the table of fields.
struct Seal {
  static constexpr std::size_t kBytes = 512;
  std::uint32_t format_version = 0;
  std::uint64_t file_bytes = 0;
  Layout layout;
  std::uint64_t offset_table_at = 0;    ///< file offset of /layers/offset_bytes
  std::uint64_t stored_table_at = 0;    ///< file offset of /layers/stored_bytes
  std::uint64_t tables_hash = 0;        ///< XXH3-64 of the two tables, one after the other
  std::uint64_t surroundings_hash = 0;  ///< XXH3-64 of every byte after the seal that is in no chunk
  bool shard = false;                   ///< a part of a job: another name in front
};

/// Where each chunk lies in the file; tables in layer-major order.
struct ChunkTables {
  std::vector<std::uint64_t> offset_bytes;
  std::vector<std::uint64_t> stored_bytes;
};

std::array<std::byte, Seal::kBytes> encode_seal(const Seal& seal);

/// Fails with bad_file for other files and damaged seals, version_mismatch for other format versions.
Result<Seal> decode_seal(std::span<const std::byte, Seal::kBytes> bytes, const std::string& path);

std::uint64_t hash_tables(const ChunkTables& tables);

/// XXH3-64 of everything behind the seal and outside the chunks, up to `file_bytes`. bad_file, naming the chunk, where
/// chunks overlap or lie outside.
Result<std::uint64_t> hash_surroundings(const ByteFile& file, const Layout& layout, const ChunkTables& tables,
                                        std::uint64_t file_bytes);

/// Completes a written file: computes both hashes over what is on disk and writes the seal in front; nothing is kept
/// back.
Result<void> write_seal(ByteFile& file, const Layout& layout, const ChunkTables& tables, std::uint64_t offset_table_at,
                        std::uint64_t stored_table_at, bool shard = false, std::uint32_t format_version = 1);

struct Sealed {
  Seal seal;
  ChunkTables tables;
};
/// What is held of each chunk of an open program: its place, its length, its checksum and how many pixels fire.
inline constexpr std::int64_t kTableBytesPerChunk = 4 * sizeof(std::uint64_t);
/// Verifies everything but the chunks. out_of_range, before they are read, where all tables would take more than
/// `memory_bytes`.
Result<Sealed> verify_seal(const ByteFile& file, std::int64_t memory_bytes = std::numeric_limits<std::int64_t>::max());

}  // namespace gravure::grv
