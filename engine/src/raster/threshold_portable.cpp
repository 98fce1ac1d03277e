#include <cstring>

#include "portable.hpp"
#include "threshold_frame.hpp"
#include "words.hpp"

namespace gravure::raster::portable {
namespace {

using namespace detail;

/// Top bit of each lane set where the lane of x is at least that of t; `tops` has the top bits of all lanes.
/// The lower bits are compared by a subtraction that cannot borrow from the next lane; the top bits decide first.
constexpr std::uint64_t lanes_at_least(std::uint64_t x, std::uint64_t t, std::uint64_t tops) {
  const std::uint64_t lower = (x | tops) - (t & ~tops);
  return ((x & ~t) | (~(x ^ t) & lower)) & tops;
}

/// Eight samples to a byte, the first to the top bit.
unsigned eight(const std::uint8_t* src, std::uint64_t limits, std::uint64_t flip) {
  constexpr std::uint64_t kTops = 0x8080808080808080u;
  std::uint64_t x = load_little(reinterpret_cast<const std::byte*>(src)) ^ flip;
  // Lane k has its bit at 8 k; the product brings it to 63 - k, and no two terms meet.
  x = (lanes_at_least(x, limits, kTops) >> 7) * 0x8040201008040201u;
  return static_cast<unsigned>(x >> 56);
}

unsigned eight(const std::uint16_t* src, std::uint64_t limits, std::uint64_t flip) {
  constexpr std::uint64_t kTops = 0x8000800080008000u;
  unsigned bits = 0;
  for (std::ptrdiff_t half = 0; half < 2; ++half) {
    std::uint64_t x = 0;
    std::memcpy(&x, src + 4 * half, sizeof x);
    if constexpr (std::endian::native == std::endian::big) {
      x = (x >> 48) | ((x >> 16) & 0xFFFF0000u) | ((x & 0xFFFF0000u) << 16) | (x << 48);
    }
    // Lane k has its bit at 16 k; the product brings it to 63 - k.
    x = (lanes_at_least(x ^ flip, limits, kTops) >> 15) * 0x8000400020001000u;
    bits = bits << 4 | static_cast<unsigned>(x >> 60);
  }
  return bits;
}

template <class Sample>
bool one(Sample sample, Sample limit, Where where) {
  return where == Where::at_least ? sample >= limit : sample <= limit;
}

template <class Sample>
std::byte up_to_eight(const Sample* src, std::int64_t count, Sample limit, Where where) {
  unsigned bits = 0;
  for (std::int64_t k = 0; k < count; ++k) {
    bits |= one(src[k], limit, where) ? 0x80u >> k : 0u;
  }
  return static_cast<std::byte>(bits);
}

/// v <= t is ~v >= ~t in integers, so one comparison serves both directions.
template <class Sample>
void integer_row(std::byte* dst, const Sample* src, std::int64_t width, Sample limit, Where where) {
  constexpr std::uint64_t kLanes = ~std::uint64_t{0} / static_cast<Sample>(~Sample{0});
  const std::uint64_t flip = where == Where::at_least ? 0 : ~std::uint64_t{0};
  const std::uint64_t limits = (limit * kLanes) ^ flip;
  std::int64_t i = 0;
  for (; i + 8 <= width; i += 8) {
    *dst++ = static_cast<std::byte>(eight(src + i, limits, flip));
  }
  if (i < width) {
    *dst = up_to_eight(src + i, width - i, limit, where);
  }
}

/// Eight comparisons without a branch: noisy maps would be guessed wrong at every other sample.
template <Where kWhere>
void float_row(std::byte* dst, const float* src, std::int64_t width, float limit) {
  std::int64_t i = 0;
  for (; i + 8 <= width; i += 8) {
    unsigned bits = 0;
    for (int k = 0; k < 8; ++k) {
      bits = bits << 1 | static_cast<unsigned>(kWhere == Where::at_least ? src[i + k] >= limit : src[i + k] <= limit);
    }
    *dst++ = static_cast<std::byte>(bits);
  }
  if (i < width) {
    *dst = up_to_eight(src + i, width - i, limit, kWhere);
  }
}

struct ThresholdLeaf {
  template <class Sample>
  static void threshold_row(std::byte* dst, const Sample* src, std::int64_t width, Sample limit, Where where) {
    portable::threshold_row(dst, src, width, limit, where);
  }
};

}  // namespace

void threshold_row(std::byte* dst, const std::uint8_t* src, std::int64_t width, std::uint8_t limit, Where where) {
  integer_row(dst, src, width, limit, where);
}

void threshold_row(std::byte* dst, const std::uint16_t* src, std::int64_t width, std::uint16_t limit, Where where) {
  integer_row(dst, src, width, limit, where);
}

void threshold_row(std::byte* dst, const float* src, std::int64_t width, float limit, Where where) {
  where == Where::at_least ? float_row<Where::at_least>(dst, src, width, limit)
                           : float_row<Where::at_most>(dst, src, width, limit);
}

void threshold_u8(std::span<std::byte> dst, std::span<const std::uint8_t> src, std::int64_t width, std::int64_t rows,
                  std::uint8_t limit, Where where) {
  threshold_rows_with<ThresholdLeaf>(dst, src, width, rows, limit, where);
}

void threshold_u16(std::span<std::byte> dst, std::span<const std::uint16_t> src, std::int64_t width, std::int64_t rows,
                   std::uint16_t limit, Where where) {
  threshold_rows_with<ThresholdLeaf>(dst, src, width, rows, limit, where);
}

void threshold_f32(std::span<std::byte> dst, std::span<const float> src, std::int64_t width, std::int64_t rows,
                   float limit, Where where) {
  threshold_rows_with<ThresholdLeaf>(dst, src, width, rows, limit, where);
}

}  // namespace gravure::raster::portable
