#include <gtest/gtest.h>

#include "gravure/sync/make_plan.hpp"
#include "sync_support.hpp"

namespace gravure {
namespace {

using sync_test::roller_job;

std::string refusal(const Job& job, std::optional<std::int64_t> layers, ErrorCode code) {
  const Result<std::int64_t> revolutions = resolve_revolutions(job, layers);
  EXPECT_FALSE(revolutions);
  if (revolutions) {
    return {};
  }
  EXPECT_EQ(revolutions.error().code, code);
  return revolutions.error().message;
}

TEST(ResolveRevolutions, TakesOnePerLayerByDefault) {
  Job job = roller_job();
  EXPECT_EQ(resolve_revolutions(job, 37).value(), 37);
  job.image.depth_map = "depth.tif";
  job.image.levels = 64;
  EXPECT_EQ(resolve_revolutions(job, std::nullopt).value(), 64);
  EXPECT_EQ(resolve_revolutions(job, 37).value(), 37);
}

TEST(ResolveRevolutions, TakesTheGivenNumber) {
  Job job = roller_job();
  job.image.revolutions = 100;
  EXPECT_EQ(resolve_revolutions(job, std::nullopt).value(), 100);
  EXPECT_EQ(resolve_revolutions(job, 100).value(), 100);
  for (const LayerOrder order : {LayerOrder::cycle, LayerOrder::hold}) {
    job.image.order = order;
    EXPECT_EQ(resolve_revolutions(job, 7).value(), 100);
    EXPECT_EQ(resolve_revolutions(job, 1000).value(), 100);
  }
}

TEST(ResolveRevolutions, RefusesWhatDoesNotAddUp) {
  Job job = roller_job();
  EXPECT_NE(refusal(job, std::nullopt, ErrorCode::bad_argument).find("image.revolutions is missing"),
            std::string::npos);
  EXPECT_NE(refusal(job, 0, ErrorCode::bad_argument).find("no layer"), std::string::npos);
  job.image.revolutions = 100;
  const std::string counts = refusal(job, 99, ErrorCode::bad_argument);
  EXPECT_NE(counts.find("image.revolutions = 100"), std::string::npos);
  EXPECT_NE(counts.find("layers, 99"), std::string::npos);
  job.image.revolutions = 0;
  EXPECT_NE(refusal(job, 3, ErrorCode::out_of_range).find("image.revolutions = 0: must be at least 1"),
            std::string::npos);
}

TEST(LayerOfRevolution, FollowsTheOrder) {
  const std::int64_t cycle[] = {0, 1, 2, 0, 1, 2, 0};
  const std::int64_t hold[] = {0, 1, 2, 2, 2, 2, 2};
  for (std::int64_t revolution = 0; revolution < 7; ++revolution) {
    EXPECT_EQ(layer_of_revolution(LayerOrder::cycle, 3, revolution), cycle[revolution]);
    EXPECT_EQ(layer_of_revolution(LayerOrder::hold, 3, revolution), hold[revolution]);
    EXPECT_EQ(layer_of_revolution(LayerOrder::sequence, 7, revolution), revolution);
  }
}

}  // namespace
}  // namespace gravure
