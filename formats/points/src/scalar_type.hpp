#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

namespace gravure {

/// How a number is stored in binary PLY and PCD.
enum class ScalarType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

constexpr std::size_t bytes_of(ScalarType type) noexcept {
  constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

/// The number at `from`, where bytes_of(type) bytes must be.
inline double scalar_at(const char* from, ScalarType type, bool big_endian) noexcept {
  std::uint64_t bits = 0;
  const std::size_t size = bytes_of(type);
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t place = big_endian ? size - 1 - i : i;
    bits |= std::uint64_t{static_cast<unsigned char>(from[i])} << (8 * place);
  }
  switch (type) {
    case ScalarType::i8:
      return static_cast<double>(static_cast<std::int8_t>(bits));
    case ScalarType::i16:
      return static_cast<double>(static_cast<std::int16_t>(bits));
    case ScalarType::i32:
      return static_cast<double>(static_cast<std::int32_t>(bits));
    case ScalarType::i64:
      return static_cast<double>(static_cast<std::int64_t>(bits));
    case ScalarType::f32:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case ScalarType::f64:
      return std::bit_cast<double>(bits);
    default:
      return static_cast<double>(bits);
  }
}

}  // namespace gravure
