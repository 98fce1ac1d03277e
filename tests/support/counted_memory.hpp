#pragma once

#include <malloc.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

/// Every allocation of the test program is counted, so that what is held at once is measured, not believed. To be
/// included by one file of a test program.
namespace gravure::test {

inline std::atomic<std::int64_t> held_bytes{0};
inline std::atomic<std::int64_t> peak_bytes{0};

namespace counted_memory {

inline void* take(std::size_t size) {
  void* const block = std::malloc(size == 0 ? 1 : size);
  if (block == nullptr) {
    throw std::bad_alloc();
  }
  const auto bytes = static_cast<std::int64_t>(::malloc_usable_size(block));
  const std::int64_t now = held_bytes.fetch_add(bytes) + bytes;
  std::int64_t peak = peak_bytes.load();
  while (now > peak && !peak_bytes.compare_exchange_weak(peak, now)) {
  }
  return block;
}

inline void give_back(void* block) noexcept {
  if (block != nullptr) {
    held_bytes.fetch_sub(static_cast<std::int64_t>(::malloc_usable_size(block)));
    std::free(block);
  }
}

}  // namespace counted_memory
}  // namespace gravure::test

void* operator new(std::size_t size) {
  return gravure::test::counted_memory::take(size);
}
void* operator new[](std::size_t size) {
  return gravure::test::counted_memory::take(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // std::stable_sort asks for room so
  try {
    return gravure::test::counted_memory::take(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* block) noexcept {
  gravure::test::counted_memory::give_back(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  gravure::test::counted_memory::give_back(block);
}
void operator delete[](void* block) noexcept {
  gravure::test::counted_memory::give_back(block);
}
void operator delete(void* block, std::size_t) noexcept {
  gravure::test::counted_memory::give_back(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  gravure::test::counted_memory::give_back(block);
}
