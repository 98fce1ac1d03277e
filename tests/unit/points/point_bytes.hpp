#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace gravure::test {

/// `value` as its bytes, the lowest first or last.
template <class Value, class Bits>
void append_bits(std::string& bytes, Value value, bool big_endian) {
  const auto bits = std::bit_cast<Bits>(value);
  for (std::size_t i = 0; i < sizeof(Bits); ++i) {
    const std::size_t place = big_endian ? sizeof(Bits) - 1 - i : i;
    bytes.push_back(static_cast<char>(bits >> (8 * place) & 0xFFU));
  }
}

inline void append_float(std::string& bytes, float value, bool big_endian = false) {
  append_bits<float, std::uint32_t>(bytes, value, big_endian);
}

inline void append_u32(std::string& bytes, std::uint32_t value, bool big_endian = false) {
  append_bits<std::uint32_t, std::uint32_t>(bytes, value, big_endian);
}

/// A binary STL of the triangles whose corners follow each other.
inline std::string binary_stl(const std::string& header, const std::initializer_list<float>& corners) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  append_u32(bytes, static_cast<std::uint32_t>(corners.size() / 9));
  std::size_t taken = 0;
  for (const float value : corners) {
    if (taken++ % 9 == 0) {
      bytes.append(12, '\0');  // normal
    }
    append_float(bytes, value);
    if (taken % 9 == 0) {
      bytes.append(2, '\0');
    }
  }
  return bytes;
}

}  // namespace gravure::test
