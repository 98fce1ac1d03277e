#pragma once

#include <cstddef>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/zones/local_frame.hpp"
#include "gravure/zones/piece.hpp"

namespace gravure::zones {

/// A stack of layers at right angles to z, counted from the top.
struct LayerStack {
  double top_mm = 0;        ///< z of the highest point
  double thickness_mm = 0;  ///< of each layer
  std::size_t count = 1;

  double centre_mm(std::size_t layer) const noexcept {
    return top_mm - (static_cast<double>(layer) + 0.5) * thickness_mm;
  }
  /// The layer of a height, floor((top - z) / thickness) held to 0 .. count - 1.
  std::size_t layer_of(double z_mm) const noexcept;
};

/// N = max(1, ceil(height / most)) layers of height / N: the stack is centred. [D] eq. 14 takes floor + 1, which gives
/// an empty layer wherever the height is a multiple. A height beyond a multiple by 1e-12 of it counts as the multiple.
/// out_of_range for a thickness that is not above 0, a height below 0, or more than a million layers.
Result<LayerStack> layer_stack(double least_mm, double top_mm, double most_thickness_mm);

/// A part of a piece inside one layer, in local coordinates.
struct Stroke {
  std::size_t piece = 0;
  std::size_t layer = 0;
  std::vector<Vector3> points_mm;
};

/// Cuts pieces where they cross from layer to layer. The point of a cut, on the plane to the last bit, ends one stroke
/// and begins the next, so that nothing is lost or doubled; what lies in a plane belongs to the layer below it.
std::vector<Stroke> cut_layers(const std::vector<Piece>& pieces, const std::vector<std::size_t>& which,
                               const LocalFrame& frame, const LayerStack& stack);

}  // namespace gravure::zones
