#include "morton.hpp"

#include <algorithm>
#include <utility>

namespace gravure::registration {
namespace {

constexpr double kCells = 2097151;  // 21 bits an axis

/// The 21 low bits with two 0 bits between each two.
std::uint64_t spread_bits(std::uint64_t bits) noexcept {
  bits = (bits | bits << 32U) & 0x001F00000000FFFFU;
  bits = (bits | bits << 16U) & 0x001F0000FF0000FFU;
  bits = (bits | bits << 8U) & 0x100F00F00F00F00FU;
  bits = (bits | bits << 4U) & 0x10C30C30C30C30C3U;
  return (bits | bits << 2U) & 0x1249249249249249U;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const Vectors& points) {
  if (points.empty()) {
    return {};
  }
  Eigen::Vector3d low = points.front();
  Eigen::Vector3d high = points.front();
  for (const Eigen::Vector3d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double widest = (high - low).maxCoeff();
  const double cells_per_mm = widest > 0 ? kCells / widest : 0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> coded;
  coded.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = (points[i] - low) * cells_per_mm;
    const std::uint64_t code = spread_bits(static_cast<std::uint64_t>(cell[0])) |
                               spread_bits(static_cast<std::uint64_t>(cell[1])) << 1U |
                               spread_bits(static_cast<std::uint64_t>(cell[2])) << 2U;
    coded.emplace_back(code, static_cast<std::uint32_t>(i));
  }
  std::sort(coded.begin(), coded.end());
  std::vector<std::uint32_t> order;
  order.reserve(points.size());
  for (const auto& [code, index] : coded) {
    order.push_back(index);
  }
  return order;
}

}  // namespace gravure::registration
