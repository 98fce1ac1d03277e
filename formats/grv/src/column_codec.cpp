#include "column_codec.hpp"

#include <vector>

namespace gravure::grv {
namespace {

constexpr int kTimes = 3;
constexpr std::size_t kBytes = sizeof(std::int64_t);

/// x[r] - x[r - 1] in place, 0 before the first row; unsigned, where overflow wraps.
void difference(std::size_t columns, std::span<std::uint64_t> values) {
  for (std::size_t i = values.size(); i-- > columns;) {
    values[i] -= values[i - columns];
  }
}

void sum_up(std::size_t columns, std::span<std::uint64_t> values) {
  for (std::size_t i = columns; i < values.size(); ++i) {
    values[i] += values[i - columns];
  }
}

std::byte byte_of(std::uint64_t value, std::size_t weight) {
  return static_cast<std::byte>(value >> (8 * weight));
}

/// Little-endian numbers one after the other, or byte 0 of all, byte 1 of all ...
std::size_t place_of(bool shuffled, std::size_t index, std::size_t weight, std::size_t count) {
  return shuffled ? weight * count + index : index * kBytes + weight;
}

}  // namespace

Result<Packed> pack_columns(Compression compression, int zstd_level, std::size_t columns,
                            std::span<const std::int64_t> values) {
  std::vector<std::uint64_t> changed(values.begin(), values.end());
  for (int time = 0; time < kTimes; ++time) {
    difference(columns, changed);
  }
  const bool shuffled = compression != Compression::none;
  std::vector<std::byte> bytes(changed.size() * kBytes);
  for (std::size_t i = 0; i < changed.size(); ++i) {
    for (std::size_t weight = 0; weight < kBytes; ++weight) {
      bytes[place_of(shuffled, i, weight, changed.size())] = byte_of(changed[i], weight);
    }
  }
  return pack(compression, zstd_level, bytes);
}

Result<void> unpack_columns(Compression compression, bool raw, std::size_t columns, std::span<const std::byte> stored,
                            std::span<std::int64_t> out) {
  std::vector<std::byte> bytes(out.size() * kBytes);
  GRAVURE_CHECK(unpack(compression, raw, stored, bytes));
  const bool shuffled = compression != Compression::none;
  std::vector<std::uint64_t> values(out.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t weight = 0; weight < kBytes; ++weight) {
      values[i] |= static_cast<std::uint64_t>(bytes[place_of(shuffled, i, weight, values.size())]) << (8 * weight);
    }
  }
  for (int time = 0; time < kTimes; ++time) {
    sum_up(columns, values);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<std::int64_t>(values[i]);
  }
  return {};
}

}  // namespace gravure::grv
