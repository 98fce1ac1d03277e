#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "gravure/report/layer_pictures.hpp"
#include "small_job.hpp"

namespace gravure::report::test {

using gravure::test::MemorySource;
using gravure::test::SmallJob;

/// A job of random bits, planned and compiled.
inline void prepare(SmallJob& small, LinesAlong along, Fires fires, std::int64_t revolutions, std::int64_t lines = 26,
                    std::int64_t pixels = 45) {
  small.job = gravure::test::small_job(lines);
  small.job.image.lines_along = along;
  small.stack = gravure::test::random_stack(small.images, SampleType::bit, along, lines, pixels, 3, 11);
  small.job.image.fires = small.stack.fires = fires;
  gravure::test::compile_job(small, revolutions, LayerOrder::cycle);
}

inline std::function<Result<std::unique_ptr<LineSource>>()> opener(const SmallJob& small) {
  return [&small]() -> Result<std::unique_ptr<LineSource>> {
    return std::unique_ptr<LineSource>(std::make_unique<MemorySource>(small.program));
  };
}

}  // namespace gravure::report::test
