#include "avx2.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <cassert>

#include "portable.hpp"

namespace gravure::raster::avx2 {
namespace {

/// Ones of the four 64-bit words: nibbles by table, then sums over eight bytes.
GRAVURE_AVX2 inline __m256i ones(__m256i bits) {
  const __m256i nibble = _mm256_set1_epi8(0x0F);
  const __m256i table = _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
  const __m256i low = _mm256_shuffle_epi8(table, _mm256_and_si256(bits, nibble));
  const __m256i high = _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi16(bits, 4), nibble));
  return _mm256_sad_epu8(_mm256_add_epi8(low, high), _mm256_setzero_si256());
}

GRAVURE_AVX2 inline std::int64_t sum_of(__m256i words) {
  const __m128i two = _mm_add_epi64(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1));
  return _mm_cvtsi128_si64(two) + _mm_extract_epi64(two, 1);
}

}  // namespace

GRAVURE_AVX2 std::int64_t popcount(std::span<const std::byte> bits) {
  __m256i even = _mm256_setzero_si256();
  __m256i odd = _mm256_setzero_si256();
  std::size_t i = 0;
  for (; i + 64 <= bits.size(); i += 64) {
    even = _mm256_add_epi64(even, ones(load(bits.data() + i)));
    odd = _mm256_add_epi64(odd, ones(load(bits.data() + i + 32)));
  }
  return sum_of(_mm256_add_epi64(even, odd)) + portable::popcount(bits.subspan(i));
}

GRAVURE_AVX2 std::int64_t count_differences(std::span<const std::byte> a, std::span<const std::byte> b) {
  assert(a.size() == b.size());
  __m256i sum = _mm256_setzero_si256();
  std::size_t i = 0;
  for (; i + 32 <= a.size(); i += 32) {
    sum = _mm256_add_epi64(sum, ones(_mm256_xor_si256(load(a.data() + i), load(b.data() + i))));
  }
  return sum_of(sum) + portable::count_differences(a.subspan(i), b.subspan(i));
}

GRAVURE_AVX2 std::int64_t first_difference(std::span<const std::byte> a, std::span<const std::byte> b) {
  assert(a.size() == b.size());
  std::size_t i = 0;
  for (; i + 64 <= a.size(); i += 64) {
    const __m256i low = _mm256_xor_si256(load(a.data() + i), load(b.data() + i));
    const __m256i high = _mm256_xor_si256(load(a.data() + i + 32), load(b.data() + i + 32));
    const __m256i any = _mm256_or_si256(low, high);
    if (_mm256_testz_si256(any, any) == 0) {
      break;
    }
  }
  const std::int64_t rest = portable::first_difference(a.subspan(i), b.subspan(i));
  return rest < 0 ? rest : static_cast<std::int64_t>(8 * i) + rest;
}

}  // namespace gravure::raster::avx2

#endif
