#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/formats/grv.hpp"

namespace gravure::grv {

using Compression = GrvOptions::Compression;

/// A chunk's bytes as they go into the file; raw where compression saves less than a tenth. Thread-safe.
struct Packed {
  std::vector<std::byte> bytes;
  bool raw = false;
};
Result<Packed> pack(Compression compression, int zstd_level, std::span<const std::byte> chunk);

/// The other way; `out` takes exactly the chunk. Fails with bad_file (message without place) on damaged bytes.
/// Thread-safe.
Result<void> unpack(Compression compression, bool raw, std::span<const std::byte> stored, std::span<std::byte> out);

std::uint64_t hash_of(std::span<const std::byte> bytes) noexcept;  ///< XXH3-64

}  // namespace gravure::grv
