#include "avx512.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <algorithm>
#include <cstring>

#include "slice_frame.hpp"
#include "threshold_frame.hpp"
#include "words.hpp"

namespace gravure::raster::avx512 {
namespace {

constexpr __mmask64 first_lanes(std::int64_t count) {
  return count >= 64 ? ~__mmask64{0} : ~(~__mmask64{0} << count);
}

/// Bytes or words, backwards in groups of eight: the first sample of eight belongs to the top bit of its byte.
GRAVURE_AVX512 inline __m512i backwards(std::uint8_t, __m512i v) {
  return _mm512_shuffle_epi8(
      v, _mm512_broadcast_i32x4(_mm_setr_epi8(7, 6, 5, 4, 3, 2, 1, 0, 15, 14, 13, 12, 11, 10, 9, 8)));
}
GRAVURE_AVX512 inline __m512i backwards(std::uint16_t, __m512i v) {
  return _mm512_shuffle_epi8(
      v, _mm512_broadcast_i32x4(_mm_setr_epi8(14, 15, 12, 13, 10, 11, 8, 9, 6, 7, 4, 5, 2, 3, 0, 1)));
}

GRAVURE_AVX512 inline __m512i load(std::uint8_t, const void* from, __mmask64 lanes) {
  return _mm512_maskz_loadu_epi8(lanes, from);
}
GRAVURE_AVX512 inline __m512i load(std::uint16_t, const void* from, __mmask64 lanes) {
  return _mm512_maskz_loadu_epi16(static_cast<__mmask32>(lanes), from);
}

template <Where kWhere>
GRAVURE_AVX512 inline __mmask64 compare(__m512i v, std::uint8_t limit) {
  const __m512i limits = _mm512_set1_epi8(static_cast<char>(limit));
  return kWhere == Where::at_least ? _mm512_cmpge_epu8_mask(v, limits) : _mm512_cmple_epu8_mask(v, limits);
}
template <Where kWhere>
GRAVURE_AVX512 inline __mmask32 compare(__m512i v, std::uint16_t limit) {
  const __m512i limits = _mm512_set1_epi16(static_cast<short>(limit));
  return kWhere == Where::at_least ? _mm512_cmpge_epu16_mask(v, limits) : _mm512_cmple_epu16_mask(v, limits);
}

/// 64 samples to eight bytes in memory order; samples beyond `count` are not read, their bits mean nothing.
template <Where kWhere>
GRAVURE_AVX512 inline std::uint64_t cut_64(const std::uint8_t* src, std::int64_t count, std::uint8_t limit) {
  return compare<kWhere>(backwards(limit, load(limit, src, first_lanes(count))), limit);
}

template <Where kWhere>
GRAVURE_AVX512 inline std::uint64_t cut_64(const std::uint16_t* src, std::int64_t count, std::uint16_t limit) {
  const __mmask64 lanes = first_lanes(count);
  const auto low = compare<kWhere>(backwards(limit, load(limit, src, lanes)), limit);
  const auto high = compare<kWhere>(backwards(limit, load(limit, src + 32, lanes >> 32)), limit);
  return low | std::uint64_t{high} << 32;
}

template <Where kWhere>
GRAVURE_AVX512 inline std::uint64_t cut_16(const float* src, __mmask64 lanes, float limit) {
  constexpr int kCompare = kWhere == Where::at_least ? _CMP_GE_OQ : _CMP_LE_OQ;
  const __m512 v = _mm512_maskz_loadu_ps(static_cast<__mmask16>(lanes), src);
  return _mm512_cmp_ps_mask(v, _mm512_set1_ps(limit), kCompare);
}

template <Where kWhere>
GRAVURE_AVX512 inline std::uint64_t cut_64(const float* src, std::int64_t count, float limit) {
  const __mmask64 lanes = first_lanes(count);
  const std::uint64_t bits = cut_16<kWhere>(src, lanes, limit) | cut_16<kWhere>(src + 16, lanes >> 16, limit) << 16 |
                             cut_16<kWhere>(src + 32, lanes >> 32, limit) << 32 |
                             cut_16<kWhere>(src + 48, lanes >> 48, limit) << 48;
  return detail::reverse_in_bytes(bits);
}

/// The bytes of the first `count` (1 .. 64) bits, the unused bits of the last one cleared.
inline void store_bits(std::byte* dst, std::uint64_t bits, std::int64_t count) {
  const std::int64_t bytes = packed_bytes(count);
  std::memcpy(dst, &bits, static_cast<std::size_t>(bytes));
  if (const int rest = static_cast<int>(count & 7); rest != 0) {
    dst[bytes - 1] &= static_cast<std::byte>(detail::top_bits(rest));
  }
}

template <Where kWhere, class Sample>
GRAVURE_AVX512 void cut_row(std::byte* dst, const Sample* src, std::int64_t width, Sample limit) {
  std::int64_t i = 0;
  for (; i + 64 <= width; i += 64, dst += 8) {
    const std::uint64_t bits = cut_64<kWhere>(src + i, 64, limit);
    std::memcpy(dst, &bits, sizeof bits);
  }
  if (i < width) {
    store_bits(dst, cut_64<kWhere>(src + i, width - i, limit), width - i);
  }
}

/// A piece holds its samples backwards in groups of eight, so that a comparison is a word of output.
struct SamplesLeaf {
  template <class Sample>
  static void threshold_row(std::byte* dst, const Sample* src, std::int64_t width, Sample limit, Where where) {
    where == Where::at_least ? cut_row<Where::at_least>(dst, src, width, limit)
                             : cut_row<Where::at_most>(dst, src, width, limit);
  }

