#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gravure/raster/kernels.hpp"

/// Private to engine/raster: the kernels in 64-bit words, which every instruction set falls back to for short pieces.
namespace gravure::raster::portable {

void copy_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t first, unsigned flip);
void mirror_bits(std::byte* dst, std::int64_t bytes, const std::byte* src, std::int64_t end, unsigned flip);

void place_line(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t src_bit,
                std::int64_t width, PlaceOptions options);
void place_rows(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                RowOptions options);

std::int64_t popcount(std::span<const std::byte> bits);
std::int64_t first_difference(std::span<const std::byte> a, std::span<const std::byte> b);
std::int64_t count_differences(std::span<const std::byte> a, std::span<const std::byte> b);

/// One row of `width` samples to packed_bytes(width) bytes.
void threshold_row(std::byte* dst, const std::uint8_t* src, std::int64_t width, std::uint8_t limit, Where where);
void threshold_row(std::byte* dst, const std::uint16_t* src, std::int64_t width, std::uint16_t limit, Where where);
void threshold_row(std::byte* dst, const float* src, std::int64_t width, float limit, Where where);

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

}  // namespace gravure::raster::portable
