#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "gravure/core/error.hpp"
#include "gravure/core/program.hpp"

namespace gravure::grv {

inline constexpr std::int64_t kMaxChunkBytes = std::int64_t{1} << 30;
inline constexpr std::int64_t kMaxChunks = std::int64_t{1} << 28;

/// How the lines of a program are cut into chunks. A chunk holds whole lines of one layer; the last chunk of a layer
/// may hold fewer, and is filled up with dark lines in the file because HDF5 stores chunks of one size only.
struct Layout {
  std::int64_t layers = 0;
  std::int64_t lines_per_layer = 0;
  std::int64_t line_bytes = 0;
  std::int64_t lines_per_chunk = 0;

  std::int64_t chunks_per_layer() const { return (lines_per_layer + lines_per_chunk - 1) / lines_per_chunk; }
  std::int64_t chunks() const { return layers * chunks_per_layer(); }
  std::int64_t chunk_bytes() const { return lines_per_chunk * line_bytes; }
  std::int64_t first_line(std::int64_t chunk) const { return chunk * lines_per_chunk; }
  /// Lines that a chunk of a layer really holds.
  std::int64_t lines_in(std::int64_t chunk) const;
  bool contains(ChunkAddress address) const;
  /// Position in the chunk tables.
  std::size_t index_of(ChunkAddress address) const;
  ChunkAddress address_of(std::size_t index) const;
  /// "layer 3, chunk 2 (lines 80..119)"
  std::string describe(ChunkAddress address) const;
};

/// Every number at least 1, chunks at most kMaxChunkBytes, at most kMaxChunks of them; else out_of_range.
Result<void> check_layout(const Layout& layout);

/// Chunks of about `target_bytes`, at least one line each, as equal in length as can be.
Result<Layout> make_layout(std::int64_t layers, std::int64_t lines_per_layer, std::int64_t line_bytes,
                           std::int64_t target_bytes);

}  // namespace gravure::grv
