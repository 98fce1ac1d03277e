#include "avx2.hpp"

#ifdef GRAVURE_HAS_X86_KERNELS

#include <immintrin.h>

#include "runs_frame.hpp"

namespace gravure::raster::avx2 {
namespace {

GRAVURE_AVX2 inline std::uint64_t write_four(std::uint32_t* to, std::uint64_t differ, std::uint32_t first) {
  to[0] = first + static_cast<std::uint32_t>(_tzcnt_u64(differ));
  differ = _blsr_u64(differ);
  to[1] = first + static_cast<std::uint32_t>(_tzcnt_u64(differ));
  differ = _blsr_u64(differ);
  to[2] = first + static_cast<std::uint32_t>(_tzcnt_u64(differ));
  differ = _blsr_u64(differ);
  to[3] = first + static_cast<std::uint32_t>(_tzcnt_u64(differ));
  return _blsr_u64(differ);
}

struct RunsLeaf {
  /// Always writes in eights, up to seven beyond the last: a loop whose length is guessed wrong costs more.
  GRAVURE_AVX2 static std::size_t write_edges(std::uint32_t* to, std::uint64_t differ, std::uint32_t first) {
    const auto count = static_cast<std::size_t>(_mm_popcnt_u64(differ));
    for (std::size_t k = 0; k < count; k += 8) {
      differ = write_four(to + k, differ, first);
      differ = write_four(to + k + 4, differ, first);
    }
    return count;
  }
};

}  // namespace

GRAVURE_AVX2 void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges) {
  detail::append_runs_with<RunsLeaf>(line, width, edges);
}

}  // namespace gravure::raster::avx2

#endif
