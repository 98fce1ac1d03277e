#include <bit>

#include "portable.hpp"
#include "runs_frame.hpp"

namespace gravure::raster::portable {
namespace {

struct RunsLeaf {
  static std::size_t write_edges(std::uint32_t* to, std::uint64_t differ, std::uint32_t first) {
    std::size_t count = 0;
    for (; differ != 0; differ &= differ - 1) {
      to[count++] = first + static_cast<std::uint32_t>(std::countr_zero(differ));
    }
    return count;
  }
};

}  // namespace

void append_runs(std::span<const std::byte> line, std::int64_t width, std::vector<std::uint32_t>& edges) {
  detail::append_runs_with<RunsLeaf>(line, width, edges);
}

}  // namespace gravure::raster::portable
