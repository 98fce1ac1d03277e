#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "codec.hpp"
#include "gravure/core/error.hpp"

namespace gravure::grv {

/// Rows of 64-bit numbers that change smoothly from row to row, a chunk of them: each column is differenced three times
/// from 0 at the begin of the chunk (wrapping, so that nothing is lost), then, unless nothing compresses it, the bytes
/// of equal weight are laid together as HDF5's shuffle filter does, then it is packed. `values` are whole rows of
/// `columns`.
Result<Packed> pack_columns(Compression compression, int zstd_level, std::size_t columns,
                            std::span<const std::int64_t> values);

/// The other way; `out` takes exactly the chunk. Fails with bad_file (message without place) on damaged bytes.
Result<void> unpack_columns(Compression compression, bool raw, std::size_t columns, std::span<const std::byte> stored,
                            std::span<std::int64_t> out);

}  // namespace gravure::grv
