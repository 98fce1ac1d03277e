#include <sys/mman.h>
#include <unistd.h>

#include <cstring>

#include "raster_support.hpp"

/// Memory whose neighbours cannot be touched: what the address sanitizer may miss in vector code ends the test here.
namespace gravure::raster {
namespace {

class FencedBytes {
 public:
  /// `size` bytes that end at the fence after them, or begin at the fence before them.
  FencedBytes(std::int64_t size, bool at_end) {
    const std::int64_t page = sysconf(_SC_PAGESIZE);
    const std::int64_t inside = (size + page - 1) / page * page;
    mapped_ = static_cast<std::size_t>(inside + 2 * page);
    base_ = mmap(nullptr, mapped_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    auto* first = static_cast<std::byte*>(base_) + page;
    if (base_ == MAP_FAILED ||
        (inside > 0 && mprotect(first, static_cast<std::size_t>(inside), PROT_READ | PROT_WRITE) != 0)) {
      std::abort();
    }
    bytes_ = {first + (at_end ? inside - size : 0), static_cast<std::size_t>(size)};
  }
  FencedBytes(const FencedBytes&) = delete;
  FencedBytes& operator=(const FencedBytes&) = delete;
  ~FencedBytes() { munmap(base_, mapped_); }
  std::span<std::byte> bytes() const { return bytes_; }
  template <class Sample>
  std::span<Sample> samples() const {
    return {reinterpret_cast<Sample*>(bytes_.data()), bytes_.size() / sizeof(Sample)};
  }

 private:
  void* base_ = nullptr;
  std::size_t mapped_ = 0;
  std::span<std::byte> bytes_;
};

class Bounds : public KernelTest {};
INSTANTIATE_TEST_SUITE_P(Raster, Bounds, kEveryIsa, kIsaName);

TEST_P(Bounds, AreKeptWherePlacing) {
  for (std::int64_t width = 1; width < 1400; width += width < 300 ? 1 : 37) {
    for (const bool at_end : {false, true}) {
      const FencedBytes src(packed_bytes(width), at_end);
      const FencedBytes row(packed_bytes(width), at_end);
      for (const bool mirror : {false, true}) {
        kernels().place_rows(row.bytes(), src.bytes(), width, 1, {.first_mirrored = mirror});
        for (std::int64_t bit = 0; bit < 8; bit += 3) {
          const FencedBytes dst(packed_bytes(bit + width), at_end);
          kernels().place_line(dst.bytes(), bit, src.bytes(), 0, width, {.mirror = mirror});
          const FencedBytes to(packed_bytes(7 - bit + width), at_end);
          kernels().place_line(to.bytes(), 7 - bit, dst.bytes(), bit, width, {.mirror = mirror});
        }
      }
    }
  }
}

TEST_P(Bounds, AreKeptWhereCounting) {
  std::vector<std::uint32_t> edges;
  for (std::int64_t size = 0; size < 300; ++size) {
    for (const bool at_end : {false, true}) {
      const FencedBytes a(size, at_end);
      const FencedBytes b(size, at_end);
      EXPECT_EQ(kernels().popcount(a.bytes()), 0);
      EXPECT_EQ(kernels().first_difference(a.bytes(), b.bytes()), -1);
      EXPECT_EQ(kernels().count_differences(a.bytes(), b.bytes()), 0);
      kernels().append_runs(a.bytes(), 8 * size, edges);
      EXPECT_TRUE(edges.empty());
    }
  }
}

TEST_P(Bounds, AreKeptWhereCuttingSamples) {
  for (std::int64_t width = 1; width < 300; ++width) {
    for (const bool at_end : {false, true}) {
      const FencedBytes src(4 * width, at_end);
      const FencedBytes row(packed_bytes(width), at_end);
      const FencedBytes half(2 * width, at_end);
      const FencedBytes quarter(width, at_end);
      kernels().threshold_u8(row.bytes(), quarter.samples<std::uint8_t>(), width, 1, 1, Where::at_least);
      kernels().threshold_u16(row.bytes(), half.samples<std::uint16_t>(), width, 1, 1, Where::at_least);
      kernels().threshold_f32(row.bytes(), src.samples<float>(), width, 1, 1.0f, Where::at_least);
      const std::vector<std::span<std::byte>> layers{row.bytes()};
      half.samples<std::uint16_t>()[0] = 500;
      quarter.samples<std::uint8_t>()[0] = 50;
      kernels().slice_u16(layers, 0, half.samples<std::uint16_t>(), width, 1, {.levels = 2, .vmin = 0, .vmax = 900});
      EXPECT_EQ(row.bytes()[0], std::byte{0x80});
      kernels().slice_u8(layers, 0, quarter.samples<std::uint8_t>(), width, 1, {.levels = 2, .vmin = 0, .vmax = 90});
      EXPECT_EQ(row.bytes()[0], std::byte{0x80});
    }
  }
}

TEST_P(Bounds, AreKeptWhereTransposing) {
  for (std::int64_t rows = 1; rows < 600; rows += rows < 20 ? 1 : 61) {
    for (std::int64_t cols = 1; cols < 600; cols += cols < 20 ? 1 : 61) {
      for (const bool at_end : {false, true}) {
        const FencedBytes src(rows * packed_bytes(cols), at_end);
        const FencedBytes dst(cols * packed_bytes(rows), at_end);
        kernels().transpose(dst.bytes(), src.bytes(), rows, cols);
      }
    }
  }
}

}  // namespace
}  // namespace gravure::raster