  GRAVURE_AVX512 static __m512i min(std::uint8_t, __m512i a, __m512i b) { return _mm512_min_epu8(a, b); }
  GRAVURE_AVX512 static __m512i min(std::uint16_t, __m512i a, __m512i b) { return _mm512_min_epu16(a, b); }
  GRAVURE_AVX512 static __m512i max(std::uint8_t, __m512i a, __m512i b) { return _mm512_max_epu8(a, b); }
  GRAVURE_AVX512 static __m512i max(std::uint16_t, __m512i a, __m512i b) { return _mm512_max_epu16(a, b); }
  GRAVURE_AVX512 static __m512i all(std::uint8_t v) { return _mm512_set1_epi8(static_cast<char>(v)); }
  GRAVURE_AVX512 static __m512i all(std::uint16_t v) { return _mm512_set1_epi16(static_cast<short>(v)); }
  GRAVURE_AVX512 static __m512i blend(std::uint8_t, __mmask64 lanes, __m512i a, __m512i b) {
    return _mm512_mask_blend_epi8(lanes, a, b);
  }
  GRAVURE_AVX512 static __m512i blend(std::uint16_t, __mmask64 lanes, __m512i a, __m512i b) {
    return _mm512_mask_blend_epi16(static_cast<__mmask32>(lanes), a, b);
  }

  template <class Sample>
  GRAVURE_AVX512 static void prepare(detail::Piece<Sample>& piece, const Sample* src, Sample flip) {
    constexpr std::int64_t kLanes = 64 / sizeof(Sample);
    const __m512i flips = all(flip);
    __m512i least = all(static_cast<Sample>(~Sample{0}));
    __m512i greatest = _mm512_setzero_si512();
    for (std::int64_t i = 0; i < piece.size; i += kLanes) {
      const __mmask64 there = first_lanes(std::min(kLanes, piece.size - i));
      const __m512i v = _mm512_xor_si512(load(flip, src + i, there), flips);
      least = min(flip, least, blend(flip, there, least, v));
      greatest = max(flip, greatest, blend(flip, there, greatest, v));
      _mm512_store_si512(piece.samples.data() + i, backwards(flip, v));
    }
    alignas(64) Sample lanes[2 * kLanes];
    _mm512_store_si512(lanes, least);
    _mm512_store_si512(lanes + kLanes, greatest);
    piece.least = *std::min_element(lanes, lanes + kLanes);
    piece.greatest = *std::max_element(lanes + kLanes, lanes + 2 * kLanes);
  }

  GRAVURE_AVX512 static std::uint64_t cut_arranged(const std::uint8_t* from, std::uint8_t limit) {
    return compare<Where::at_least>(_mm512_load_si512(from), limit);
  }
  GRAVURE_AVX512 static std::uint64_t cut_arranged(const std::uint16_t* from, std::uint16_t limit) {
    const auto low = compare<Where::at_least>(_mm512_load_si512(from), limit);
    const auto high = compare<Where::at_least>(_mm512_load_si512(from + 32), limit);
    return _mm512_kunpackd(high, low);
  }

  template <class Sample>
  GRAVURE_AVX512 static void cut(std::byte* dst, const detail::Piece<Sample>& piece, Sample limit) {
    const Sample* from = piece.samples.data();
    std::int64_t i = 0;
    for (; i + 64 <= piece.size; i += 64, dst += 8) {
      const std::uint64_t bits = cut_arranged(from + i, limit);
      std::memcpy(dst, &bits, sizeof bits);
    }
    if (i < piece.size) {
      store_bits(dst, cut_arranged(from + i, limit), piece.size - i);
    }
  }
};

}  // namespace

void threshold_u8(std::span<std::byte> dst, std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows,
                  std::uint8_t limit, Where where) {
  detail::threshold_rows_with<SamplesLeaf>(dst, src, width, rows, limit, where);
}

void threshold_u16(std::span<std::byte> dst, std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows,
                   std::uint16_t limit, Where where) {
  detail::threshold_rows_with<SamplesLeaf>(dst, src, width, rows, limit, where);
}

void threshold_f32(std::span<std::byte> dst, std::span<const float> src, std::int64_t width, std::int64_t rows,
                   float limit, Where where) {
  detail::threshold_rows_with<SamplesLeaf>(dst, src, width, rows, limit, where);
}

void slice_u8(std::span<const std::span<std::byte>> layers, std::int64_t first_level, std::span<const std::uint8_t> src,
              std::int64_t width, std::int64_t rows, const SliceRange& range) {
  detail::slice_with<SamplesLeaf>(layers, first_level, src, width, rows, range);
}

void slice_u16(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
               std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows, const SliceRange& range) {
  detail::slice_with<SamplesLeaf>(layers, first_level, src, width, rows, range);
}

}  // namespace gravure::raster::avx512

#endif
