#include "avx512.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <array>

#include "place_frame.hpp"

namespace gravure::raster::avx512 {
namespace {

/// Bit matrix for gf2p8affineqb that shifts each byte left by `shift` (right where negative), then reverses its bits if
/// `mirror`. Row 7 - i of the matrix, a byte, chooses the source bit of result bit i.
constexpr std::uint64_t byte_matrix(int shift, bool mirror) {
  std::uint64_t matrix = 0;
  for (int i = 0; i < 8; ++i) {
    const int from = (mirror ? 7 - i : i) - shift;
    if (from >= 0 && from < 8) {
      matrix |= std::uint64_t{1} << (8 * (7 - i) + from);
    }
  }
  return matrix;
}

/// Matrices for the byte a bit comes from (shifted left by the phase) and for the byte after it (the other way).
struct Matrices {
  std::uint64_t at;
  std::uint64_t after;
};

constexpr auto kMatrices = [] {
  std::array<std::array<Matrices, 8>, 2> all{};
  for (std::size_t mirror = 0; mirror < 2; ++mirror) {
    for (int phase = 0; phase < 8; ++phase) {
      all[mirror][static_cast<std::size_t>(phase)] = {byte_matrix(phase, mirror == 1),
                                                      byte_matrix(phase - 8, mirror == 1)};
    }
  }
  return all;
}();

constexpr auto kByteLanes = [] {
  std::array<std::int8_t, 64> lanes{};
  for (std::size_t i = 0; i < 64; ++i) {
    lanes[i] = static_cast<std::int8_t>(i);
  }
  return lanes;
}();

struct Mill {
  __m512i at;
  __m512i after;
  __m512i flips;
  __m512i lanes;

  GRAVURE_AVX512 Mill(int phase, bool mirror, unsigned flip)
      : at(_mm512_set1_epi64(static_cast<long long>(kMatrices[mirror ? 1 : 0][static_cast<std::size_t>(phase)].at))),
        after(_mm512_set1_epi64(
            static_cast<long long>(kMatrices[mirror ? 1 : 0][static_cast<std::size_t>(phase)].after))),
        flips(_mm512_set1_epi8(static_cast<char>(flip))),
        lanes(_mm512_loadu_si512(kByteLanes.data())) {}

  /// The `kPhase` says whether there is a byte after; else it is neither read nor used.
  template <bool kPhase, bool kMirror>
  GRAVURE_AVX512 void step(std::byte* dst, const std::byte* src, __mmask64 bytes, __m512i order) const {
    __m512i bits = _mm512_gf2p8affine_epi64_epi8(_mm512_maskz_loadu_epi8(bytes, src), at, 0);
    if constexpr (kPhase) {
      const __m512i low = _mm512_gf2p8affine_epi64_epi8(_mm512_maskz_loadu_epi8(bytes, src + 1), after, 0);
      bits = _mm512_ternarylogic_epi64(bits, low, flips, 0x96);
    } else {
      bits = _mm512_xor_si512(bits, flips);
    }
    if constexpr (kMirror) {
      bits = _mm512_permutexvar_epi8(order, bits);
    }
    _mm512_mask_storeu_epi8(dst, bytes, bits);
  }

  /// `src` is the first byte needed (straight) or the byte after the last whole one needed (mirrored).
  template <bool kPhase, bool kMirror>
  GRAVURE_AVX512 void fill(std::byte* dst, std::int64_t bytes, const std::byte* src) const {
    const __m512i backwards = _mm512_sub_epi8(_mm512_set1_epi8(63), lanes);
    std::int64_t i = 0;
    for (; i + 64 <= bytes; i += 64) {
      step<kPhase, kMirror>(dst + i, kMirror ? src - i - 64 : src + i, ~__mmask64{0}, backwards);
    }
    if (const std::int64_t rest = bytes - i; rest > 0) {
      const __m512i order = _mm512_sub_epi8(_mm512_set1_epi8(static_cast<char>(rest - 1)), lanes);
      step<kPhase, kMirror>(dst + i, kMirror ? src - bytes : src + i, ~__mmask64{0} >> (64 - rest), order);
    }
  }
};

template <bool kMirror>
GRAVURE_AVX512 void fill_from(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t bit,
                              unsigned flip) {
  const int phase = static_cast<int>(bit & 7);
  const Mill mill(phase, kMirror, flip);
  if (phase == 0) {
    mill.fill<false, kMirror>(dst, bytes, src + (bit >> 3));
  } else {
    mill.fill<true, kMirror>(dst, bytes, src + (bit >> 3));
  }
}

struct PlaceLeaf {
  static void copy_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t first, unsigned flip) {
    fill_from<false>(dst, bytes, src, first, flip);
  }
  static void mirror_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t end, unsigned flip) {
    fill_from<true>(dst, bytes, src, end, flip);
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

}  // namespace gravure::raster::avx512

#endif
