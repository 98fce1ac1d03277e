#include "avx2.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <memory>

#include "gravure/raster/place.hpp"
#include "portable.hpp"

namespace gravure::raster::avx2 {

namespace {

/// A block is 256 x 256 bits: four by four tiles of 64 x 64. A vector holds one row of four tiles side by side.
constexpr std::int64_t kBlock = 256;
constexpr std::int64_t kBlockBytes = kBlock / 8;

GRAVURE_AVX2 inline __m256i load(const std::byte* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

/// Exchanges bit squares of `kStep` (4, 2, 1) between two rows: bits of a at kStep and above with those of b below.
template <int kStep>
GRAVURE_AVX2 inline void exchange_bits(__m256i& a, __m256i& b, __m256i below) {
  const __m256i swap = _mm256_and_si256(_mm256_xor_si256(_mm256_srli_epi64(a, kStep), b), below);
  b = _mm256_xor_si256(b, swap);
  a = _mm256_xor_si256(a, _mm256_slli_epi64(swap, kStep));
}

/// The same for 4, 2 and 1 bytes, where shifts of whole lanes and blends do.
GRAVURE_AVX2 inline void exchange_4_bytes(__m256i& a, __m256i& b) {
  const __m256i low = _mm256_blend_epi32(a, _mm256_slli_epi64(b, 32), 0xAA);
  b = _mm256_blend_epi32(_mm256_srli_epi64(a, 32), b, 0xAA);
  a = low;
}

GRAVURE_AVX2 inline void exchange_2_bytes(__m256i& a, __m256i& b) {
  const __m256i low = _mm256_blend_epi16(a, _mm256_slli_epi32(b, 16), 0xAA);
  b = _mm256_blend_epi16(_mm256_srli_epi32(a, 16), b, 0xAA);
  a = low;
}

GRAVURE_AVX2 inline void exchange_bytes(__m256i& a, __m256i& b) {
  const __m256i odd = _mm256_set1_epi16(static_cast<short>(0xFF00));
  const __m256i low = _mm256_or_si256(_mm256_andnot_si256(odd, a), _mm256_slli_epi16(b, 8));
  b = _mm256_or_si256(_mm256_srli_epi16(a, 8), _mm256_and_si256(b, odd));
  a = low;
}

struct Eight {
  __m256i r0, r1, r2, r3, r4, r5, r6, r7;
};

GRAVURE_AVX2 inline void store(__m256i* to, const Eight& v) {
  _mm256_store_si256(to, v.r0);
  _mm256_store_si256(to + 1, v.r1);
  _mm256_store_si256(to + 2, v.r2);
  _mm256_store_si256(to + 3, v.r3);
  _mm256_store_si256(to + 4, v.r4);
  _mm256_store_si256(to + 5, v.r5);
  _mm256_store_si256(to + 6, v.r6);
  _mm256_store_si256(to + 7, v.r7);
}

/// Eight rows of bits: inside each byte column, 8 x 8 bits are transposed. Row 0 of the stream goes to the top bit, so
/// the rows are taken from the last to the first.
GRAVURE_AVX2 inline void transpose_bits(__m256i* to, const std::byte* from, std::int64_t stride) {
  const std::byte* half = from + 4 * stride;
  Eight v{load(half + 3 * stride), load(half + 2 * stride), load(half + stride), load(half),
          load(from + 3 * stride), load(from + 2 * stride), load(from + stride), load(from)};
  const __m256i below_4 = _mm256_set1_epi8(0x0F);
  exchange_bits<4>(v.r0, v.r4, below_4);
  exchange_bits<4>(v.r1, v.r5, below_4);
  exchange_bits<4>(v.r2, v.r6, below_4);
  exchange_bits<4>(v.r3, v.r7, below_4);
  const __m256i below_2 = _mm256_set1_epi8(0x33);
  exchange_bits<2>(v.r0, v.r2, below_2);
  exchange_bits<2>(v.r1, v.r3, below_2);
  exchange_bits<2>(v.r4, v.r6, below_2);
  exchange_bits<2>(v.r5, v.r7, below_2);
  const __m256i below_1 = _mm256_set1_epi8(0x55);
  exchange_bits<1>(v.r0, v.r1, below_1);
  exchange_bits<1>(v.r2, v.r3, below_1);
  exchange_bits<1>(v.r4, v.r5, below_1);
  exchange_bits<1>(v.r6, v.r7, below_1);
  store(to, v);
}

/// Eight vectors, eight apart: inside each word, 8 x 8 bytes are transposed.
GRAVURE_AVX2 inline void transpose_bytes(__m256i* to, const __m256i* from) {
  Eight v{from[0], from[8], from[16], from[24], from[32], from[40], from[48], from[56]};
  exchange_4_bytes(v.r0, v.r4);
  exchange_4_bytes(v.r1, v.r5);
  exchange_4_bytes(v.r2, v.r6);
  exchange_4_bytes(v.r3, v.r7);
  exchange_2_bytes(v.r0, v.r2);
  exchange_2_bytes(v.r1, v.r3);
  exchange_2_bytes(v.r4, v.r6);
  exchange_2_bytes(v.r5, v.r7);
  exchange_bytes(v.r0, v.r1);
  exchange_bytes(v.r2, v.r3);
  exchange_bytes(v.r4, v.r5);
  exchange_bytes(v.r6, v.r7);
  store(to, v);
}

/// Four vectors, eight apart, of four words each: 4 x 4 words are transposed and go to output rows 64 apart.
GRAVURE_AVX2 inline void transpose_words(std::byte* to, std::int64_t stride, const __m256i* from) {
  const __m256i a = _mm256_unpacklo_epi64(from[0], from[8]);
  const __m256i b = _mm256_unpackhi_epi64(from[0], from[8]);
  const __m256i c = _mm256_unpacklo_epi64(from[16], from[24]);
  const __m256i d = _mm256_unpackhi_epi64(from[16], from[24]);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permute2x128_si256(a, c, 0x20));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + 64 * stride), _mm256_permute2x128_si256(b, d, 0x20));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + 128 * stride), _mm256_permute2x128_si256(a, c, 0x31));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + 192 * stride), _mm256_permute2x128_si256(b, d, 0x31));
}

