#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// Private to engine/raster: bits and 64-bit words in memory, MSB first.
namespace gravure::raster::detail {

constexpr std::uint64_t byte_swap(std::uint64_t word) {
  return __builtin_bswap64(word);
}

inline std::uint64_t load_little(const std::byte* from) {
  std::uint64_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return std::endian::native == std::endian::little ? word : byte_swap(word);
}

inline void store_little(std::byte* to, std::uint64_t word) {
  word = std::endian::native == std::endian::little ? word : byte_swap(word);
  std::memcpy(to, &word, sizeof word);
}

/// 64 bits in stream order: bit 0 of the stream is the top bit of the word.
inline std::uint64_t load_stream(const std::byte* from) {
  return byte_swap(load_little(from));
}
inline void store_stream(std::byte* to, std::uint64_t word) {
  store_little(to, byte_swap(word));
}

/// The same for the first `bytes` (0 .. 8) bytes; the others read as 0 and are not written.
inline std::uint64_t load_stream_part(const std::byte* from, std::int64_t bytes) {
  std::uint64_t word = 0;
  for (std::int64_t i = 0; i < bytes; ++i) {
    word |= std::to_integer<std::uint64_t>(from[i]) << (56 - 8 * i);
  }
  return word;
}

inline void store_stream_part(std::byte* to, std::uint64_t word, std::int64_t bytes) {
  for (std::int64_t i = 0; i < bytes; ++i) {
    to[i] = static_cast<std::byte>(word >> (56 - 8 * i));
  }
}

/// Reverses the bits inside each of the eight bytes.
constexpr std::uint64_t reverse_in_bytes(std::uint64_t word) {
  word = ((word >> 4) & 0x0F0F0F0F0F0F0F0Fu) | ((word & 0x0F0F0F0F0F0F0F0Fu) << 4);
  word = ((word >> 2) & 0x3333333333333333u) | ((word & 0x3333333333333333u) << 2);
  return ((word >> 1) & 0x5555555555555555u) | ((word & 0x5555555555555555u) << 1);
}

constexpr unsigned reverse_byte(unsigned byte) {
  return static_cast<unsigned>(reverse_in_bytes(byte));
}

/// Bits [first, first + count) of a stream, count 1 .. 8, as a number. Reads only the bytes that hold them.
inline unsigned take_bits(const std::byte* from, std::int64_t first, int count) {
  const std::byte* at = from + (first >> 3);
  const int phase = static_cast<int>(first & 7);
  unsigned two = std::to_integer<unsigned>(at[0]) << 8;
  if (phase + count > 8) {
    two |= std::to_integer<unsigned>(at[1]);
  }
  return (two >> (16 - phase - count)) & ((1u << count) - 1);
}

/// The top `count` (1 .. 8) bits of a byte.
constexpr unsigned top_bits(int count) {
  return (0xFF00u >> count) & 0xFFu;
}

/// Ones in a word, in plain arithmetic: without -mpopcnt the built-in is a table in libgcc.
constexpr std::uint64_t ones(std::uint64_t word) {
  word -= (word >> 1) & 0x5555555555555555u;
  word = (word & 0x3333333333333333u) + ((word >> 2) & 0x3333333333333333u);
  word = (word + (word >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
  return (word * 0x0101010101010101u) >> 56;
}

}  // namespace gravure::raster::detail
