#include "avx512.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <cassert>

namespace gravure::raster::avx512 {
namespace {

/// The bytes from `i` on, at most 64, zeros beyond the end.
GRAVURE_AVX512 inline __m512i load(std::span<const std::byte> bytes, std::size_t i) {
  const std::size_t left = bytes.size() - i;
  const __mmask64 there = left >= 64 ? ~__mmask64{0} : ~(~__mmask64{0} << left);
  return _mm512_maskz_loadu_epi8(there, bytes.data() + i);
}

}  // namespace

GRAVURE_AVX512 std::int64_t popcount(std::span<const std::byte> bits) {
  __m512i sum = _mm512_setzero_si512();
  for (std::size_t i = 0; i < bits.size(); i += 64) {
    sum = _mm512_add_epi64(sum, _mm512_popcnt_epi64(load(bits, i)));
  }
  return _mm512_reduce_add_epi64(sum);
}

GRAVURE_AVX512 std::int64_t count_differences(std::span<const std::byte> a, std::span<const std::byte> b) {
  assert(a.size() == b.size());
  __m512i sum = _mm512_setzero_si512();
  for (std::size_t i = 0; i < a.size(); i += 64) {
    sum = _mm512_add_epi64(sum, _mm512_popcnt_epi64(_mm512_xor_si512(load(a, i), load(b, i))));
  }
  return _mm512_reduce_add_epi64(sum);
}

}  // namespace gravure::raster::avx512

#endif