/// One whole block. `next` is the one that comes after it: fetched meanwhile, since rows are too far apart for the
/// processor to see that they are read in turn (measured: a quarter faster). Only the ends of its rows are asked for:
/// where a row lies in two cache lines, the first one came with the block to its left.
GRAVURE_AVX2 void transpose_block(std::byte* dst, std::int64_t dst_stride, const std::byte* src,
                                  std::int64_t src_stride, const std::byte* next) {
  alignas(64) __m256i by_bits[kBlock];
  for (std::int64_t group = 0; group < 32; ++group) {
    for (std::int64_t row = 8 * group; row < 8 * (group + 1); ++row) {
      _mm_prefetch(reinterpret_cast<const char*>(next + row * src_stride + kBlockBytes - 1), _MM_HINT_T0);
    }
    transpose_bits(by_bits + 8 * group, src + 8 * group * src_stride, src_stride);
  }
  alignas(64) __m256i by_bytes[32];
  for (std::int64_t bit = 0; bit < 8; ++bit) {
    for (std::int64_t tile = 0; tile < 4; ++tile) {
      transpose_bytes(by_bytes + 8 * tile, by_bits + 64 * tile + bit);
    }
    for (std::int64_t byte = 0; byte < 8; ++byte) {
      transpose_words(dst + (8 * byte + 7 - bit) * dst_stride, dst_stride, by_bytes + byte);
    }
  }
}

/// A block whose matrix ends inside: by way of a copy with zeros where it has ended.
void transpose_part(std::byte* dst, std::int64_t dst_stride, const std::byte* src, std::int64_t src_stride,
                    std::int64_t rows, std::int64_t cols) {
  alignas(64) std::array<std::byte, kBlock * kBlockBytes> whole;
  whole.fill(std::byte{0});
  for (std::int64_t row = 0; row < rows; ++row) {
    std::memcpy(whole.data() + row * kBlockBytes, src + row * src_stride, static_cast<std::size_t>(packed_bytes(cols)));
  }
  transpose_block(dst, dst_stride, whole.data(), kBlockBytes, whole.data());
}

