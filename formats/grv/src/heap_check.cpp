#include "heap_check.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#include "seal.hpp"

namespace gravure::grv {
namespace {

constexpr std::size_t kPrefixBytes = 32;  // "HEAP", version, size of the names, first free block, place of the names
constexpr std::uint64_t kFreeBlockHead = 16;  // where the next one is, how long this one is
constexpr std::uint64_t kNoFreeBlock = 1;

std::uint64_t number(const std::byte* at) {
  std::uint64_t value = 0;
  for (int i = 7; i >= 0; --i) {
    value = value << 8 | std::to_integer<std::uint64_t>(at[i]);
  }
  return value;
}

/// The chain of free blocks stays inside the heap and ends.
bool chain_is_sound(const ByteFile& file, std::uint64_t names_at, std::uint64_t size, std::uint64_t block) {
  for (std::uint64_t seen = 0; block != kNoFreeBlock; ++seen) {
    std::array<std::byte, kFreeBlockHead> head = {};
    if (seen > size / kFreeBlockHead || size < kFreeBlockHead || block > size - kFreeBlockHead) {
      return false;
    }
    const auto got = file.read(names_at + block, head);
    if (!got || got.value() != head.size() || number(&head[8]) > size - block) {
      return false;
    }
    block = number(head.data());
  }
  return true;
}

}  // namespace

bool heap_is_sound(const ByteFile& file, std::span<const std::byte> bytes) {
  if (bytes.size() < kPrefixBytes || std::memcmp(bytes.data(), "HEAP", 4) != 0) {
    return true;
  }
  const std::uint64_t size = number(&bytes[8]);
  const std::uint64_t first_free = number(&bytes[16]);
  const std::uint64_t names_at = number(&bytes[24]);
  const auto file_bytes = file.size();
  if (!file_bytes || file_bytes.value() < Seal::kBytes) {
    return false;
  }
  const std::uint64_t room = file_bytes.value() - Seal::kBytes;
  return names_at <= room && size <= room - names_at && chain_is_sound(file, Seal::kBytes + names_at, size, first_free);
}

}  // namespace gravure::grv
