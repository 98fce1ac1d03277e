#include "avx2.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <algorithm>
#include <cstring>

#include "portable.hpp"
#include "slice_frame.hpp"
#include "threshold_frame.hpp"

namespace gravure::raster::avx2 {
namespace {

template <class Sample>
GRAVURE_AVX2 inline __m256i load(const Sample* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

/// 32 bytes of 0 or 0xFF to bits, the first byte to the top bit of the first byte in memory.
GRAVURE_AVX2 inline std::uint32_t to_bits(__m256i lanes) {
  const __m256i backwards =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(7, 6, 5, 4, 3, 2, 1, 0, 15, 14, 13, 12, 11, 10, 9, 8));
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_shuffle_epi8(lanes, backwards)));
}

template <Where kWhere>
GRAVURE_AVX2 inline std::uint32_t cut_32(const std::uint8_t* src, std::uint8_t limit) {
  const __m256i limits = _mm256_set1_epi8(static_cast<char>(limit));
  const __m256i v = load(src);
  return to_bits(
      _mm256_cmpeq_epi8(kWhere == Where::at_least ? _mm256_max_epu8(v, limits) : _mm256_min_epu8(v, limits), v));
}

template <Where kWhere>
GRAVURE_AVX2 inline __m256i cut_16(const std::uint16_t* src, std::uint16_t limit) {
  const __m256i limits = _mm256_set1_epi16(static_cast<short>(limit));
  const __m256i v = load(src);
  return _mm256_cmpeq_epi16(kWhere == Where::at_least ? _mm256_max_epu16(v, limits) : _mm256_min_epu16(v, limits), v);
}

template <Where kWhere>
GRAVURE_AVX2 inline std::uint32_t cut_32(const std::uint16_t* src, std::uint16_t limit) {
  const __m256i packed = _mm256_packs_epi16(cut_16<kWhere>(src, limit), cut_16<kWhere>(src + 16, limit));
  return to_bits(_mm256_permute4x64_epi64(packed, 0xD8));  // packing works inside each half
}

template <Where kWhere>
GRAVURE_AVX2 inline __m256i cut_8(const float* src, float limit) {
  constexpr int kCompare = kWhere == Where::at_least ? _CMP_GE_OQ : _CMP_LE_OQ;
  return _mm256_castps_si256(_mm256_cmp_ps(_mm256_loadu_ps(src), _mm256_set1_ps(limit), kCompare));
}

template <Where kWhere>
GRAVURE_AVX2 inline std::uint32_t cut_32(const float* src, float limit) {
  const __m256i low = _mm256_packs_epi32(cut_8<kWhere>(src, limit), cut_8<kWhere>(src + 8, limit));
  const __m256i high = _mm256_packs_epi32(cut_8<kWhere>(src + 16, limit), cut_8<kWhere>(src + 24, limit));
  const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
  return to_bits(_mm256_permutevar8x32_epi32(_mm256_packs_epi16(low, high), order));
}

/// The row's last samples once more as a full 32, of which only the last `rest` bits are new.
inline void store_rest(std::byte* dst, std::uint32_t bits, int rest) {
  bits = __builtin_bswap32(bits) << (32 - rest);
  for (int i = 0; 8 * i < rest; ++i) {
    dst[i] = static_cast<std::byte>(bits >> (24 - 8 * i));
  }
}

template <Where kWhere, class Sample>
GRAVURE_AVX2 void cut_row(std::byte* dst, const Sample* src, std::int64_t width, Sample limit) {
  if (width < 32) {
    portable::threshold_row(dst, src, width, limit, kWhere);
    return;
  }
  std::int64_t i = 0;
  for (; i + 32 <= width; i += 32, dst += 4) {
    const std::uint32_t bits = cut_32<kWhere>(src + i, limit);
    std::memcpy(dst, &bits, sizeof bits);
  }
  if (i < width) {
    store_rest(dst, cut_32<kWhere>(src + width - 32, limit), static_cast<int>(width - i));
  }
}

/// Sixteen words, in halves of eight, each half backwards.
GRAVURE_AVX2 inline __m256i words_backwards(__m256i words) {
  return _mm256_shuffle_epi8(
      words, _mm256_broadcastsi128_si256(_mm_setr_epi8(14, 15, 12, 13, 10, 11, 8, 9, 6, 7, 4, 5, 2, 3, 0, 1)));
}

/// A piece holds 32 samples as cut() meets them: backwards in groups of eight, so that the sign bits of the packed
/// comparisons are the output bytes at once; and with the top bit flipped, because the comparison is a signed one.
struct SamplesLeaf {
  template <class Sample>
  static void threshold_row(std::byte* dst, const Sample* src, std::int64_t width, Sample limit, Where where) {
    where == Where::at_least ? cut_row<Where::at_least>(dst, src, width, limit)
                             : cut_row<Where::at_most>(dst, src, width, limit);
  }

  GRAVURE_AVX2 static void arrange(std::uint16_t* to, const std::uint16_t* from, __m256i flips) {
    const __m256i low = _mm256_xor_si256(load(from), flips);
    const __m256i high = _mm256_xor_si256(load(from + 16), flips);
    auto* out = reinterpret_cast<__m256i*>(to);
    _mm256_store_si256(out, words_backwards(_mm256_permute2x128_si256(low, high, 0x20)));
    _mm256_store_si256(out + 1, words_backwards(_mm256_permute2x128_si256(low, high, 0x31)));
  }

