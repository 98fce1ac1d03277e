#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gravure/texture/decomposition.hpp"

namespace gravure::texture {

/// The weight of neighbours so many steps away, 0 or more.
using Weight = std::function<double(std::int64_t)>;

/// Each point replaced by the mean of its neighbours, up to `radius` steps to both sides; all weights add up to 1. By
/// FFT. However far the weights reach, the memory is bounded by the length of the path: what reaches beyond it is
/// folded back (is_folded()), exactly.
std::vector<Vector2> convolve(std::span<const Vector2> path, const Weight& weight, std::int64_t radius, Ends ends);

/// Whether weights reach so far beyond a path of `count` points that they are asked for one by one and folded.
bool is_folded(std::int64_t radius, std::size_t count) noexcept;

/// The weights that do to waves what `response` says (rad a step, 0 to pi): those for up to `radius` steps, beyond
/// which they must have faded.
std::vector<double> weights_of(const std::function<double(double)>& response, std::size_t radius);

}  // namespace gravure::texture
