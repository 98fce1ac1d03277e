#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace gravure::motion {

template <std::size_t N>
struct Vertex {
  std::array<double, N> x{};
  double cost = 0;
};

/// Downhill simplex of Nelder and Mead from `start` with edges of `size`, for costs that may jump. Never returns a
/// vertex worse than the start. `cost(x, cutoff)` may answer infinity for anything not below the cutoff.
template <std::size_t N, class Cost>
Vertex<N> descend(const Vertex<N>& start, const std::array<double, N>& size, int steps, const Cost& cost) {
  std::array<Vertex<N>, N + 1> simplex;
  simplex.fill(start);
  for (std::size_t i = 0; i < N; ++i) {
    simplex[i + 1].x[i] += size[i];
    simplex[i + 1].cost = cost(simplex[i + 1].x, std::numeric_limits<double>::infinity());
  }
  const auto better = [](const Vertex<N>& a, const Vertex<N>& b) { return a.cost < b.cost; };
  for (int step = 0; step < steps; ++step) {
    std::stable_sort(simplex.begin(), simplex.end(), better);
    std::array<double, N> centre{};
    for (std::size_t v = 0; v < N; ++v) {
      for (std::size_t i = 0; i < N; ++i) {
        centre[i] += simplex[v].x[i] / static_cast<double>(N);
      }
    }
    Vertex<N>& worst = simplex[N];
    const auto at = [&](double along) {
      Vertex<N> vertex;
      for (std::size_t i = 0; i < N; ++i) {
        vertex.x[i] = centre[i] + along * (worst.x[i] - centre[i]);
      }
      vertex.cost = cost(vertex.x, worst.cost);
      return vertex;
    };
    Vertex<N> reflected = at(-1);
    if (reflected.cost < simplex[0].cost) {
      const Vertex<N> expanded = at(-2);
      worst = expanded.cost < reflected.cost ? expanded : reflected;
      continue;
    }
    if (reflected.cost < simplex[N - 1].cost) {
      worst = reflected;
      continue;
    }
    const Vertex<N> contracted = reflected.cost < worst.cost ? at(-0.5) : at(0.5);
    if (contracted.cost < std::min(reflected.cost, worst.cost)) {
      worst = contracted;
      continue;
    }
    for (std::size_t v = 1; v <= N; ++v) {
      for (std::size_t i = 0; i < N; ++i) {
        simplex[v].x[i] = (simplex[v].x[i] + simplex[0].x[i]) / 2;
      }
      simplex[v].cost = cost(simplex[v].x, std::numeric_limits<double>::infinity());
    }
  }
  return *std::min_element(simplex.begin(), simplex.end(), better);
}

}  // namespace gravure::motion
