#pragma once

#include "gravure/raster/kernels.hpp"

/// Private to engine/raster: the kernels that need AVX2. Nothing here may run before cpu_has_avx2() said yes.
#if defined(__x86_64__)
#define GRAVURE_HAS_X86_KERNELS 1

#include <immintrin.h>

/// For functions, not for files: a header inlined into a file built with -mavx2 would reach other processors.
#define GRAVURE_AVX2 __attribute__((target("avx2,bmi,bmi2,lzcnt,popcnt")))

namespace gravure::raster::avx2 {

inline bool cpu_has_avx2() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
         __builtin_cpu_supports("bmi2") != 0 && __builtin_cpu_supports("popcnt") != 0;
}

GRAVURE_AVX2 inline __m256i load(const std::byte* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

void place_line(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t src_bit,
                std::int64_t width, PlaceOptions options);
void place_rows(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                RowOptions options);
std::int64_t popcount(std::span<const std::byte> bits);
std::int64_t first_difference(std::span<const std::byte> a, std::span<const std::byte> b);
std::int64_t count_differences(std::span<const std::byte> a, std::span<const std::byte> b);
void threshold_u8(std::span<std::byte> dst, std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows,
                  std::uint8_t limit, Where where);
void threshold_u16(std::span<std::byte> dst, std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows,
                   std::uint16_t limit, Where where);
void threshold_f32(std::span<std::byte> dst, std::span<const float> src, std::int64_t width, std::int64_t rows,
                   float limit, Where where);
void slice_u8(std::span<const std::span<std::byte>> layers, std::int64_t first_level, std::span<const std::uint8_t> src,
              std::int64_t width, std::int64_t rows, const SliceRange& range);
void slice_u16(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
               std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows, const SliceRange& range);
void transpose(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t rows, std::int64_t cols);
void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges);

}  // namespace gravure::raster::avx2

#endif
