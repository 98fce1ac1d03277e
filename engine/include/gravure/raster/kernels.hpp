#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "gravure/raster/place.hpp"
#include "gravure/raster/slice.hpp"
#include "gravure/raster/threshold.hpp"

/// The kernels once more, one table for each kind of processor. Users call the plain functions (place.hpp, count.hpp,
/// ...), which take the best table; tests and benchmarks hold the tables against each other.
namespace gravure::raster {

/// Instruction sets, the later the better.
enum class Isa : std::uint8_t {
  portable,  ///< 64-bit words; any processor
  avx2,      ///< AVX2, BMI1/2 and POPCNT (2013 and later)
  avx512,    ///< AVX-512 F, BW, VL, VBMI, VBMI2, VPOPCNTDQ and GFNI besides (2019 and later)
};

std::string_view isa_name(Isa isa) noexcept;

/// All kernels of one instruction set; contracts as in the headers of the plain functions.
struct Kernels {
  Isa isa;
  void (*place_line)(std::span<std::byte>, std::int64_t, std::span<const std::byte>, std::int64_t, std::int64_t,
                     PlaceOptions);
  void (*place_rows)(std::span<std::byte>, std::span<const std::byte>, std::int64_t, std::int64_t, RowOptions);
  std::int64_t (*popcount)(std::span<const std::byte>);
  std::int64_t (*first_difference)(std::span<const std::byte>, std::span<const std::byte>);
  std::int64_t (*count_differences)(std::span<const std::byte>, std::span<const std::byte>);
  void (*threshold_u8)(std::span<std::byte>, std::span<const std::uint8_t>, std::int64_t, std::int64_t, std::uint8_t,
                       Where);
  void (*threshold_u16)(std::span<std::byte>, std::span<const std::uint16_t>, std::int64_t, std::int64_t, std::uint16_t,
                        Where);
  void (*threshold_f32)(std::span<std::byte>, std::span<const float>, std::int64_t, std::int64_t, float, Where);
  void (*slice_u8)(std::span<const std::span<std::byte>>, std::int64_t, std::span<const std::uint8_t>, std::int64_t,
                   std::int64_t, const SliceRange&);
  void (*slice_u16)(std::span<const std::span<std::byte>>, std::int64_t, std::span<const std::uint16_t>, std::int64_t,
                    std::int64_t, const SliceRange&);
  void (*transpose)(std::span<std::byte>, std::span<const std::byte>, std::int64_t, std::int64_t);
  void (*append_runs)(std::span<const std::byte>, std::int64_t, std::vector<std::uint32_t>&);
};

/// The table of an instruction set, or nullptr where this processor lacks it. Isa::portable is always there.
const Kernels* kernels_for(Isa isa) noexcept;

/// The best table this processor can run; looked up once.
const Kernels& best_kernels() noexcept;

}  // namespace gravure::raster
