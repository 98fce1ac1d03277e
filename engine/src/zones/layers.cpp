#include "gravure/zones/layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gravure::zones {
namespace {

/// A segment's inner points, on the planes it crosses, in its own order.
std::vector<Vector3> cuts_of(const Vector3& a, const Vector3& b, const LayerStack& stack) {
  std::vector<Vector3> cuts;
  const auto plane = [&](std::size_t m) { return stack.top_mm - static_cast<double>(m) * stack.thickness_mm; };
  const auto [low, high] = std::minmax(a.z(), b.z());
  const std::size_t first = stack.layer_of(high);
  const std::size_t last = stack.layer_of(low);
  for (std::size_t m = std::max<std::size_t>(1, first); m <= std::min(last + 1, stack.count - 1); ++m) {
    const double z = plane(m);
    if (z > low && z < high) {
      Vector3 cut = a + (z - a.z()) / (b.z() - a.z()) * (b - a);
      cut.z() = z;
      cuts.push_back(cut);
    }
  }
  if (b.z() > a.z()) {
    std::reverse(cuts.begin(), cuts.end());
  }
  return cuts;
}

}  // namespace

std::size_t LayerStack::layer_of(double z_mm) const noexcept {
  if (!(thickness_mm > 0)) {
    return 0;
  }
  const double index = std::floor((top_mm - z_mm) / thickness_mm);
  return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(count - 1)));
}

Result<LayerStack> layer_stack(double least_mm, double top_mm, double most_thickness_mm) {
  const double height = top_mm - least_mm;
  if (!(most_thickness_mm > 0) || !std::isfinite(most_thickness_mm)) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("layer thickness = {} mm: must be greater than 0", most_thickness_mm)};
  }
  if (!std::isfinite(height) || height < 0) {
    return Error{ErrorCode::out_of_range,
                 fmt::format("heights from {} to {} mm: must be numbers, the lower one first", least_mm, top_mm)};
  }
  constexpr double kRounding = 1e-12;
  constexpr double kMostLayers = 1e6;
  const double layers = std::max(1.0, std::ceil(height / most_thickness_mm * (1 - kRounding)));
  if (layers > kMostLayers) {
    return Error{ErrorCode::out_of_range, fmt::format("{} layers of {} mm in a height of {} mm: must be at most {}",
                                                      layers, most_thickness_mm, height, kMostLayers)};
  }
  return LayerStack{top_mm, height / layers, static_cast<std::size_t>(layers)};
}

std::vector<Stroke> cut_layers(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which,
                               const LocalFrame& frame, const LayerStack& stack) {
  std::vector<Stroke> strokes;
  for (const std::size_t piece : which) {
    const std::vector<Vector3>& points = pieces[piece].points_mm;
    Vector3 from = frame.to_local(points[0]);
    bool is_open = false;
    const auto go_to = [&](const Vector3& to) {
      const std::size_t layer = stack.layer_of((from.z() + to.z()) / 2);
      if (!is_open || strokes.back().layer != layer) {
        strokes.push_back({piece, layer, {from}});
        is_open = true;
      }
      strokes.back().points_mm.push_back(to);
      from = to;
    };
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Vector3 end = frame.to_local(points[i]);
      for (const Vector3& cut : cuts_of(from, end, stack)) {
        go_to(cut);
      }
      go_to(end);
    }
  }
  return strokes;
}

}  // namespace gravure::zones
