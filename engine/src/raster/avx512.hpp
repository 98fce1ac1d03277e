#pragma once

#include "avx2.hpp"

/// Private to engine/raster: the kernels that need AVX-512 with GFNI. Nothing here may run before cpu_has_avx512() said
/// yes. What is missing here gains nothing over AVX2: memory decides.
#ifdef GRAVURE_HAS_X86_KERNELS

#define GRAVURE_AVX512                                                                                  \
  __attribute__((                                                                                       \
      target("avx512f,avx512bw,avx512vl,avx512dq,avx512vbmi,avx512vbmi2,avx512vpopcntdq,gfni,avx2,bmi," \
             "bmi2,lzcnt,popcnt")))

// g++ 12 takes the deliberately undefined lanes of its own intrinsics for a mistake of ours (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace gravure::raster::avx512 {

inline bool cpu_has_avx512() {
  return avx2::cpu_has_avx2() && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vbmi") != 0 && __builtin_cpu_supports("avx512vbmi2") != 0 &&
         __builtin_cpu_supports("avx512vpopcntdq") != 0 && __builtin_cpu_supports("gfni") != 0;
}

void place_line(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t src_bit,
                std::int64_t width, PlaceOptions options);
void place_rows(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                RowOptions options);
std::int64_t popcount(std::span<const std::byte> bits);
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
void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges);

}  // namespace gravure::raster::avx512

#endif