  GRAVURE_AVX2 static void arrange(std::uint8_t* to, const std::uint8_t* from, __m256i flips) {
    const __m256i backwards =
        _mm256_broadcastsi128_si256(_mm_setr_epi8(7, 6, 5, 4, 3, 2, 1, 0, 15, 14, 13, 12, 11, 10, 9, 8));
    const __m256i bytes = _mm256_xor_si256(load(from), flips);
    _mm256_store_si256(reinterpret_cast<__m256i*>(to), _mm256_shuffle_epi8(bytes, backwards));
  }

  GRAVURE_AVX2 static std::uint32_t cut_arranged(const std::uint16_t* from, std::uint16_t below) {
    const __m256i limits = _mm256_set1_epi16(static_cast<short>(below));
    const __m256i low = _mm256_cmpgt_epi16(load(from), limits);
    const __m256i high = _mm256_cmpgt_epi16(load(from + 16), limits);
    return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_packs_epi16(low, high)));
  }

  GRAVURE_AVX2 static std::uint32_t cut_arranged(const std::uint8_t* from, std::uint8_t below) {
    const __m256i limits = _mm256_set1_epi8(static_cast<char>(below));
    return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpgt_epi8(load(from), limits)));
  }

  template <class Sample>
  static constexpr Sample top() {
    return static_cast<Sample>(1u << (8 * sizeof(Sample) - 1));
  }

  /// Whole vectors, then one that ends with the piece; a short piece sample by sample.
  template <class Sample>
  GRAVURE_AVX2 static void find_extremes(detail::Piece<Sample>& piece, const Sample* src, Sample flip) {
    constexpr std::int64_t kLanes = 32 / sizeof(Sample);
    Sample least = 0;
    Sample greatest = 0;
    if (piece.size >= kLanes) {
      __m256i lows = load(src + piece.size - kLanes);
      __m256i highs = lows;
      for (std::int64_t i = 0; i + kLanes <= piece.size; i += kLanes) {
        const __m256i v = load(src + i);
        lows = sizeof(Sample) == 1 ? _mm256_min_epu8(lows, v) : _mm256_min_epu16(lows, v);
        highs = sizeof(Sample) == 1 ? _mm256_max_epu8(highs, v) : _mm256_max_epu16(highs, v);
      }
      alignas(32) Sample lanes[2 * kLanes];
      _mm256_store_si256(reinterpret_cast<__m256i*>(lanes), lows);
      _mm256_store_si256(reinterpret_cast<__m256i*>(lanes + kLanes), highs);
      least = *std::min_element(lanes, lanes + kLanes);
      greatest = *std::max_element(lanes + kLanes, lanes + 2 * kLanes);
    } else {
      least = *std::min_element(src, src + piece.size);
      greatest = *std::max_element(src, src + piece.size);
    }
    piece.least = flip == 0 ? least : static_cast<Sample>(greatest ^ flip);
    piece.greatest = flip == 0 ? greatest : static_cast<Sample>(least ^ flip);
  }

  template <class Sample>
  GRAVURE_AVX2 static void prepare(detail::Piece<Sample>& piece, const Sample* src, Sample flip) {
    const auto flips = static_cast<Sample>(flip ^ top<Sample>());
    const __m256i wide =
        sizeof(Sample) == 1 ? _mm256_set1_epi8(static_cast<char>(flips)) : _mm256_set1_epi16(static_cast<short>(flips));
    Sample* to = piece.samples.data();
    std::int64_t i = 0;
    for (; i + 32 <= piece.size; i += 32) {
      arrange(to + i, src + i, wide);
    }
    if (i < piece.size) {
      // Samples that are not there compare as 0, which no limit of a cut lies at or below.
      alignas(32) Sample rest[32];
      std::fill(rest, rest + 32, flip);
      std::memcpy(rest, src + i, static_cast<std::size_t>(piece.size - i) * sizeof(Sample));
      arrange(to + i, rest, wide);
    }
    find_extremes(piece, src, flip);
  }

  template <class Sample>
  GRAVURE_AVX2 static void cut(std::byte* dst, const detail::Piece<Sample>& piece, Sample limit) {
    const auto below = static_cast<Sample>(static_cast<Sample>(limit - 1) ^ top<Sample>());
    const Sample* from = piece.samples.data();
    std::int64_t i = 0;
    for (; i + 64 <= piece.size; i += 64, dst += 8) {
      const std::uint64_t bits = cut_arranged(from + i, below) | std::uint64_t{cut_arranged(from + i + 32, below)}
                                                                     << 32;
      std::memcpy(dst, &bits, sizeof bits);
    }
    for (; i < piece.size; i += 32) {
      std::uint32_t bits = cut_arranged(from + i, below);
      for (std::int64_t k = i; k < piece.size && k < i + 32; k += 8, bits >>= 8) {
        *dst++ = static_cast<std::byte>(bits);
      }
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

}  // namespace gravure::raster::avx2

#endif
