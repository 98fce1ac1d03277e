// Compiled for AVX2 as a whole: Debian's libxxhash is for any x86-64, and half as fast. Nothing else may come in here
// whose inline functions other files share.
#define XXH_INLINE_ALL
#include "hash_avx2.hpp"

#include <xxhash.h>

static_assert(XXH_VECTOR == XXH_AVX2);

std::uint64_t gravure::grv::hash_avx2(const void* bytes, std::size_t size) noexcept {
  return XXH3_64bits(bytes, size);
}
