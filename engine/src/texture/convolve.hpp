#pragma once

#include <functional>
#include <span>
#include <vector>

#include "gravure/texture/decomposition.hpp"

namespace gravure::texture {

/// Each point replaced by the mean of its neighbours, `weights` for distances of 0, 1, 2 ... steps to both sides; the
/// weights of all add up to 1. By FFT.
std::vector<Vector2> convolve(std::span<const Vector2> path, const std::vector<double>& weights, Ends ends);

/// The weights that do to waves what `response` says (rad a step, 0 to pi): those for up to `radius` steps, beyond
/// which they must have faded.
std::vector<double> weights_of(const std::function<double(double)>& response, std::size_t radius);

}  // namespace gravure::texture
