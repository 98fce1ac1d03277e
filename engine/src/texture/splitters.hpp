#pragma once

#include <memory>

#include "gravure/texture/splitter.hpp"

namespace gravure::texture {

std::unique_ptr<Splitter> gaussian_splitter(const GaussianFilter& filter);
std::unique_ptr<Splitter> savitzky_golay_splitter();
std::unique_ptr<Splitter> fft_splitter();
std::unique_ptr<Splitter> adaptive_splitter(const GaussianFilter& filter);
std::unique_ptr<Splitter> optimal_splitter();

/// How far the worst deviation of a point is of what is allowed: up to 1 within the limits.
double strain(const Deviation& off, const DeviationLimits& limits);

}  // namespace gravure::texture
