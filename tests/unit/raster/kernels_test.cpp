#include "gravure/raster/kernels.hpp"

#include <gtest/gtest.h>

namespace gravure::raster {
namespace {

TEST(Kernels, ArePortableOnAnyProcessor) {
  ASSERT_NE(kernels_for(Isa::portable), nullptr);
  EXPECT_EQ(kernels_for(Isa::portable)->isa, Isa::portable);
}

TEST(Kernels, AreChosenOnceAndAreTheBestThatRun) {
  EXPECT_EQ(&best_kernels(), &best_kernels());
  for (const Isa isa : {Isa::portable, Isa::avx2, Isa::avx512}) {
    if (kernels_for(isa) != nullptr) {
      EXPECT_EQ(kernels_for(isa)->isa, isa);
      EXPECT_GE(best_kernels().isa, isa) << isa_name(isa);
    }
  }
}

}  // namespace
}  // namespace gravure::raster
