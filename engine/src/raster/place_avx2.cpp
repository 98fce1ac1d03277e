#include "avx2.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <cstring>

#include "place_frame.hpp"
#include "portable.hpp"

namespace gravure::raster::avx2 {
namespace {

GRAVURE_AVX2 inline void store(std::byte* to, __m256i bytes) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), bytes);
}

/// 256 bits from a bit that is not the first of its byte: two overlapping loads, shifted against each other. The
/// shifts work on 16 bits, so the masks take out what came over from the other byte of the pair.
struct Shift {
  __m128i left;
  __m128i right;
  __m256i keep_left;
  __m256i keep_right;

  GRAVURE_AVX2 explicit Shift(int phase)
      : left(_mm_cvtsi32_si128(phase)),
        right(_mm_cvtsi32_si128(8 - phase)),
        keep_left(_mm256_set1_epi8(static_cast<char>(0xFF << phase))),
        keep_right(_mm256_set1_epi8(static_cast<char>(0xFF >> (8 - phase)))) {}

  GRAVURE_AVX2 __m256i window(const std::byte* at) const {
    const __m256i high = _mm256_and_si256(_mm256_sll_epi16(load(at), left), keep_left);
    const __m256i low = _mm256_and_si256(_mm256_srl_epi16(load(at + 1), right), keep_right);
    return _mm256_or_si256(high, low);
  }
};

/// All 256 bits in reverse: nibbles by two tables, bytes inside the halves, then the halves.
GRAVURE_AVX2 inline __m256i reverse(__m256i bits) {
  const __m256i nibble = _mm256_set1_epi8(0x0F);
  const __m256i to_high = _mm256_broadcastsi128_si256(_mm_setr_epi8(
      0x00, -0x80, 0x40, -0x40, 0x20, -0x60, 0x60, -0x20, 0x10, -0x70, 0x50, -0x30, 0x30, -0x50, 0x70, -0x10));
  const __m256i to_low =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15));
  const __m256i backwards =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0));
  const __m256i high = _mm256_shuffle_epi8(to_high, _mm256_and_si256(bits, nibble));
  const __m256i low = _mm256_shuffle_epi8(to_low, _mm256_and_si256(_mm256_srli_epi16(bits, 4), nibble));
  const __m256i halves = _mm256_shuffle_epi8(_mm256_or_si256(high, low), backwards);
  return _mm256_permute4x64_epi64(halves, 0x4E);
}

struct Aligned {
  GRAVURE_AVX2 __m256i window(const std::byte* at) const { return load(at); }
};

template <bool kMirror, class Source>
GRAVURE_AVX2 inline void step(std::byte* dst, const std::byte* at, const Source& source, __m256i flips) {
  const __m256i bits = source.window(at);
  store(dst, _mm256_xor_si256(kMirror ? reverse(bits) : bits, flips));
}

/// 32 bytes or more. The last step may overlap the one before: writing the same bytes twice is cheaper than a tail.
template <bool kMirror, class Source>
GRAVURE_AVX2 void fill(std::byte* dst, std::int64_t bytes, const std::byte* at, const Source& source, __m256i flips) {
  constexpr int kWay = kMirror ? -1 : 1;
  std::int64_t i = 0;
  for (; i + 32 <= bytes; i += 32) {
    step<kMirror>(dst + i, at + kWay * i, source, flips);
  }
  if (i < bytes) {
    step<kMirror>(dst + bytes - 32, at + kWay * (bytes - 32), source, flips);
  }
}

template <bool kMirror>
GRAVURE_AVX2 inline void fill_from(std::byte* dst, std::int64_t bytes, const std::byte* at, int phase, unsigned flip) {
  const __m256i flips = _mm256_set1_epi8(static_cast<char>(flip));
  if (phase == 0) {
    fill<kMirror>(dst, bytes, at, Aligned{}, flips);
  } else {
    fill<kMirror>(dst, bytes, at, Shift(phase), flips);
  }
}

struct PlaceLeaf {
  GRAVURE_AVX2 static void copy_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t first,
                                     unsigned flip) {
    if (bytes < 32) {
      portable::copy_bits(dst, bytes, src, first, flip);
    } else {
      fill_from<false>(dst, bytes, src + (first >> 3), static_cast<int>(first & 7), flip);
    }
  }

  GRAVURE_AVX2 static void mirror_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t end,
                                       unsigned flip) {
    if (bytes < 32) {
      portable::mirror_bits(dst, bytes, src, end, flip);
    } else {
      fill_from<true>(dst, bytes, src + (end >> 3) - 32, static_cast<int>(end & 7), flip);
    }
  }
};

}  // namespace

void place_line(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t src_bit,
                std::int64_t width, PlaceOptions options) {
  detail::place_line_with<PlaceLeaf>(dst, dst_bit, src, src_bit, width, options);
}

void place_rows(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                RowOptions options) {
  detail::place_rows_with<PlaceLeaf>(dst, src, width, rows, options);
}

}  // namespace gravure::raster::avx2

#endif
