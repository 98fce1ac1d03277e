#include "gravure/raster/kernels.hpp"

#include "avx2.hpp"
#include "avx512.hpp"
#include "gravure/raster/count.hpp"
#include "gravure/raster/runs.hpp"
#include "gravure/raster/transpose.hpp"
#include "portable.hpp"

namespace gravure::raster {
namespace {

constexpr Kernels kPortable = {
    .isa = Isa::portable,
    .place_line = portable::place_line,
    .place_rows = portable::place_rows,
    .popcount = portable::popcount,
    .first_difference = portable::first_difference,
    .count_differences = portable::count_differences,
    .threshold_u8 = portable::threshold_u8,
    .threshold_u16 = portable::threshold_u16,
    .threshold_f32 = portable::threshold_f32,
    .slice_u8 = portable::slice_u8,
    .slice_u16 = portable::slice_u16,
    .transpose = portable::transpose,
    .append_runs = portable::append_runs,
};

#ifdef GRAVURE_HAS_X86_KERNELS
constexpr Kernels kAvx2 = {
    .isa = Isa::avx2,
    .place_line = avx2::place_line,
    .place_rows = avx2::place_rows,
    .popcount = avx2::popcount,
    .first_difference = avx2::first_difference,
    .count_differences = avx2::count_differences,
    .threshold_u8 = avx2::threshold_u8,
    .threshold_u16 = avx2::threshold_u16,
    .threshold_f32 = avx2::threshold_f32,
    .slice_u8 = avx2::slice_u8,
    .slice_u16 = avx2::slice_u16,
    .transpose = avx2::transpose,
    .append_runs = avx2::append_runs,
};

constexpr Kernels kAvx512 = {
    .isa = Isa::avx512,
    .place_line = avx512::place_line,
    .place_rows = avx512::place_rows,
    .popcount = avx512::popcount,
    .first_difference = avx2::first_difference,
    .count_differences = avx512::count_differences,
    .threshold_u8 = avx512::threshold_u8,
    .threshold_u16 = avx512::threshold_u16,
    .threshold_f32 = avx512::threshold_f32,
    .slice_u8 = avx512::slice_u8,
    .slice_u16 = avx512::slice_u16,
    .transpose = avx2::transpose,
    .append_runs = avx512::append_runs,
};
#endif

}  // namespace

std::string_view isa_name(Isa isa) noexcept {
  switch (isa) {
    case Isa::portable:
      return "portable";
    case Isa::avx2:
      return "avx2";
    case Isa::avx512:
      return "avx512";
  }
  return "?";
}

const Kernels* kernels_for(Isa isa) noexcept {
#ifdef GRAVURE_HAS_X86_KERNELS
  if (isa == Isa::avx2) {
    return avx2::cpu_has_avx2() ? &kAvx2 : nullptr;
  }
  if (isa == Isa::avx512) {
    return avx512::cpu_has_avx512() ? &kAvx512 : nullptr;
  }
#endif
  return isa == Isa::portable ? &kPortable : nullptr;
}

const Kernels& best_kernels() noexcept {
  static const Kernels& best = []() -> const Kernels& {
    for (const Isa isa : {Isa::avx512, Isa::avx2}) {
      if (const Kernels* kernels = kernels_for(isa)) {
        return *kernels;
      }
    }
    return kPortable;
  }();
  return best;
}

void place_line(std::span<std::byte> dst, std::int64_t dst_bit, std::span<const std::byte> src, std::int64_t src_bit,
                std::int64_t width, PlaceOptions options) {
  best_kernels().place_line(dst, dst_bit, src, src_bit, width, options);
}

void place_rows(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t width, std::int64_t rows,
                RowOptions options) {
  best_kernels().place_rows(dst, src, width, rows, options);
}

std::int64_t popcount(std::span<const std::byte> bits) {
  return best_kernels().popcount(bits);
}

std::int64_t first_difference(std::span<const std::byte> a, std::span<const std::byte> b) {
  return best_kernels().first_difference(a, b);
}

std::int64_t count_differences(std::span<const std::byte> a, std::span<const std::byte> b) {
  return best_kernels().count_differences(a, b);
}

void threshold(std::span<std::byte> dst, std::span<const std::uint8_t> src, std::uint8_t limit, Where where) {
  best_kernels().threshold_u8(dst, src, static_cast<std::int64_t>(src.size()), 1, limit, where);
}

void threshold(std::span<std::byte> dst, std::span<const std::uint16_t> src, std::uint16_t limit, Where where) {
  best_kernels().threshold_u16(dst, src, static_cast<std::int64_t>(src.size()), 1, limit, where);
}

void threshold(std::span<std::byte> dst, std::span<const float> src, float limit, Where where) {
  best_kernels().threshold_f32(dst, src, static_cast<std::int64_t>(src.size()), 1, limit, where);
}

void threshold_rows(std::span<std::byte> dst, std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows,
                    std::uint8_t limit, Where where) {
  best_kernels().threshold_u8(dst, src, width, rows, limit, where);
}

void threshold_rows(std::span<std::byte> dst, std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows,
                    std::uint16_t limit, Where where) {
  best_kernels().threshold_u16(dst, src, width, rows, limit, where);
}

void threshold_rows(std::span<std::byte> dst, std::span<const float> src, std::int64_t width, std::int64_t rows,
                    float limit, Where where) {
  best_kernels().threshold_f32(dst, src, width, rows, limit, where);
}

void slice_rows_u16(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
                    std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows,
                    const SliceRange& range) {
  best_kernels().slice_u16(layers, first_level, src, width, rows, range);
}

void slice_rows_u8(std::span<const std::span<std::byte>> layers, std::int64_t first_level,
                   std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows, const SliceRange& range) {
  best_kernels().slice_u8(layers, first_level, src, width, rows, range);
}

void transpose(std::span<std::byte> dst, std::span<const std::byte> src, std::int64_t rows, std::int64_t cols) {
  best_kernels().transpose(dst, src, rows, cols);
}

void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges) {
  best_kernels().append_runs(line, width, edges);
}

}  // namespace gravure::raster
