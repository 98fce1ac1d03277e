#pragma once

#include <cstddef>
#include <cstdint>

namespace gravure::grv {

/// XXH3-64, as libxxhash gives it, for processors with AVX2.
std::uint64_t hash_avx2(const void* bytes, std::size_t size) noexcept;

}  // namespace gravure::grv