/// Copies past the caches where whole lines are written: an output row is met again only many megabytes later, and
/// ordinary stores would read each line before they write it.
GRAVURE_AVX2 void copy_past_caches(std::byte* to, const std::byte* from, std::int64_t bytes) {
  const auto to_line = static_cast<std::int64_t>(-reinterpret_cast<std::uintptr_t>(to) & 63);
  std::int64_t i = std::min(to_line, bytes);
  std::memcpy(to, from, static_cast<std::size_t>(i));
  for (; i + 64 <= bytes; i += 64) {
    const __m256i low = load(from + i);
    const __m256i high = load(from + i + 32);
    _mm256_stream_si256(reinterpret_cast<__m256i*>(to + i), low);
    _mm256_stream_si256(reinterpret_cast<__m256i*>(to + i + 32), high);
  }
  std::memcpy(to + i, from + i, static_cast<std::size_t>(bytes - i));
}

/// Where a panel of 512 columns of a slab of 4096 rows is put together before it goes out: written straight into rows
/// of `dst`, every store of 32 bytes would miss the translation cache (measured: half the speed).
constexpr std::int64_t kSlabRows = 4096;
constexpr std::int64_t kPanelCols = 512;
constexpr std::int64_t kStreamFrom = 1 << 20;  ///< bytes of output from which the caches are passed by

struct Matrix {
  std::byte* dst;
  std::int64_t dst_stride;
  const std::byte* src;
  std::int64_t src_stride;
  std::int64_t rows;
  std::int64_t cols;
};

void fill_stage(std::byte* stage, std::int64_t stage_stride, const Matrix& m, std::int64_t first_row,
                std::int64_t end_row, std::int64_t first_col, std::int64_t end_col) {
  for (std::int64_t row = first_row; row < end_row; row += kBlock) {
    for (std::int64_t col = first_col; col < end_col; col += kBlock) {
      std::byte* to = stage + (col - first_col) * stage_stride + (row - first_row) / 8;
      const std::byte* from = m.src + row * m.src_stride + col / 8;
      const std::int64_t rows = std::min(kBlock, end_row - row);
      const std::int64_t cols = std::min(kBlock, end_col - col);
      if (rows == kBlock && cols == kBlock) {
        const bool more_rows = row + 2 * kBlock <= m.rows;
        transpose_block(to, stage_stride, from, m.src_stride, more_rows ? from + kBlock * m.src_stride : from);
      } else {
        transpose_part(to, stage_stride, from, m.src_stride, rows, cols);
      }
    }
  }
}

void transpose_slabs(const Matrix& m) {
  // One cache line more than a multiple of the page keeps the rows of the stage out of each other's cache sets.
  const std::int64_t most_rows = (std::min(kSlabRows, m.rows) + kBlock - 1) / kBlock * kBlock;
  const std::int64_t most_cols = (std::min(kPanelCols, m.cols) + kBlock - 1) / kBlock * kBlock;
  const std::int64_t stage_stride = most_rows / 8 + 64;
  const auto stage = std::make_unique_for_overwrite<std::byte[]>(static_cast<std::size_t>(most_cols * stage_stride));
  const bool past_caches = m.cols * m.dst_stride >= kStreamFrom;
  for (std::int64_t row = 0; row < m.rows; row += kSlabRows) {
    const std::int64_t end_row = std::min(row + kSlabRows, m.rows);
    const std::int64_t bytes = packed_bytes(end_row - row);
    for (std::int64_t first_col = 0; first_col < m.cols; first_col += kPanelCols) {
      const std::int64_t end_col = std::min(first_col + kPanelCols, m.cols);
      fill_stage(stage.get(), stage_stride, m, row, end_row, first_col, end_col);
      for (std::int64_t col = first_col; col < end_col; ++col) {
        std::byte* to = m.dst + col * m.dst_stride + row / 8;
        const std::byte* from = stage.get() + (col - first_col) * stage_stride;
        past_caches ? copy_past_caches(to, from, bytes) : void(std::memcpy(to, from, static_cast<std::size_t>(bytes)));
      }
    }
  }
  if (past_caches) {
    _mm_sfence();
  }
}

}  // namespace

void transpose(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t rows, std::int64_t cols) {
  if (rows < 64 || cols < 64) {
    portable::transpose(dst, src, rows, cols);
    return;
  }
  const Matrix m{dst.data(), packed_bytes(rows), src.data(), packed_bytes(cols), rows, cols};
  assert(rows * m.src_stride <= static_cast<std::int64_t>(src.size()));
  assert(cols * m.dst_stride <= static_cast<std::int64_t>(dst.size()));
  transpose_slabs(m);
}

}  // namespace gravure::raster::avx2

#endif
