#include "avx512.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include <array>

#include "runs_frame.hpp"

namespace gravure::raster::avx512 {
namespace {

constexpr auto kPositions = [] {
  std::array<std::int8_t, 64> positions{};
  for (std::size_t i = 0; i < 64; ++i) {
    positions[i] = static_cast<std::int8_t>(i);
  }
  return positions;
}();

GRAVURE_AVX512 inline void write_16(std::uint32_t* to, __m128i positions, __m512i first) {
  _mm512_storeu_si512(to, _mm512_add_epi32(_mm512_cvtepu8_epi32(positions), first));
}

struct RunsLeaf {
  /// The positions of the ones pressed together, then widened sixteen at a time.
  GRAVURE_AVX512 static std::size_t write_edges(std::uint32_t* to, std::uint64_t differ, std::uint32_t first) {
    const auto count = static_cast<std::size_t>(_mm_popcnt_u64(differ));
    if (count == 0) {
      return 0;
    }
    const __m512i positions = _mm512_maskz_compress_epi8(differ, _mm512_loadu_si512(kPositions.data()));
    const __m512i base = _mm512_set1_epi32(static_cast<int>(first));
    write_16(to, _mm512_castsi512_si128(positions), base);
    if (count > 16) {
      write_16(to + 16, _mm512_extracti32x4_epi32(positions, 1), base);
      if (count > 32) {
        write_16(to + 32, _mm512_extracti32x4_epi32(positions, 2), base);
        write_16(to + 48, _mm512_extracti32x4_epi32(positions, 3), base);
      }
    }
    return count;
  }
};

}  // namespace

GRAVURE_AVX512 void append_runs(std::span<const std::byte> line, std::int64_t width,
                                std::vector<std::uint32_t>& edges) {
  detail::append_runs_with<RunsLeaf>(line, width, edges);
}

}  // namespace gravure::raster::avx512

#endif
